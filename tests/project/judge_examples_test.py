"""Compiles and runs examples/judge/judge.c, and runs examples/judge/noonmark.py, against the library as it is built.
   judge_examples_test.py LIBRARY SOURCE FOLDER CC
Exit code 77: numpy is not installed (the C example has run then)."""
import os
import pathlib
import shutil
import subprocess
import sys

library, source, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
program = folder / "judge"
subprocess.run([sys.argv[4], "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{source / 'frames'}", str(source / "examples/judge/judge.c"),
                str(library), f"-Wl,-rpath,{library.parent}", "-o", str(program)], check=True)
ran = subprocess.run([program], capture_output=True, text=True)
assert ran.returncode == 1, ran.stdout + ran.stderr
numbers = dict(line.split(" = ") for line in ran.stdout.splitlines() if " = " in line)
assert float(numbers["frame_acne"]) > 0.5 and "shaded (not checked)" in ran.stdout, ran.stdout
# Nothing of the library but the interface is seen from outside.
names = subprocess.run(["nm", "-D", "--defined-only", str(library)], capture_output=True, text=True, check=True).stdout
others = [line for line in names.splitlines() if line.split()[1] in "TDB" and not line.split()[-1].startswith("noonmark_")]
assert not others, others

python = shutil.which("python3", path="/usr/bin:" + os.environ["PATH"])
if subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode != 0:
    print("numpy is not installed")
    sys.exit(77)
script = """
import numpy as np, noonmark
scene = noonmark.Scene("plate")
view = np.array([[2 / 12, 0, 0, 0], [0, 0, -2 / 6.75, 0], [0, -2 / 20, 0, -0.4], [0, 0, 0, 1]])
light = dict(light_direction=(0.5, -1, 0))
black = scene.judge(np.zeros((180, 320)), view, accept=("shaded", "match", "intensity"), **light)
assert black["frame_acne"] > 0.5 and black["classes"].shape == (180, 320), black
exact = scene.judge(black["truth"], view, **light)
assert exact["frame_error"] == 0, exact
for wrong in (lambda: scene.judge(1 - black["truth"], view, **light), lambda: noonmark.Scene("missing.glb"),
              lambda: scene.judge(black["truth"], np.zeros((4, 4)), **light)):
    try:
        wrong()
        raise SystemExit("not refused")
    except noonmark.Refused as why:
        print(why)
"""
subprocess.run([python, "-c", script], env={**os.environ, "NOONMARK_LIBRARY": str(library), "PYTHONPATH": str(source / "examples/judge"), "PYTHONDONTWRITEBYTECODE": "1"}, check=True)
