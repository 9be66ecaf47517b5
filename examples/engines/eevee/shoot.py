"""Renders a glTF file with Blender's EEVEE and keeps what noonmark judge needs: visibility.npy, positions.npy and frame.json.
   xvfb-run -a blender -b --factory-startup --python-exit-code 1 --python eevee/shoot.py -- model.glb OUT [name=value ...]
EEVEE draws with OpenGL and needs a display; xvfb-run gives it one, with Mesa's software renderer."""
import json
import math
import os
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector

model, out, *rest = sys.argv[sys.argv.index("--") + 1:]
settings = dict(one.split("=", 1) for one in rest)
os.makedirs(out, exist_ok=True)


def number(name, otherwise):
    return float(settings.get(name, otherwise))


def vector(name, otherwise):  # Blender has Z up, the file Y
    if name not in settings:
        return Vector(otherwise)
    x, y, z = map(float, settings[name].split(","))
    return Vector((x, -z, y))


if not hasattr(np, "bool"):
    np.bool = bool  # the importer of Blender 3.4 asks for a name that NumPy 1.24 dropped
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=os.path.abspath(model))
scene = bpy.context.scene
for other in [one for one in scene.objects if one.type in ("LIGHT", "CAMERA")]:
    bpy.data.objects.remove(other)
corners = [one.matrix_world @ Vector(corner) for one in scene.objects if one.type == "MESH" for corner in one.bound_box]
low, high = (Vector([choose(corner[i] for corner in corners) for i in range(3)]) for choose in (min, max))
middle, size = (low + high) / 2, (high - low).length

# A world without light, and flat, matte, opaque materials. EEVEE draws into half floats, so a position is handed over in two
# parts: the multiple of a step (a half float holds each of these) below it, and the rest.
scene.world = bpy.data.worlds.new("dark")
scene.world.color = (0, 0, 0)
step = 2.0 ** math.ceil(math.log2(max(abs(x) for x in (*low, *high)) / 1024))
for mesh in {one.data for one in scene.objects if one.type == "MESH"}:
    mesh.use_auto_smooth = False
    mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))
    if not mesh.materials:
        mesh.materials.append(None)
    for i, old in enumerate(mesh.materials):
        own = mesh.materials[i] = bpy.data.materials.new("matte")
        own.use_backface_culling = old.use_backface_culling if old else True
        own.use_nodes = True
        new, link = own.node_tree.nodes.new, own.node_tree.links.new
        own.node_tree.nodes.clear()
        link(new("ShaderNodeBsdfDiffuse").outputs[0], new("ShaderNodeOutputMaterial").inputs["Surface"])
        place, below, above = new("ShaderNodeNewGeometry").outputs["Position"], new("ShaderNodeVectorMath"), new("ShaderNodeVectorMath")
        below.operation, above.operation = "SNAP", "SUBTRACT"
        below.inputs[1].default_value = (step, step, step)
        for start, end in ((place, below.inputs[0]), (place, above.inputs[0]), (below.outputs[0], above.inputs[1])):
            link(start, end)
        for name, node in (("Below", below), ("Above", above)):
            layer = new("ShaderNodeOutputAOV")
            layer.name = name
            link(node.outputs[0], layer.inputs["Color"])

camera = scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
eye = vector("eye", middle + 0.6 * size * Vector((1, -1, 1)))
turn = (vector("target", middle) - eye).to_track_quat("-Z", "Y")
camera.matrix_world = Matrix.Translation(eye) @ turn.to_matrix().to_4x4()
near, tan = number("near", size / 100), math.tan(math.radians(number("fov_y_deg", 45)) / 2)
camera.data.sensor_fit, camera.data.angle = "VERTICAL", 2 * math.atan(tan)
camera.data.clip_start, camera.data.clip_end = near, 10 * size

# EEVEE fits its map to a sphere about the camera's frustum from `near` to `distance`, so its width cannot be set.
lamp = bpy.data.lights.new("sun", "SUN")
distance = number("distance", (eye - middle).length + size / 2)
lamp.angle, lamp.energy, lamp.shadow_buffer_bias = 0, math.pi, number("bias", 1)
lamp.shadow_cascade_count, lamp.shadow_cascade_max_distance, lamp.shadow_cascade_fade = 1, distance, 0
sun = bpy.data.objects.new("sun", lamp)
scene.collection.objects.link(sun)
way = vector("direction", (-0.4, 0.3, -0.8)).normalized()
sun.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()

render, width, height, resolution = scene.render, int(number("width", 1280)), int(number("height", 720)), int(number("resolution", 1024))
render.engine, render.film_transparent = "BLENDER_EEVEE", True
render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
render.filter_size, scene.eevee.taa_render_samples = 0, 1  # one sample at each pixel's centre
scene.eevee.shadow_cascade_size = str(resolution)
scene.eevee.use_shadow_high_bitdepth = settings.get("high_bitdepth", "true") == "true"
scene.eevee.use_soft_shadows = False

# The compositor writes each layer to a file of floats.
names, scene.use_nodes = ("Image", "Below", "Above"), True
scene.node_tree.nodes.clear()
for name in names[1:]:
    scene.view_layers[0].aovs.add().name = name
layers, files = scene.node_tree.nodes.new("CompositorNodeRLayers"), scene.node_tree.nodes.new("CompositorNodeOutputFile")
files.base_path, files.format.file_format, files.format.color_depth, files.format.color_mode = out, "OPEN_EXR", "32", "RGBA"
files.file_slots.clear()
for name in names:
    files.file_slots.new(name)
    scene.node_tree.links.new(layers.outputs[name], files.inputs[name])


def drawn(shadows):
    lamp.use_shadow = shadows
    bpy.ops.render.render()
    for name in names:
        image = bpy.data.images.load(os.path.join(out, f"{name}{scene.frame_current:04d}.exr"))
        image.colorspace_settings.name = "Non-Color"
        floats = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(floats)
        yield floats.reshape(height, width, 4)[::-1]  # the top row first
        os.remove(image.filepath)
        bpy.data.images.remove(image)


# The light's visibility is the picture with shadows divided by the one without; what faces away is dark in both.
(dark, below, above), (lit, _, _) = drawn(True), drawn(False)
lit, surface = lit[..., 0], lit[..., 3:] > 0
visibility = np.divide(dark[..., 0], lit, out=np.zeros_like(lit), where=lit > 0)
np.save(os.path.join(out, "visibility.npy"), np.where(surface[..., 0], visibility, np.nan).astype(np.float32))
np.save(os.path.join(out, "positions.npy"), np.where(surface, below + above, np.nan)[..., :3].astype(np.float32))

projection = camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=width, y=height)
view, projection = ([x for column in matrix.transposed() for x in column] for matrix in (camera.matrix_world.inverted(), projection))
radius = math.hypot((distance - near) / 2, distance * tan, distance * tan * width / height)
frame = {"noonmark_frame": 1, "scene": os.path.relpath(model, out), "axes": ["x", "z", "-y"], "visibility": {"file": "visibility.npy"}, "positions": {"file": "positions.npy"},
         "camera": {"view": view, "projection": projection, "order": "column", "depth_range": "-1..1", "reversed": False},
         "light": {"kind": "directional", "direction": list(way)}, "edge": {"texels": 2.5, "texel": 2 * radius / resolution}}
with open(os.path.join(out, "frame.json"), "w") as file:
    json.dump(frame, file, indent=1)
