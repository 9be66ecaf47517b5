"""The filtered maps of engines against Noonmark's prediction: each frame of the cube room that an engine draws with its VSM or its
exponential shadow map has the error that Noonmark measures with the same map and lookup, to 0.1 points. And the lines of Noonmark
for the engine make these maps, typed in as they are.
   engine_lookups_test.py NOONMARK SOURCE FOLDER ENGINE_LINES"""
import json
import struct

from engine_predictions import able, compare, end, folder, found, lines_of, missing, program, run

POINTS = 0.1  # of a hundred: how far the prediction may be from the frame

EXTENT, NEAR, FAR, RESOLUTION = 10, 1, 20, 512
EYE, TARGET = [-1.6, 2.8, 6.4], [0.5, 0.2, 0]
WIDENED = 1.2  # Babylon.js widens the map by shadowOrthoScale, a tenth of it, on each side


def words(numbers):
    return ",".join(map(repr, numbers))


VIEW = [f"eye={words(EYE)}", f"target={words(TARGET)}", "fov_y_deg=45"]
SHOT = VIEW + [f"resolution={RESOLUTION}", f"extent={EXTENT}", f"depth={NEAR},{FAR}"]


def three(bias, *, radius, samples, lookup=()):
    return (["three/page.html", "type=VSMShadowMap", "shadow_side=both", f"radius={radius}", f"blurSamples={samples}", f"bias={-bias}"],
            [[f"map.extent_m={EXTENT}", "lookup.kind=three_vsm", "filter.kind=none", f"lookup.radius={radius}",
              f"lookup.samples={samples}", "lookup.reduction=0.3", "lookup.reduction_span=0.65", "map.moments=16f", f"bias.constant={bias}", *lookup]])


def babylon(engine_filter, kind, bias, shot, *blurs):
    """Each of `blurs` is one prediction: the frame lies between two."""
    return (["babylon/page.html", f"filter={engine_filter}", f"bias={bias}", "forceBackFacesOnly=false", *shot],
            [[f"map.extent_m={EXTENT * WIDENED}", f"lookup.kind={kind}", "lookup.exponent=50", f"bias.constant={bias}", *blur] for blur in blurs])


def box(size, level=0):
    return ["filter.kind=box", f"filter.size={size}", f"lookup.level={level}"]


# The name, what is shot, and what is predicted: one point, or two between which the frame lies.
CASES = [("three.js `VSMShadowMap`, `radius=3 blurSamples=7`", *three(0, radius=3, samples=7)),
         ("three.js `VSMShadowMap`, its defaults", *three(0, radius=1, samples=8)),
         ("three.js `VSMShadowMap`, `radius=4`, `bias=-0.002`", *three(0.002, radius=4, samples=8)),
         ("Babylon.js `useCloseExponentialShadowMap`", *babylon("useCloseExponentialShadowMap", "babylon_close_esm", 0.0005, [], ["filter.kind=none"])),
         ("Babylon.js `useBlurCloseExponentialShadowMap`, `blurScale=1 blurBoxOffset=3`",
          *babylon("useBlurCloseExponentialShadowMap", "babylon_close_esm", 0.0005, ["blurScale=1", "blurBoxOffset=3"], box(7))),
         ("the same with `useKernelBlur=true blurKernel=9`",
          *babylon("useBlurCloseExponentialShadowMap", "babylon_close_esm", 0.0005, ["blurScale=1", "useKernelBlur=true", "blurKernel=9"],
                   ["filter.kind=gaussian", "filter.size=9", "filter.sigma_texels=1.3333333"])),
         ("Babylon.js `useBlurCloseExponentialShadowMap`, its defaults",
          *babylon("useBlurCloseExponentialShadowMap", "babylon_close_esm", 0.0005, [], box(3, level=1))),
         ("the same with `blurBoxOffset=0`",
          *babylon("useBlurCloseExponentialShadowMap", "babylon_close_esm", 0.0005, ["blurBoxOffset=0"], ["filter.kind=none", "lookup.level=1"])),
         ("the same with `useKernelBlur=true blurKernel=9`, `blurScale` 2",
          *babylon("useBlurCloseExponentialShadowMap", "babylon_close_esm", 0.0005, ["useKernelBlur=true", "blurKernel=9"],
                   ["filter.kind=gaussian", "filter.size=9", "filter.sigma_texels=1.3333333", "lookup.level=1"])),
         ("Babylon.js `useBlurExponentialShadowMap`, `blurScale=1 bias=0.02`",
          *babylon("useBlurExponentialShadowMap", "babylon_esm", 0.02, ["blurScale=1"], box(3)))]


def light_through_the_middle(path):
    """Where the light is and what it aims at, so that the middle of its map is that of the scene, as on the pages, and depths begin at
    the light. The meshes of the file have no nodes of their own."""
    data = path.read_bytes()
    told = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
    node = next(one for one in told["nodes"] if "extensions" in one)
    x, y, z, w = node["rotation"]
    way = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))]  # -Z turned
    places = [told["accessors"][part["attributes"]["POSITION"]] for mesh in told["meshes"] for part in mesh["primitives"]]
    middle = [(min(one["min"][k] for one in places) + max(one["max"][k] for one in places)) / 2 for k in range(3)]
    along = sum((middle[k] - node["translation"][k]) * way[k] for k in range(3))
    return [f"light.position_m={words(middle[k] - along * way[k] for k in range(3))}", f"light.target_m={words(middle)}"]


cases = able(CASES)
model = folder / "cube-room.glb"
found(run(program, "export", "cube-room", "--out", model), "export")
AT = ["scene.name=cube-room", f"view.eye_m={words(EYE)}", f"view.target_m={words(TARGET)}", "view.fov_deg=45", f"map.resolution={RESOLUTION}",
      *light_through_the_middle(model)]
PREDICTED = AT + [f"map.near_m={NEAR}", f"map.far_m={FAR}"]
for i, (name, (page, *shot), predictions) in enumerate(cases):
    compare(name, folder / str(i), page, model, SHOT + shot, [PREDICTED + settings for settings in predictions], POINTS)
# A map of 33 m whose surfaces lie in its farther half, where a step of half floats is 8 mm: all but a fifth of the error is theirs.
if not missing("three/page.html"):
    page, *shot = three(0, radius=2, samples=5)[0]
    compare("three.js `VSMShadowMap`, `radius=2 blurSamples=5`, `depth=-20,13`", folder / "deep", page, model,
            VIEW + [f"resolution={RESOLUTION}", f"extent={EXTENT}", "depth=-20,13", *shot],
            [AT + ["map.near_m=-20", "map.far_m=13", *settings] for settings in three(0, radius=2, samples=5)[1]], POINTS)

# The lines of one point, typed in: blur, exponent and bias are none of the defaults of the engines.
TYPED = [("three.js, Noonmark's lines, `radius=2.5 blurSamples=6`", "three/page.html",
          ["lookup.kind=three_vsm", "lookup.radius=2.5", "lookup.samples=6", "lookup.reduction=0.3", "lookup.reduction_span=0.65", "map.moments=16f",
           "bias.constant=0.001"]),
         ("Babylon.js, Noonmark's lines, close, `depthScale=80`, box of 5", "babylon/page.html",
          ["lookup.kind=babylon_close_esm", "lookup.exponent=80", "bias.constant=0.0007", *box(5)]),
         ("Babylon.js, Noonmark's lines, close, `depthScale=80`, Gaussian of 5", "babylon/page.html",
          ["lookup.kind=babylon_close_esm", "lookup.exponent=80", "bias.constant=0.0007", "filter.kind=gaussian", "filter.size=5",
           "filter.sigma_texels=0.6666667"]),
         ("Babylon.js, Noonmark's lines, close, box of 5 on half the texels", "babylon/page.html",
          ["lookup.kind=babylon_close_esm", "lookup.exponent=60", "bias.constant=0.0007", *box(5, level=1)]),
         ("Babylon.js, Noonmark's lines, `depthScale=60`, box of 7", "babylon/page.html",
          ["lookup.kind=babylon_esm", "lookup.exponent=60", "bias.constant=0.03", *box(7)])]
for i, (name, page, settings) in enumerate(TYPED):
    if missing(page):
        continue
    out = folder / f"typed-{i}"
    out.mkdir()
    settings = PREDICTED + [f"map.extent_m={EXTENT}"] + settings
    (out / "lines.txt").write_text(lines_of(settings, name.split(",")[0]))
    compare(name, out / "frame", page, model, [*VIEW, f"lines={out / 'lines.txt'}"], [settings], POINTS)
end()
