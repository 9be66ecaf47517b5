"""What the tests share that predict frames of engines: an engine draws a frame in headless Chromium, `noonmark judge` measures its
error, and `noonmark render` predicts it. They are called as
   TEST NOONMARK SOURCE FOLDER ENGINE_LINES
and print the rows of the tables in examples/engines/README.md. They skip (77) where no engine can run: node, Chromium or the
packages of examples/engines/package.json (npm install in that folder, or NODE_MODULES names another one) are not installed."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

program, source, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
engines = source / "examples/engines"
modules = pathlib.Path(os.environ.get("NODE_MODULES", engines / "node_modules"))
SKIP = 77
bad = []  # a line for each prediction that is off


def missing(page):
    package = {"three": "three", "babylon": "babylonjs"}[page.split("/")[0]]
    lacking = [tool for tool in ("node", "chromium") if not shutil.which(tool)]
    return " ".join(lacking + ([] if (modules / package).is_dir() else [f"{modules}/{package}"]))


def run(*command):
    return subprocess.run([str(part) for part in command], env={**os.environ, "NODE_MODULES": str(modules)}, capture_output=True, text=True)


def found(ran, what):
    if ran.returncode != 0:
        print(f"{what}: exit code {ran.returncode}\n{ran.stdout[-2000:]}{ran.stderr[-2000:]}")
        sys.exit(1)


def sets(settings):
    return [word for one in settings for word in ("--set", one)]


def able(cases):
    """Those of the cases whose engine can run, in an empty folder. A case: its name, its page with what is shot, its predictions."""
    for page in sorted({shot[0] for _, shot, _ in cases}):
        if missing(page):
            print(f"not run: {page}, which needs {missing(page)}")
    able_cases = [case for case in cases if not missing(case[1][0])]
    if not able_cases:
        print("no engine is installed")
        sys.exit(SKIP)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return able_cases


def compare(name, out, page, model, shot, predictions, points):
    """Draws a frame and measures its predictions, each a list of settings. One prediction must be within so many points of a hundred;
    between two the frame must lie. Returns each prediction's point.json."""
    found(run("node", engines / "shoot.mjs", page, model, out, *shot), name)
    found(run(program, "judge", out / "frame.json", "--out", out / "judged"), name)
    of_frame = 100 * json.loads((out / "judged/judge.json").read_text())["metrics"]["frame_error"]
    measured = []
    for k, settings in enumerate(predictions):
        found(run(program, "render", *sets(settings), "--out", out / f"predicted-{k}"), name)
        measured.append(json.loads((out / f"predicted-{k}/point.json").read_text()))
    errors = sorted(100 * point["metrics"]["error"] for point in measured)
    print(f"| {name} | {of_frame:.3f}% | {' to '.join(f'{error:.3f}%' for error in errors)} |", flush=True)
    if not (abs(errors[0] - of_frame) <= points if len(errors) == 1 else errors[0] <= of_frame <= errors[-1]):
        bad.append(f"{name}: the frame has {of_frame:.3f}%, the prediction {errors}")
    return measured


def lines_of(settings, engine):
    """The lines for an engine of these settings."""
    ran = run(sys.argv[4], *settings)
    found(ran, f"the lines for {engine}")
    return re.search(rf"^{re.escape(engine)} \(.*\n((?:    .*\n)+)", ran.stdout, re.M).group(1)


def end():
    print("\n".join(bad))
    sys.exit(bool(bad))
