"""EEVEE in Blender's viewport: a ground, a cube, a ball and a pole under a sun. Soft shadows and the samples of its
anti-aliasing are off, because a frame is judged against a hard shadow."""
import os

import bpy
from mathutils import Vector

scene = bpy.context.scene
for one in list(bpy.data.objects):
    bpy.data.objects.remove(one)
bpy.ops.mesh.primitive_plane_add(size=12)
bpy.ops.mesh.primitive_cube_add(size=1, location=(-1, 0, 0.7), rotation=(0, 0, 0.35))
bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=32, radius=0.6, location=(1.5, 0.8, 1.1))
bpy.ops.mesh.primitive_cylinder_add(radius=0.15, depth=1.6, location=(1, -1.5, 0.8))
bpy.ops.object.light_add(type=os.environ.get('SHADOW_LIGHT', 'SUN'), location=(-3, -2, 5))
light = bpy.context.object
light.rotation_euler = Vector((3, 2, -5)).to_track_quat('-Z', 'Y').to_euler()
light.data.energy = 3 if light.data.type == 'SUN' else 500
light.data.use_contact_shadow = False
if 'SHADOW_BIAS' in os.environ:
    light.data.shadow_buffer_bias = float(os.environ['SHADOW_BIAS'])
if light.data.type == 'SUN':
    light.data.shadow_cascade_count = 1
    light.data.shadow_cascade_max_distance = 15
    light.data.angle = 0
else:
    light.data.shadow_soft_size = 0
scene.render.engine = 'BLENDER_EEVEE'
scene.eevee.use_soft_shadows = False
scene.eevee.taa_samples = 1
scene.eevee.shadow_cascade_size = scene.eevee.shadow_cube_size = os.environ.get('SHADOW_SIZE', '1024')
scene.world.node_tree.nodes['Background'].inputs[1].default_value = 0.3
turn = 0


def view():
    """The viewport, drawn again and again; a light that turns makes EEVEE draw its map again."""
    global turn
    turn = 1 - turn
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == 'VIEW_3D':
            space = area.spaces[0]
            space.shading.type = 'RENDERED'
            space.overlay.show_overlays = False
            space.show_gizmo = False
            space.region_3d.view_perspective = 'PERSP'
            space.region_3d.view_location = (0, 0, 0.4)
            space.region_3d.view_distance = 7.5
            space.region_3d.view_rotation = Vector((3, -6, 3.1)).to_track_quat('Z', 'Y')
            area.tag_redraw()
    light.location.x = -3 + 1e-5 * turn
    return 0.02


bpy.app.timers.register(view, first_interval=1)
