"""The cascades of engines against Noonmark's prediction: each frame of the street that an engine draws with its cascades has the
error that Noonmark measures with the engine's splits, fit, bias and filter, to 0.05 points.
   engine_cascades_test.py NOONMARK SOURCE FOLDER ENGINE_LINES
And the lines of Noonmark for the engine lay these cascades, typed in as they are."""
import json
import re

from engine_predictions import able, bad, compare, end, folder, found, lines_of, missing, program, run

POINTS = 0.05  # of a hundred: how far the prediction may be from the frame

# The street as its scene is seen, with near and far planes that both sides are given.
NEAR, FAR, RESOLUTION = 0.2, 79, 1024
SHOT = ["eye=0,1.6,0", "target=0.15,1.25,-12", "fov_y_deg=60", f"near={NEAR}", f"far={FAR}"]
PREDICTED = ["scene.name=street", f"view.near_m={NEAR}", f"view.far_m={FAR}", f"map.reach_m={FAR}", f"map.resolution={RESOLUTION}", "map.snap=true"]

FLOATS = 2 ** -24 * FAR / NEAR  # Babylon.js finds the corners by an inverse matrix of floats, which loses far / near

CSM_DEPTH_M = 1999  # from lightNear to lightFar of CSM, by default
# How far SwiftShader moves a vertex at most, in texels (1/16 of one is its grid), and so how far depths of the ground may be off:
# |g|, of law 1, is at most sqrt(2) tan(theta) of the ground under this sun. In metres for the nearest cascade's texels.
RASTER_M = 0.0239 / 32 * 2 ** 0.5 * 0.88


def csm(bias, off_m=0, fade=False):
    """The square of the longest diagonal; one bias in depth is one in metres, because all maps are as deep."""
    faded = ["cascades.blend=0.25", "cascades.blend_of=square"] if fade else []
    return (["three/page.html", "class=CSM", "cascades=4", "type=BasicShadowMap", "shadow_side=both", f"bias={-bias}", *(["fade=true"] if fade else [])],
            [["cascades.count=4", "map.fit=corner_square", "bias.unit=m", f"bias.constant={bias * CSM_DEPTH_M + off}", *faded]
             for off in ([-off_m, off_m] if off_m else [0])])


def babylon(stabilize, bias, blend=0, filtered=(), filter_settings=()):
    """The sphere about the corners' mean; what lies before near is clamped to it, so near and far are the slice's. Without
    stabilizeCascades it is the corners' box, whose texels are narrower by up to a half along one side: between texels of the longer
    side and texels of half of that."""
    fits = [["map.fit=corner_sphere", "cascades.radius_round_m=0.0625"]] if stabilize else [["map.fit=corner_box"], ["map.fit=corner_box", f"map.resolution={2 * RESOLUTION}"]]
    return (["babylon/page.html", "class=CascadedShadowGenerator", f"blend={blend}", f"stabilize={str(stabilize).lower()}", f"bias={bias}", *filtered],
            [["cascades.count=4", "map.depth_clamp=true", f"bias.constant={bias}", f"cascades.blend={blend}", "cascades.cover_band=false",
              *filter_settings, *fit] for fit in fits])


def sun(bias):
    """Two cascades with the sphere about the corners' mean, of the 1020 texels that are left of a tile and half a texel wider on each
    side. Its depths reach over 167 m in the first and 244 m in the second cascade (depth_m of laid.json), so one bias in depth has other
    metres in each."""
    first_m, second_m = 167.22, 244.14
    laid = ["cascades.count=2", "map.fit=corner_sphere", "map.resolution=1020", f"map.extent_scale={1020 / 1019!r}", "cascades.blend=0.1", "cascades.blend_shape=smooth"]
    return (["three/page.html", "class=SunLight", "type=BasicShadowMap", "shadow_side=both", f"bias={-bias}"],
            [[*laid, "bias.unit=m", f"bias.constant={bias * first_m}", f"cascades.bias_scales=1,{second_m / first_m!r}"]])


# The name, what is shot, and what is predicted: one point, or two between which the frame lies.
CASES = [("three.js CSM, `bias=-0.00002`", *csm(0.00002, RASTER_M)), ("three.js CSM, `bias=-0.0003`", *csm(0.0003)),
         ("three.js CSM, `fade=true bias=-0.0003`", *csm(0.0003, fade=True)),
         ("Babylon.js, `stabilize=true bias=0.001`", *babylon(True, 0.001)), ("Babylon.js, `stabilize=true bias=0.01`", *babylon(True, 0.01)),
         ("Babylon.js, `stabilize=true filter=usePercentageCloserFiltering bias=0.008`",
          *babylon(True, 0.008, 0, ["filter=usePercentageCloserFiltering"], ["bias.constant=0.012", "filter.kind=castano", "filter.size=5"])),
         ("Babylon.js, `stabilize=true blend=0.1 bias=0.01`", *babylon(True, 0.01, 0.1)),
         ("three.js SunLight, `bias=-0.003`", *sun(0.003)),
         ("Babylon.js, `bias=0.001`", *babylon(False, 0.001)), ("Babylon.js, `bias=0.01`", *babylon(False, 0.01))]


cases = able(CASES)
found(run(program, "export", "street", "--out", folder / "street.glb"), "export")


def compared(name, out, page, shot, predictions):
    """Draws a frame and measures the points; the texels are the same, and the errors as near as they must be."""
    points = compare(name, out, page, folder / "street.glb", SHOT + shot, [PREDICTED + settings for settings in predictions], POINTS)
    laid = json.loads((out / "laid.json").read_text())["cascades"]
    for point in points:
        for one, other in zip(laid, point["cascades"], strict=True):
            widest = max(one["width_m"], one["height_m"])
            if abs(other["light"]["extent_m"] / widest - 1) > FLOATS:
                bad.append(f"{name}: a map is {other['light']['extent_m']} m wide, the engine's {widest} m")
    return laid


for i, (name, (page, *shot), predictions) in enumerate(cases):
    compared(name, folder / str(i), page, [f"resolution={RESOLUTION}", *shot], predictions)

# The lines of one point: 2.3 texels of bias in each cascade, as the engine can have it.
ENDS, TEXELS = [9, 20, 37], 2.3
TYPED = ["cascades.count=4", "cascades.splits=manual", f"cascades.bounds_m={','.join(map(str, ENDS))}", "bias.unit=texel", f"bias.constant={TEXELS}"]


def typed(engine, page, fit):
    """fit: the settings that predict the frame, from the text of the lines."""
    lines = lines_of(PREDICTED + TYPED + ["map.fit=sphere"], engine)
    (folder / "lines.txt").write_text(lines)
    # The lines' own ends and biases, by which the frame is predicted.
    laid = compared(f"{engine}, Noonmark's lines", folder / f"typed-{page.split('/')[0]}", page, [f"lines={folder / 'lines.txt'}"], [TYPED + fit(lines)])
    return [one["end_m"] for one in laid]


if not missing("three/page.html"):
    longer = (FAR + NEAR) / FAR  # the maps' slices end at the ends' shares of maxFar, which is near beyond the reach
    ends = typed("three.js", "three/page.html", lambda lines: ["map.fit=corner_square", f"map.reach_m={FAR * longer}",
                                                               f"cascades.bounds_m={','.join(repr(end * longer) for end in ENDS)}"])
    if max(abs(a / b - 1) for a, b in zip(ends, ENDS + [FAR], strict=True)) > 1e-5:  # of six digits
        bad.append(f"three.js: the lines end cascades at {ends}")
if not missing("babylon/page.html"):
    def of_babylon(lines):
        number = lambda field: re.search(rf"{field} = ([-0-9.e]+);", lines).group(1)
        return ["map.fit=corner_sphere", "cascades.radius_round_m=0.0625", "map.depth_clamp=true", "cascades.splits=practical",
                f"cascades.lambda={number('lambda')}", "bias.unit=depth", f"bias.constant={number('shadowGenerator.bias')}"]
    typed("Babylon.js", "babylon/page.html", of_babylon)
end()
