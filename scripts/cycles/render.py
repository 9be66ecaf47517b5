r"""Renders the hard shadows of a glTF file with Cycles, seen and lit as one of Noonmark's points, and times it.

    blender -b --factory-startup --python-exit-code 1 --python render.py -- \
        FILE.gltf point.json lit.png times.json THREADS ROUNDS

lit.png: 255 where a sample is lit, 0 elsewhere. Blender's world has z up: (x, y, z) of glTF is (x, -z, y) here.
"""
import json
import os
import resource
import struct
import sys
import tempfile
import zlib
from math import atan

import bpy
import numpy
from mathutils import Matrix, Vector

numpy.bool = bool  # Debian's numpy has this name no more, which Blender 3.4's reader of glTF uses
few, many = 1, 17  # samples; their difference is tracing without synchronisation, trees and files


def z_up(v):
    return Vector((v[0], -v[2], v[1]))


def load(model):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=model)
    for other in [o for o in bpy.context.scene.objects if o.type in ("CAMERA", "LIGHT")]:
        bpy.data.objects.remove(other)
    for mesh in bpy.data.meshes:  # the geometric normal decides, as in Noonmark
        mesh.use_auto_smooth = False
        mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))
        mesh.update()
    white = bpy.data.materials.new("white")
    white.use_nodes = True
    nodes = white.node_tree.nodes
    nodes.clear()
    white.node_tree.links.new(nodes.new("ShaderNodeBsdfDiffuse").outputs[0],
                              nodes.new("ShaderNodeOutputMaterial").inputs[0])
    bpy.context.view_layer.material_override = white


def add_camera(c, width, height):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "HORIZONTAL" if c["half_width"] >= c["half_height"] else "VERTICAL"
    camera.angle = 2 * atan(max(c["half_width"], c["half_height"]))
    camera.clip_start, camera.clip_end = c["near_m"], c["far_m"]
    thing = bpy.data.objects.new("camera", camera)
    columns = [z_up(c["right"]), z_up(c["up"]), -z_up(c["forward"]), z_up(c["eye_m"])]
    thing.matrix_world = Matrix([[column[row] for column in columns] for row in range(3)] + [[0, 0, 0, 1]])
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def add_sun(direction):
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 10, 0
    thing = bpy.data.objects.new("sun", sun)
    thing.rotation_mode = "QUATERNION"
    thing.rotation_quaternion = z_up(direction).to_track_quat("-Z", "Y")
    bpy.context.scene.collection.objects.link(thing)


def set_up(width, height, threads):
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("black")
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.threads_mode, render.threads = "FIXED", threads
    render.use_persistent_data = True
    render.use_compositing = render.use_sequencer = False
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.pixel_filter_type, cycles.filter_width = "GAUSSIAN", 0.01  # of a box Cycles takes no width
    cycles.light_sampling_threshold = 0  # otherwise weak light is left out at random
    cycles.max_bounces = cycles.diffuse_bounces = cycles.transparent_max_bounces = 0
    cycles.caustics_reflective = cycles.caustics_refractive = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.color_mode = "RGB"


def used_ms():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return 1000 * (used.ru_utime + used.ru_stime)


def render_ms(samples):
    bpy.context.scene.cycles.samples = samples
    bpy.context.scene.update_tag()  # otherwise persistent data keep the old number
    before = used_ms()
    bpy.ops.render.render()
    return used_ms() - before


def write_png(path, grey):
    """grey: rows of bytes, the top one first."""
    height, width = grey.shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main():
    model, point_file, picture, times, threads, rounds = sys.argv[sys.argv.index("--") + 1:]
    with open(point_file) as file:
        point = json.load(file)
    width, height = point["settings"]["view.width_px"], point["settings"]["view.height_px"]
    load(model)
    add_camera(point["camera"], width, height)
    add_sun(point["light"]["ray_direction"])
    set_up(width, height, int(threads))

    scene = bpy.context.scene
    with tempfile.TemporaryDirectory() as folder:
        scene.cycles.samples = few
        scene.render.filepath = os.path.join(folder, "lit.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        image.colorspace_settings.name = "Non-Color"
        values = numpy.empty(width * height * 4, dtype=numpy.float32)
        image.pixels.foreach_get(values)
    lit = values.reshape(height, width, 4)[::-1, :, 0] > 0
    write_png(picture, (lit * 255).astype(numpy.uint8))
    spent = [(render_ms(few), render_ms(many)) for _ in range(int(rounds))]
    with open(times, "w") as file:
        json.dump({"few_ms": [a for a, _ in spent], "many_ms": [b for _, b in spent],
                   "sample_ms": [(b - a) / (many - few) for a, b in spent],
                   "triangles": sum(len(m.polygons) for m in bpy.data.meshes)}, file)


main()
