"""Each adapter of examples/engines shows a small scene in its engine, and noonmark judge finds nothing wrong with the delivery.
   engine_frames_test.py NOONMARK SOURCE FOLDER
Skips (77) where no adapter can run: node, Chromium, the packages of examples/engines/package.json (npm install in that folder, or
NODE_MODULES names another one), or blender and xvfb-run are not installed. An adapter that cannot run is named."""
import array
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys

program, source, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
engines = source / "examples/engines"
modules = pathlib.Path(os.environ.get("NODE_MODULES", engines / "node_modules"))
SKIP = 77
# The folder of the frame, the page, the package that it needs, and settings with which its shadows are good.
ADAPTERS = [("three", "three/page.html", "three", ["bias=-0.002"]),
            ("three-map", "three/page.html", "three", ["bias=-0.002", "type=BasicShadowMap"]),
            ("three-csm", "three/page.html", "three", ["bias=-0.0001", "class=CSM", "cascades=2", "reach=20"]),
            ("three-sun", "three/page.html", "three", ["bias=-0.001", "class=SunLight", "reach=20"]),
            ("babylon-cascades", "babylon/page.html", "babylonjs", ["bias=0.005", "class=CascadedShadowGenerator", "reach=20"]),
            ("babylon-map", "babylon/page.html", "babylonjs", ["bias=0.02"]),
            ("babylon-pcf-map", "babylon/page.html", "babylonjs", ["bias=0.02", "filter=usePercentageCloserFiltering"]),
            ("babylon", "babylon/page.html", "babylonjs", ["bias=0.02", "filter=usePoissonSampling"]),
            ("playcanvas-map", "playcanvas/page.html", "playcanvas", ["bias=0.4", "type=SHADOW_PCF1_32F", "normalBias=0.1"]),
            ("playcanvas-pcf-map", "playcanvas/page.html", "playcanvas", ["bias=0.4"]),
            ("playcanvas", "playcanvas/page.html", "playcanvas", ["bias=0.4", "type=SHADOW_VSM_32F"]),
            ("filament", "filament/page.html", "filament", []),
            ("eevee", "eevee/shoot.py", None, [])]


def skip(why):
    print(why)
    sys.exit(SKIP)


# A sun below a node that is turned, moved and scaled: -Z turned by -60 degrees about X, then by 30 degrees about Y. A point
# light comes before it, and the mesh hangs below that one's node.
SUN = [-math.cos(math.radians(60)) * math.sin(math.radians(30)), -math.sin(math.radians(60)), -math.cos(math.radians(60)) * math.cos(math.radians(30))]
WITH_SUN = {"scenes": [{"nodes": [1, 2]}], "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}, {"type": "directional"}]}},
            "nodes": [{"mesh": 0},
                      {"name": "lamp", "children": [0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                      {"children": [3], "translation": [3, 1, 0], "scale": [2, 2, 2], "rotation": [0, math.sin(math.radians(15)), 0, math.cos(math.radians(15))]},
                      {"name": "sun", "translation": [0, 1, 0], "rotation": [-math.sin(math.radians(30)), 0, 0, math.cos(math.radians(30))],
                       "extensions": {"KHR_lights_punctual": {"light": 1}}}]}


def glb(path, more={}):
    """A floor of 8 m and a box of 3 m that stands 0.5 m above it, and the keys of `more`."""
    positions, indices = [], []

    def quad(a, b, c, d):
        first = len(positions)
        positions.extend([a, b, c, d])
        indices.extend(first + i for i in (0, 1, 2, 0, 2, 3))

    quad((-4, 0, 4), (4, 0, 4), (4, 0, -4), (-4, 0, -4))
    low, high = (-1.5, 0.5, -1.5), (1.5, 2, 1.5)
    for axis in range(3):
        for side in (0, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            corners = []
            for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
                p = [0, 0, 0]
                p[axis] = (low, high)[side][axis]
                p[u], p[v] = (low, high)[s][u], (low, high)[t][v]
                corners.append(tuple(p))
            quad(*(corners if side else corners[::-1]))
    data = b"".join(struct.pack("<3f", *p) for p in positions) + b"".join(struct.pack("<H", i) for i in indices)
    data += b"\0" * (-len(data) % 4)
    place = 12 * len(positions)
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                "buffers": [{"byteLength": len(data)}],
                "bufferViews": [{"buffer": 0, "byteLength": place}, {"buffer": 0, "byteOffset": place, "byteLength": 2 * len(indices)}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
                               "min": [min(p[k] for p in positions) for k in range(3)],
                               "max": [max(p[k] for p in positions) for k in range(3)]},
                              {"bufferView": 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"}], **more}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4s2I", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
                     struct.pack("<I4s", len(data), b"BIN\0") + data)


def command(page, model, out, settings):
    if page.endswith(".py"):
        return ["xvfb-run", "-a", "blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", str(engines / page), "--", model, out, *settings]
    return ["node", str(engines / "shoot.mjs"), page, model, out, *settings]


def missing(package):
    """What an adapter needs and is not installed; empty if it can run."""
    if package is None:
        return " ".join(tool for tool in ("blender", "xvfb-run") if not shutil.which(tool))
    lacking = [tool for tool in ("node", "chromium") if not shutil.which(tool)]
    return " ".join(lacking + ([] if (modules / package).is_dir() else [f"{modules}/{package}"]))


for _, page, package, _ in ADAPTERS:
    if missing(package):
        print(f"not run: {page}, which needs {missing(package)}")
adapters = [adapter for adapter in ADAPTERS if not missing(adapter[2])]
if not adapters:
    skip("no engine is installed")
environment = {**os.environ, "NODE_MODULES": str(modules)}
if shutil.which("blender"):
    # Blender looks for its Python's packages beside the first python3 of PATH; Debian's are beside blender.
    environment["PATH"] = f"{pathlib.Path(shutil.which('blender')).parent}:{environment['PATH']}"
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
glb(folder / "box.glb")
glb(folder / "lit.glb", WITH_SUN)
bad = []


def expect(true, what):
    if not true:
        bad.append(what)
        print(what)


def shot(page, model, out, *settings):
    return subprocess.run(command(page, str(folder / model), str(out), ["width=320", "height=180", "resolution=1024", "eye=-6,7,-6", "target=-1,0,-1", *settings]),
                          env=environment, capture_output=True, text=True)


def metrics_of(name, page, model, *settings):
    """The metrics of a frame that is shot and judged, or None."""
    out = folder / name
    made = shot(page, model, out, *settings)
    expect(made.returncode == 0, f"{name}: {made.stdout[-2000:]}{made.stderr[-2000:]}")
    if made.returncode != 0:
        return None
    judged = subprocess.run([program, "judge", str(out / "frame.json"), "--out", str(out / "judged"), "--max", "frame_error=1%",
                             "--max", "frame_acne=0.05%"], capture_output=True, text=True)
    metrics = json.loads((out / "judged/judge.json").read_text())["metrics"]
    print(f"{name}: {metrics}")
    expect(judged.returncode == 0 and metrics["counted"] > 10000, f"{name}: {judged.stdout}{judged.stderr}")
    return metrics


def visibility_of(name):
    data = (folder / name / "visibility.npy").read_bytes()
    return array.array("f", data[10 + struct.unpack("<H", data[8:10])[0]:])


def refused(name, page, model, message, *settings):
    made = shot(page, model, folder / name, *settings)
    expect(made.returncode != 0 and message in made.stderr and "at " not in made.stderr, f"{name}: exit code {made.returncode}, {made.stderr[-2000:]}")
    expect(not (folder / name).exists(), f"{name}: something was written")


for name, page, _, settings in adapters:
    metrics = metrics_of(name, page, "box.glb", *settings)
    if metrics:
        told = json.loads((folder / name / "frame.json").read_text())
        expect(("map" in told) == name.endswith("-map"), f"{name}: frame.json has{'' if 'map' in told else ' no'} map")
    if metrics and name.endswith("-map"):
        # Its own map, looked up as declared, is the frame. The causes of one tap that is not moved exclude each other, so they sum to the error.
        causes = ("acne", "peter_panning", "aliasing_dark", "aliasing_light", "coverage_dark", "coverage_light", "precision", "frame_lookup")
        expect(metrics["frame_lookup"] <= 0.0001, f"{name}: the map's declared lookup is not the frame's")
        if name in ("three-map", "babylon-map"):
            expect(abs(sum(metrics[cause] for cause in causes) - metrics["frame_error"]) <= 0.001, f"{name}: the causes do not sum to the error")

# The light of the file: its direction is the sun's closed form, and the frame is that of the direction.
for name, page, _, settings in adapters:
    if name.endswith("-map"):
        continue
    refused(f"{name}-none", page, "box.glb", "light=file: ", "light=file")
    if name in ("three", "eevee"):  # the pages share this check
        refused(f"{name}-two", page, "lit.glb", "light=file and direction are given", "light=file", "direction=0,-1,0")
    if not metrics_of(f"{name}-file", page, "lit.glb", *settings):
        continue
    told = json.loads((folder / f"{name}-file/frame.json").read_text())
    told = told["light"]["direction"] if name != "eevee" else [told["light"]["direction"][i] * sign for i, sign in ((0, 1), (2, 1), (1, -1))]
    # Engines keep matrices as 32-bit floats, and turn them into quaternions and back.
    expect(max(abs(a - b) for a, b in zip(told, SUN)) < 1e-5, f"{name}: the file's light is {SUN}, the frame's {told}")
    if name not in ("three", "babylon"):
        continue  # the others turn the map with the light's node, so its texels lie elsewhere
    if metrics_of(f"{name}-direction", page, "lit.glb", "direction=" + ",".join(map(repr, SUN)), *settings):
        # The two maps may differ by rounding, which moves a shadow's edge by a pixel in few places.
        differ = sum(abs(a - b) > 0.01 for a, b in zip(visibility_of(f"{name}-file"), visibility_of(f"{name}-direction")))
        expect(differ <= 5, f"{name}: the frame by the file's light differs from that by its direction in {differ} pixels")
sys.exit(bool(bad))
