"""Writes a scene as a glTF file that Noonmark and Blender read, and the experiment that views it.

    python3 scene.py cube-room|hills|MODEL.gltf FOLDER     writes FOLDER/scene.gltf (not of a model), FOLDER/view.toml

The shapes are those of the built-in scene cube-room, and nearly those of the benchmarks' scene hills
(tests/support/benchmark.h; here no triangle at a pole has two equal corners).
"""
import base64
import json
import math
import os
import struct
import sys

SUN = {"cube-room": ((-2, 4, -1), (0, 0, 0)), "hills": ((6, 12, 4), (0, 0, 0))}
CAMERA = {"cube-room": ((-1.6, 2.8, 6.4), (1.0, 0.35, 0.6)), "hills": ((9, 9, 14), (0, 0, 0))}


def surface(columns, rows, at, wrap=False):
    """The grid of add_surface (scenes/shapes.h): positions, triangles without those that collapse."""
    width = columns if wrap else columns + 1
    positions = [at(i / columns, j / rows) for j in range(rows + 1) for i in range(width)]
    if wrap:  # the poles: exactly one place each
        for row in (0, rows):
            positions[row * width:(row + 1) * width] = [positions[row * width]] * width
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b = j * width + i, j * width + (i + 1) % width
            c, d = b + width, a + width
            if not (wrap and j == 0):
                triangles.append((a, b, c))
            if not (wrap and j == rows - 1):
                triangles.append((a, c, d))
    return positions, triangles


def box(half, move=(0, 0, 0), turn_deg=0):
    """A cube, turned about the axis (1, 0, 1)."""
    s, c, r = math.sin(math.radians(turn_deg)), math.cos(math.radians(turn_deg)), math.sqrt(0.5)
    positions = []
    for x in (-half, half):
        for y in (-half, half):
            for z in (-half, half):
                along = (x + z) * r  # Rodrigues' formula
                turned = (x * c - r * y * s + r * along * (1 - c), y * c + r * (x - z) * s,
                          z * c + r * y * s + r * along * (1 - c))
                positions.append(tuple(p + m for p, m in zip(turned, move)))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return positions, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def cube_room():
    floor = surface(1, 1, lambda s, t: (50 * s - 25, -0.5, 25 - 50 * t))
    return [floor, box(0.5, (0, 1.5, 0)), box(0.5, (2, 0, 1)), box(0.25, (-1, 0, 2), 60)]


def hills():
    def ground(s, t):
        x, z = 20 * s - 10, 10 - 20 * t
        return x, 0.25 * math.sin(1.7 * x) * math.cos(2.1 * z) + 0.05 * math.sin(9 * x + 3 * z), z

    def sphere(i, j):
        def at(s, t):
            phi, up = 2 * math.pi * s, math.pi * (t - 0.5)
            return (-7 + 3.5 * i + 0.9 * math.cos(up) * math.cos(phi),
                    1.0 + 0.3 * ((i * 7 + j * 3) % 4) + 0.9 * math.sin(up),
                    -7 + 3.5 * j - 0.9 * math.cos(up) * math.sin(phi))
        return surface(52, 26, at, wrap=True)
    return [surface(180, 180, ground)] + [sphere(i, j) for i in range(5) for j in range(5)]


def write_gltf(path, shapes):
    data, views, accessors, meshes = b"", [], [], []

    def add(packed, target, component, kind, count, **more):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed), "target": target})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind, "count": count,
                          **more})
        data += packed
        return len(accessors) - 1

    for positions, triangles in shapes:
        flat = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in positions]
        bounds = {"min": [min(a) for a in zip(*flat)], "max": [max(a) for a in zip(*flat)]}
        places = add(b"".join(struct.pack("<3f", *p) for p in flat), 34962, 5126, "VEC3", len(flat), **bounds)
        indices = add(b"".join(struct.pack("<3I", *t) for t in triangles), 34963, 5125, "SCALAR", 3 * len(triangles))
        meshes.append({"primitives": [{"attributes": {"POSITION": places}, "indices": indices, "material": 0}]})
    with open(path, "w") as file:
        json.dump({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(meshes)))}],
            "nodes": [{"mesh": i} for i in range(len(meshes))], "meshes": meshes,
            "materials": [{"doubleSided": True}], "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(data),
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}, file)


def main():
    name, folder = sys.argv[1:]
    lines = ['pictures = "none"', "[view]", "width_px = 1280", "height_px = 720"]
    if name in SUN:
        model = os.path.join(folder, "scene.gltf")
        write_gltf(model, cube_room() if name == "cube-room" else hills())
        eye, target = CAMERA[name]
        lines += [f"eye_m = {list(map(float, eye))}", f"target_m = {list(map(float, target))}", "fov_deg = 45.0"]
        position, aim = SUN[name]
        lines += ["[light]", 'kind = "directional"', f"position_m = {list(map(float, position))}",
                  f"target_m = {list(map(float, aim))}"]
    else:
        model = os.path.abspath(name)
        lines += ["[light]", 'kind = "directional"']
    with open(os.path.join(folder, "view.toml"), "w") as file:
        file.write(f"scene = {json.dumps(model)}\n" + "\n".join(lines) + "\n")


main()
