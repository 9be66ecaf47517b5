"""VTK's own vtkShadowMapPass: a plane, a cube, a ball and a cone under one spot light.

WINDOW=480x480, RESOLUTION=1024 in the environment change what they name."""
import os

import vtk

renderer, window = vtk.vtkOpenGLRenderer(), vtk.vtkRenderWindow()
window.SetSize(*map(int, os.environ.get('WINDOW', '640x360').split('x')))
window.SetMultiSamples(0)
window.AddRenderer(renderer)


def put(source, color, at=(0, 0, 0)):
    normals, mapper, actor = vtk.vtkPolyDataNormals(), vtk.vtkPolyDataMapper(), vtk.vtkActor()
    normals.SetInputConnection(source.GetOutputPort())
    mapper.SetInputConnection(normals.GetOutputPort())
    actor.SetMapper(mapper)
    actor.SetPosition(*at)
    actor.GetProperty().SetColor(*color)
    actor.GetProperty().SetSpecular(0)
    renderer.AddActor(actor)


plane = vtk.vtkPlaneSource()
plane.SetOrigin(-5, 0, -5)
plane.SetPoint1(-5, 0, 5)
plane.SetPoint2(5, 0, -5)
put(plane, (0.8, 0.8, 0.8))
ball = vtk.vtkSphereSource()
ball.SetRadius(0.6)
ball.SetThetaResolution(48)
ball.SetPhiResolution(32)
put(ball, (0.3, 0.8, 0.3), (1.2, 1.0, -0.5))
put(vtk.vtkCubeSource(), (0.8, 0.3, 0.3), (-1, 0.7, 0))
cone = vtk.vtkConeSource()
cone.SetHeight(1.5)
cone.SetRadius(0.5)
cone.SetDirection(0, 1, 0)
cone.SetResolution(32)
put(cone, (0.3, 0.3, 0.8), (0.6, 0.75, 1.4))

camera = renderer.GetActiveCamera()
camera.SetPosition(3, 3.5, 6)
camera.SetFocalPoint(0, 0.4, 0)
camera.SetViewUp(0, 1, 0)
camera.SetViewAngle(45)
renderer.RemoveAllLights()
light = vtk.vtkLight()
light.SetFocalPoint(0, 0, 0)
light.PositionalOn()
light.SetConeAngle(30)
renderer.AddLight(light)

baker, shadows, both, sequence, delegate = (vtk.vtkShadowMapBakerPass(), vtk.vtkShadowMapPass(), vtk.vtkRenderPassCollection(), vtk.vtkSequencePass(),
                                            vtk.vtkCameraPass())
baker.SetResolution(int(os.environ.get('RESOLUTION', '1024')))
shadows.SetShadowMapBakerPass(baker)
both.AddItem(baker)
both.AddItem(shadows)
sequence.SetPasses(both)
delegate.SetDelegatePass(sequence)
renderer.SetPass(delegate)
renderer.ResetCameraClippingRange()
frame = 0
while True:  # VTK draws its map again when the light has moved
    frame = 1 - frame
    light.SetPosition(-3 + 1e-5 * frame, 6, 3)
    window.Render()
