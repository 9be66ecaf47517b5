"""The reader of captures against programs that know what they drew: one for each feature, whose visibility, light and camera the reader
must find, and one for each planted fault, whose cause must be named. A table says what was found.
   captures_test.py NOONMARK SOURCE FOLDER [NAME]...    only these features and faults"""
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys

program, source, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
only = sys.argv[4:]
here = source / "tests/captures"
python = "/usr/bin/python3"  # for this interpreter alone Debian builds the module renderdoc
for tool in ("renderdoccmd", "Xvfb", "cc"):
    if not shutil.which(tool):
        print(f"skipped: there is no {tool} (Debian: renderdoc, xvfb, gcc)")
        sys.exit(77)
if subprocess.run([python, "-c", "import renderdoc, numpy"], capture_output=True).returncode:
    print("skipped: python3-renderdoc or python3-numpy is missing")
    sys.exit(77)
if pathlib.Path(sys.executable).resolve() != pathlib.Path(python).resolve():
    os.execv(python, [python, *sys.argv])  # for its numpy
import numpy as np  # noqa: E402

# A value of a float target is what the shader wrote, and the visibility is a quotient of differences of three of them.
VISIBILITY = 1e-5
# Of two shaded lights in a target of half floats: a step of it, where the light changes the picture by at least eight of them.
HALF = 1 / 8
# The least squares over float positions leave 1e-6 of clip space (a residual that the reader prints); the scene has 10 m.
DIRECTION, PLACE_M, CAMERA = 2e-6, 5e-5, 1e-5
# How far programs move the place that they look up along the normal, and how fine the reader's steps are, in texels.
OFFSETS, STEP = {"normal-offset": 1.75}, 0.125
# Of a hundred: a receiver here is 0.012 points, and the depths of both frames differ by their rounding.
POINTS = 0.05

# The features of a program, and the number of maps of each light, or the words of the refusal.
FEATURES = {"sun": [1], "spot": [1], "point": [6], "cascades-atlas": [3], "cascades-array": [3], "reversed": [1], "infinite": [1], "depth16": [1],
            "depth24": [1], "stencil": [1], "moments": [1], "exponential": [1], "compare": [1], "indexed instanced": [1], "indexed skinned": [1], "masked": [1], "masked compressed": [1], "masked packed": [1], "masked gone": [1], "reversed infinite": [1], "point reversed": [6],
            "msaa": [1], "outside": [1], "prepass indexed": [1], "two": [1, 1], "deferred": [1], "deferred cascades-array": [3], "shaded": [1],
            "shaded two prepass": [1, 1], "srgb": [1], "box srgb": [1], "temporal": [1], "polygon-offset": [1], "vertex-bias": [1], "orthographic": [1],
            "fragment-lookup": [1], "normal-offset": [1], "patches": [1], "backs": [1], "backs clockwise": [1], "strips": [1], "strips instanced": [1], "geometry indexed instanced": [1], "multidraw": "[Ii]ndirect"}
# The fault, and what reader or verdict say of it, which they must not say of any program without one.
FAULTS = {"no-model": "the lookup lacks their model matrix", "stale": "MAP AND LOOKUP DIFFER.*another frame", "half": "128 x 128 fills a part",
          "culled": "not in the map although in the picture: draw \\d+$", "sides": "without front faces", "gequal": "light and shadow are exchanged",
          "component": "A BIAS BELOW 0", "small": "frame_acne +[1-9]\\d\\.", "large": "peter_panning +0\\.[1-9]",
          "other-map": "has no effect on the picture", "aspect": "MAP AND LOOKUP DIFFER.* 1\\.7778 X"}
FAULTS |= {f"{fault} {feature}": FAULTS[fault] for fault, feature in [("stale", "spot"), ("culled", "point"), ("culled", "cascades-array"),
                                                                      ("no-model", "shaded"), ("sides", "backs clockwise")]}
FAULTS["culled-instance instanced"] = "not in the map although in the picture: draw \\d+, instance 2$"
# What a capture does not tell of a program that has no fault, and what the reader says of it.
SAID = {"masked procedural": "no texture explains which: \\d+", "box curved": "the channels of the picture disagree",
        "beyond": "\\d{3,} of them lie beyond the borders", "bright": "\\d+ pixels reach the end of their format"}
bad = []


def run(*command, **more):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, **more)


def capture(name):
    """Draws and captures a frame: the capture's path, and the folder of what the program knows."""
    out = folder / name.replace(" ", "-")
    out.mkdir(parents=True)
    ran = run("renderdoccmd", "capture", "-w", "-d", out, "-c", out / "frame", folder / "program", here / "scene.glsl", out, *name.split(), timeout=120)
    frames = list(out.glob("*.rdc"))
    if len(frames) != 1 or not (out / "known.json").exists():
        raise SystemExit(f"{name} was not captured: {ran.stdout}{ran.stderr}")
    return frames[0], out


def known_of(out):
    known = json.loads((out / "known.json").read_text())
    for key in ("camera_view", "camera_projection"):
        known[key] = np.array(known[key]).reshape(4, 4).T
    size = np.load(out / "visibility-1.npy").shape[::-1]  # a picture of several samples is that of its first one, from where that is in the pixel
    known["camera_projection"][:2] -= np.outer((2 * np.array(known["sample"]) - 1) / size, known["camera_projection"][3])
    return known


def differences(known, out, frames):
    """What of the frames is not what the program knows."""
    view, found = known["camera_view"], []
    for i, (light, frame) in enumerate(zip(known["lights"], frames), 1):
        told, way = frame["light"], np.array(light["way"])
        if light["kind"] == "directional":
            off = np.linalg.norm(np.cross(view[:3, :3] @ -way, told.get("direction", [0, 0, 0])))
            if told["kind"] != "directional" or not off < DIRECTION:
                found.append(f"light {i}: direction off by {off:.1e}")
        else:
            off = np.linalg.norm((view @ [*way, 1])[:3] - told.get("position", [9, 9, 9]))
            if told["kind"] != light["kind"] or not off < PLACE_M:
                found.append(f"light {i}: {told['kind']}, off by {off:.1e} m")
        camera = np.array(frame["camera"]["clip_from_world"]).reshape(4, 4, order="C" if frame["camera"]["order"] == "row" else "F")
        true = known["camera_projection"]
        if "orthographic" in out.name:  # parallel rays do not tell the length of a unit, which is the world's of the frame
            true = true @ np.diag([*[camera[0, 0] / true[0, 0]] * 3, 1])
            true[2] = camera[2]
        if np.abs(camera - true).max() > CAMERA:
            found.append(f"camera off by {np.abs(camera - true).max():.1e}")
        got, want = np.load(out / "frames" / frame["visibility"]["file"]), np.load(out / f"visibility-{i}.npy")
        both = (got >= 0) & (want >= 0)
        off = np.abs(got - want)[both]
        surfaces, judged = int((want >= 0).sum()), int(both.sum())
        if ((got >= 0) & (want < 0)).any():
            found.append(f"light {i}: {int(((got >= 0) & (want < 0)).sum())} pixels have a visibility and no surface")
        if judged < 0.95 * surfaces:  # grazing faces of shaded pictures say nothing
            found.append(f"light {i}: only {judged} of {surfaces} surfaces are judged")
        bound = HALF if len(known["lights"]) == 2 and "shaded" in out.name else VISIBILITY
        if "box" in out.name:  # partly lit in steps of a picture of 8 bits, which the reader knows; a pixel in a thousand may be off by more
            bound, off = frame["visibility"]["step"], np.percentile(off, 99.9)
        if judged and off.max() > bound:
            found.append(f"light {i}: the visibility is off in {int((off > bound).sum())} of {judged} pixels, by up to {off.max():.4f}")
    return found


def own_frame(known, out, i):
    """The frame.json that the program's author would write: its own triangles, matrices, depths and visibility."""
    corners = [2, 1, 0] if "clockwise" in out.name else [0, 1, 2]  # glTF's front is counterclockwise
    points = np.ascontiguousarray(np.load(out / "triangles.npy").reshape(-1, 3, 3)[:, corners].reshape(-1, 3), "<f4")
    told = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "materials": [{"doubleSided": "backs" not in out.name}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                           "min": points.min(0).tolist(), "max": points.max(0).tolist()}],
            "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}], "buffers": [{"byteLength": points.nbytes}]}
    text = json.dumps(told).encode()
    text += b" " * (-len(text) % 4)
    (out / "own.glb").write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + points.nbytes, len(text), 0x4E4F534A) + text +
                                  struct.pack("<II", points.nbytes, 0x004E4942) + points.tobytes())
    light, reversed_depth = known["lights"][i], "reversed" in out.name
    way = light["way"]
    frame = {"noonmark_frame": 1, "scene": "own.glb", "visibility": {"file": f"visibility-{i + 1}.npy", "normalised": True},
             "camera": {"view": known["camera_view"].flatten().tolist(), "projection": known["camera_projection"].flatten().tolist(), "order": "row",
                        "depth_range": "0..1" if reversed_depth else "-1..1", "reversed": reversed_depth},
             "light": {"directional": {"kind": "directional", "direction": [-x for x in way]}, "point": {"kind": "point", "position": way},
                       "spot": {"kind": "spot", "position": way, "target": [-0.2, 0, -0.2], "cone_deg": 170}}[light["kind"]]}
    if (out / "depth.npy").exists():
        frame["depth"] = {"file": "depth.npy", "measure": "window"}
    path = out / f"own-{i + 1}.json"
    path.write_text(json.dumps(frame))
    return path


def judge(frame, *more):
    """What the program says of a frame: all that it prints, and its numbers."""
    out = frame.with_suffix("")
    ran = run(program, "judge", frame, "--out", out, *more)
    said = ran.stdout + ran.stderr
    if ran.returncode and not more and "map" in json.loads(frame.read_text()):  # the lookup is not one that can be declared: by place alone
        text, numbers = judge(frame, "--without-map")
        return said + text, numbers
    return said, json.loads((out / "judge.json").read_text())["metrics"] if ran.returncode == 0 else {}


def read(rdc, out):
    """The reader's exit code, what it said, and the frames of the lights."""
    (out / "frames").mkdir()
    ran = run(python, os.environ.get("NOONMARK_READER", source / "captures/capture.py"), rdc, out / "frames", timeout=300)
    frames = sorted(path for path in (out / "frames").glob("light-*.json") if re.fullmatch(r"light-\d+", path.stem))
    return ran.returncode, ran.stdout + ran.stderr, frames


def one_command(rdc, out, errors):
    """What is wrong with `noonmark judge FRAME.rdc`, which says the same of each light in one line at its end."""
    ran = run(program, "judge", rdc, "--out", out / "one-command")
    lines = re.findall(r"^light-(\d+) \(.*error ([\d.]+)%", ran.stdout, re.M)
    told = [(str(i), f"{100 * error:.3g}") for i, error in enumerate(errors, 1)]
    return [] if ran.returncode == 0 and lines == told else [f"noonmark judge ended with {ran.returncode}: {lines}, not {told}: {ran.stderr}"]


def maps_of(said, light):
    return len(re.findall(f"^light {light}, .*: map ", said, re.M))


def check(name, maps, cause):
    """One row of the table, and what is wrong with it."""
    rdc, out = capture(name)
    code, said, frames = read(rdc, out)
    (out / "reader.txt").write_text(said)
    if isinstance(maps, str):
        wrong = [] if code == 3 and re.search(maps, said) else [f"is not refused by name ({maps}): {code} {said.strip().splitlines()[-1:]}"]
        return wrong, "refused: " + (said.strip().splitlines() or ["?"])[-1]
    if code:
        return [f"the reader ended with {code}: {said.strip().splitlines()[-1:]}"], ""
    known, wrong = known_of(out), []
    told = [json.loads(path.read_text()) for path in frames]
    if not cause and len(frames) != len(known["lights"]):
        wrong.append(f"{len(frames)} lights of {len(known['lights'])}")
    counts = [maps_of(said, path.stem[6:]) for path in frames]
    if not cause and counts != maps:
        wrong.append(f"maps {counts}, not {maps}")
    if not cause:
        wrong += differences(known, out, told)
        techniques = [frame["map"]["technique"] for frame in told if "map" in frame]
        if name in OFFSETS and not techniques:
            wrong.append("its lookup is not known")
        wrong += [f"an offset of {found['bias.normal_offset']} texels along the normal" for found in techniques
                  if abs(float(found["bias.normal_offset"]) - OFFSETS.get(name, 0)) > STEP]
    words, verdicts, errors = [], "", []
    for i, path in enumerate(frames):
        text, numbers = judge(path)
        verdicts += text
        (out / f"verdict-{i + 1}.txt").write_text(text)
        if not numbers:
            wrong.append(f"light {i + 1}: not judged: {text.strip().splitlines()[-1:]}")
            continue
        errors.append(numbers["frame_error"])
        if "box" in name and not cause and "acne" not in numbers:
            wrong.append("its lookup is known, and its error has no causes")
        words.append(f"error {100 * numbers['frame_error']:.3f}%")
        if not cause:
            own_text, own = judge(own_frame(known, out, i))
            if not own:
                raise SystemExit(f"{name}: the program's own frame is refused: {own_text}")
            words.append(f"(own {100 * own['frame_error']:.3f}%)")
            if abs(numbers["frame_error"] - own["frame_error"]) > POINTS / 100:
                wrong.append(f"light {i + 1}: the error is {100 * numbers['frame_error']:.3f}%, of the program's own frame {100 * own['frame_error']:.3f}%")
    if name == "two":
        wrong += one_command(rdc, out, errors)
    if not cause:
        wrong += [f"the cause of {fault} is named: {words_of}" for fault, words_of in (FAULTS | SAID).items() if re.search(words_of, said + verdicts, re.M)]
    if cause:
        named = re.search(f"^.*({cause}).*$", said + verdicts, re.M)
        words.append(f"named: {named[0].strip()}" if named else "NOT NAMED")
        if not named and name in SAID:
            wrong.append("it is not said")
        elif not named:
            unnamed.append(name)
    return wrong, " ".join(words)


shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
made = run("cc", "-std=gnu11", "-O1", "-Wall", "-Wextra", "-Werror", here / "program.c", "-o", folder / "program", "-lEGL", "-lGL", "-lm", "-ldl")
if made.returncode:
    if "No such file" in made.stderr or "cannot find" in made.stderr:
        print(f"skipped: libegl-dev or libgl-dev is missing: {made.stderr.splitlines()[0]}")
        sys.exit(77)
    raise SystemExit(made.stderr)
reading, writing = os.pipe()
server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "640x480x24", "-nolisten", "tcp"], pass_fds=[writing],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
try:
    os.close(writing)
    os.environ.update(DISPLAY=":" + os.read(reading, 20).decode().strip(), LIBGL_ALWAYS_SOFTWARE="1", LP_NUM_THREADS="2")
    unnamed, faults = [], 0
    for name, maps, cause in [(*row, "") for row in FEATURES.items()] + [(name, [], cause) for name, cause in (FAULTS | SAID).items()]:
        if only and name not in only:
            continue
        faults += name in FAULTS
        wrong, found = check(name, maps, cause)
        print(f"{name:24} {'FAILED' if wrong else 'ok':7} {found}", flush=True)
        for one in wrong:
            print(f"{'':24}   {one}")
            bad.append(f"{name}: {one}")
finally:
    server.terminate()
    server.wait()
if faults:
    print(f"{faults - len(unnamed)} of {faults} planted faults are named" + (f"; not {', '.join(unnamed)}" if unnamed else ""))
if 10 * len(unnamed) > faults:
    bad.append("at least nine of ten must be named")
if bad:
    raise SystemExit(f"{len(bad)} failures")
print(f"captures are read as the programs drew them; {os.times().children_user + os.times().children_system:.0f} s of processor time")
