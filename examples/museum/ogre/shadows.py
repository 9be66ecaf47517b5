"""OGRE's own texture shadows as its run-time shader system integrates them: a ground, a cube, a ball and a pole under a sun.

SHADOW_SIZE, SHADOW_FORMAT and SHADOW_BACK=0 in the environment change the map's texels, their format and the faces in it."""
import math
import os

import Ogre
import Ogre.Bites as Bites
import Ogre.RTShader as RTShader


class App(Bites.ApplicationContext):
    def oneTimeConfig(self):
        root = self.getRoot()
        root.setRenderSystem(root.getRenderSystemByName('OpenGL 3+ Rendering Subsystem'))
        root.getRenderSystem().setConfigOption('Video Mode', '640 x 360')
        return True

    def locateResources(self):  # Debian's list names packs of models that Debian leaves out
        for folder in ('RTShaderLib/GLSL', 'RTShaderLib/materials', 'ShadowVolume'):
            Ogre.ResourceGroupManager.getSingleton().addResourceLocation('/usr/share/OGRE/Media/' + folder, 'FileSystem', 'OgreInternal')


app = App('museum')
app.initApp()
root = app.getRoot()
scene = root.createSceneManager()
generator = RTShader.ShaderGenerator.getSingleton()
generator.addSceneManager(scene)

scene.setShadowTechnique(Ogre.SHADOWTYPE_TEXTURE_ADDITIVE_INTEGRATED)
scene.setShadowFarDistance(20)
scene.setShadowTextureSettings(int(os.environ.get('SHADOW_SIZE', '1024')), 1, getattr(Ogre, os.environ.get('SHADOW_FORMAT', 'PF_DEPTH16')))
scene.setShadowTextureSelfShadow(True)
scene.setShadowCasterRenderBackFaces(os.environ.get('SHADOW_BACK', '1') == '1')
state = generator.getRenderState(RTShader.ShaderGenerator.DEFAULT_SCHEME_NAME)
state.addTemplateSubRenderState(generator.createSubRenderState(RTShader.SRS_INTEGRATED_PSSM3 if hasattr(RTShader, 'SRS_INTEGRATED_PSSM3') else 'SGX_IntegratedPSSM3'))


def put(mesh, color, at, scale, turn=0):
    material = Ogre.MaterialManager.getSingleton().create(mesh + str(at), Ogre.RGN_DEFAULT)
    one = material.getTechnique(0).getPass(0)
    one.setDiffuse(*color, 1)
    one.setAmbient(*color)
    entity = scene.createEntity(mesh)
    entity.setMaterialName(material.getName())
    node = scene.getRootSceneNode().createChildSceneNode()
    node.attachObject(entity)
    node.setPosition(*at)
    node.setScale(*scale)
    node.yaw(Ogre.Radian(turn))


def revolved(name, profile, segments=48):
    """A closed surface of revolution about y: rows of (radius, height), from below to above."""
    made = scene.createManualObject(name)
    made.begin('BaseWhite', Ogre.RenderOperation.OT_TRIANGLE_LIST)
    for r, y, nr, ny in profile:
        for i in range(segments + 1):
            a = 2 * math.pi * i / segments
            made.position(r * math.sin(a), y, r * math.cos(a))
            made.normal(nr * math.sin(a), ny, nr * math.cos(a))
    for row in range(len(profile) - 1):
        for i in range(segments):
            a = row * (segments + 1) + i
            b = a + segments + 1
            made.triangle(a, a + 1, b + 1)
            made.triangle(a, b + 1, b)
    made.end()
    made.convertToMesh(name)


def boxed(name):
    made = scene.createManualObject(name)
    made.begin('BaseWhite', Ogre.RenderOperation.OT_TRIANGLE_LIST)
    n = 0
    for axis in range(3):
        for sign in (-1, 1):
            for u, v in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)):
                p = [0.0] * 3
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = 0.5 * sign, u, v * sign
                made.position(*p)
                made.normal(*[sign if i == axis else 0 for i in range(3)])
            made.triangle(n, n + 1, n + 2)
            made.triangle(n, n + 2, n + 3)
            n += 4
    made.end()
    made.convertToMesh(name)


boxed('box')
revolved('ball', [(math.cos(t), math.sin(t), math.cos(t), math.sin(t)) for t in (math.pi * (i / 24 - 0.5) for i in range(25))])
revolved('pole', [(0, -1, 0, -1), (1, -1, 0, -1), (1, -1, 1, 0), (1, 1, 1, 0), (1, 1, 0, 1), (0, 1, 0, 1)])
put('box', (0.8, 0.8, 0.8), (0, -0.05, 0), (12, 0.1, 12))
put('box', (0.8, 0.25, 0.25), (-1, 0.7, 0), (1, 1, 1), 0.35)
put('ball', (0.25, 0.8, 0.25), (1.5, 1.1, -0.8), (0.6, 0.6, 0.6))
put('pole', (0.25, 0.25, 0.8), (1, 0.8, 1.5), (0.15, 0.8, 0.15))

camera = scene.createCamera('camera')
camera.setNearClipDistance(0.1)
camera.setFarClipDistance(60)
camera.setFOVy(Ogre.Radian(math.pi / 4))
camera.setAutoAspectRatio(True)
eye = scene.getRootSceneNode().createChildSceneNode()
eye.attachObject(camera)
eye.setPosition(3, 3.5, 6)
eye.lookAt(Ogre.Vector3(0, 0.4, 0), Ogre.Node.TS_WORLD)
app.getRenderWindow().addViewport(camera).setBackgroundColour(Ogre.ColourValue(0.1, 0.15, 0.2))
light = scene.createLight('sun')
light.setType(Ogre.Light.LT_DIRECTIONAL)
sun = scene.getRootSceneNode().createChildSceneNode()
sun.attachObject(light)
sun.setDirection(Ogre.Vector3(3, -5, -2))
scene.setAmbientLight(Ogre.ColourValue(0.2, 0.2, 0.2))
root.startRendering()
