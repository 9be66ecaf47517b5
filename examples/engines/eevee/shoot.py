"""Renders a glTF file with Blender's EEVEE and keeps what noonmark judge needs: visibility.npy, positions.npy and frame.json.
   xvfb-run -a blender -b --factory-startup --python-exit-code 1 --python eevee/shoot.py -- model.glb OUT [name=value ...]
EEVEE draws with OpenGL and needs a display; xvfb-run gives it one, with Mesa's software renderer."""
import json
import math
import os
import pathlib
import sys


def settings_of(given):
    """All settings with their values (None is "not given") from the "name=value" of a command line: those of settings.json here
    and beside the folders of the engines. Ends the program with a list of them if one is unknown, given twice, or is not
    what it takes."""
    here, rows, values = pathlib.Path(__file__).resolve().parent, {}, {}
    for folder in (here.parent, here):
        rows.update(json.loads((folder / "settings.json").read_text()))

    def otherwise(row):
        return row["choices"][0] if "choices" in row else row.get("default")

    def count(row):
        return row.get("numbers") or (len(row["default"]) if isinstance(row["default"], list) else 1)

    def takes(row):
        if "choices" in row:
            return " | ".join(row["choices"])
        kind = "whole number" if row.get("whole") else "number"
        return (f"a {kind}" if count(row) == 1 else f"{count(row)} {kind}s with commas") + (f" above {row['above']}" if "above" in row else "")

    def value(row, text):
        """None if the text is not what the setting takes."""
        if "choices" in row:
            return text if text in row["choices"] else None
        try:
            numbers = [(int if row.get("whole") else float)(part) for part in text.split(",")]
        except ValueError:
            return None
        if len(numbers) != count(row) or not all(math.isfinite(x) and x > row.get("above", -math.inf) for x in numbers):
            return None
        return numbers[0] if len(numbers) == 1 else numbers

    def fail(what):
        print(f"{what} The settings of eevee/shoot.py are", file=sys.stderr)
        for name, row in rows.items():
            default = row.get("default")
            default = "" if default is None else f" ({','.join(map(str, default)) if isinstance(default, list) else default})"
            print(f"  {name}={takes(row)}{default}{', ' + row['means'] if 'means' in row else ''}", file=sys.stderr)
        sys.exit(2)

    for one in given:
        name, equals, text = one.partition("=")
        if not equals:
            fail(f'"{one}" is no name=value.')
        if name not in rows:
            fail(f'"{one}": there is no setting "{name}".')
        if name in values:
            fail(f'"{one}": "{name}" is given twice.')
        values[name] = value(rows[name], text)
        if values[name] is None:
            fail(f'"{one}": "{name}" takes {takes(rows[name])}.')
    return {name: values.get(name, otherwise(row)) for name, row in rows.items()}


model, out, *rest = sys.argv[sys.argv.index("--") + 1:]
settings = settings_of(rest)
if not os.path.exists(model):
    print(f"There is no model {model}.", file=sys.stderr)
    sys.exit(2)

import bpy  # noqa: E402  (a wrong setting is told without Blender)
import numpy as np  # noqa: E402
from mathutils import Matrix, Vector  # noqa: E402


def of_file(numbers):
    """A place or a direction of the file, which has Y up, in Blender, which has Z up."""
    x, y, z = numbers
    return Vector((x, -z, y))


if not hasattr(np, "bool"):
    np.bool = bool  # the importer of Blender 3.4 asks for a name that NumPy 1.24 dropped
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=os.path.abspath(model))
scene = bpy.context.scene
lights = [one for one in scene.objects if one.type == "LIGHT"]
found = next((one for one in lights if one.data.type == "SUN"), None)
if settings["light"] == "file" and (settings["direction"] or not found):
    print("light=file and direction are given, and a frame has one light. Leave one of them out." if settings["direction"] else
          f"light=file: {model} has no directional light (KHR_lights_punctual). Give direction=x,y,z in place of it.", file=sys.stderr)
    sys.exit(1)
for other in lights:
    other.hide_render = settings["direction"] is not None or other is not found
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
eye = of_file(settings["eye"]) if settings["eye"] else middle + 0.6 * size * Vector((1, -1, 1))
turn = ((of_file(settings["target"]) if settings["target"] else middle) - eye).to_track_quat("-Z", "Y")
camera.matrix_world = Matrix.Translation(eye) @ turn.to_matrix().to_4x4()
near, tan = settings["near"] or size / 100, math.tan(math.radians(settings["fov_y_deg"]) / 2)
camera.data.sensor_fit, camera.data.angle = "VERTICAL", 2 * math.atan(tan)
camera.data.clip_start, camera.data.clip_end = near, 10 * size

# EEVEE fits its map to a sphere about the camera's frustum from `near` to `distance`, so its width cannot be set.
own = settings["direction"] or (None if found else (-0.4, -0.8, -0.3))  # of a light that is made
sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN")) if own else found
if own:
    scene.collection.objects.link(sun)
    sun.rotation_euler = of_file(own).to_track_quat("-Z", "Y").to_euler()
bpy.context.view_layer.update()
way, lamp = (sun.matrix_world.to_3x3() @ Vector((0, 0, -1))).normalized(), sun.data
distance = settings["distance"] or (eye - middle).length + size / 2
lamp.angle, lamp.energy, lamp.shadow_buffer_bias = 0, math.pi, settings["bias"]
lamp.shadow_cascade_count, lamp.shadow_cascade_max_distance, lamp.shadow_cascade_fade = 1, distance, 0

render, width, height, resolution = scene.render, settings["width"], settings["height"], settings["resolution"]
render.engine, render.film_transparent = "BLENDER_EEVEE", True
render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
render.filter_size, scene.eevee.taa_render_samples = 0, 1  # one sample at each pixel's centre
scene.eevee.shadow_cascade_size = str(resolution)
scene.eevee.use_shadow_high_bitdepth = settings["high_bitdepth"] == "true"
scene.eevee.use_soft_shadows = False

# The compositor writes each layer to a file of floats.
os.makedirs(out, exist_ok=True)
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
