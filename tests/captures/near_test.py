"""A camera whose near plane is close by, as in Blender's viewport, and a map that spans hundreds of metres: the matrix between them is found
from positions in float. Argument: the source folder. Exit code 77: numpy or renderdoc is missing."""
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

python = "/usr/bin/python3"  # for this interpreter alone Debian builds the module renderdoc
if subprocess.run([python, "-c", "import renderdoc, numpy"], capture_output=True).returncode:
    print("skipped: python3-renderdoc or python3-numpy is missing")
    sys.exit(77)
if Path(sys.executable).resolve() != Path(python).resolve():
    os.execv(python, [python, *sys.argv])
sys.path.insert(0, sys.argv[1] + "/captures")
import numpy as np  # noqa: E402
import solve  # noqa: E402

near, far, span_m = 0.01, 1000.0, 470.0
camera = np.array([[1.4, 0, 0, 0], [0, 2.3, 0, 0], [0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)], [0, 0, -1, 0]])
toward = np.array([3, -5, -2]) / np.sqrt(38)
right = np.cross(toward, [0, 1, 0])
right /= np.linalg.norm(right)
light = np.eye(4)
light[:3, :3] = [2 / span_m * right, 2 / span_m * np.cross(right, toward), 0.01 * toward]

random = np.random.default_rng(1)
clips, draws = {}, {True: [], False: []}
for event in range(4):
    world = np.c_[random.uniform([-6, -6, -14], [6, 6, -2], (200, 3)), np.ones(200)]
    for of_camera, matrix in ((True, camera), (False, light)):
        draw = SimpleNamespace(name="draw", event=2 * event + of_camera, geometry=event, count=200,
                               reversed=False, zero_to_one=False, culls_ccw=None)
        clips[draw.event] = (world @ matrix.T).astype("f4").astype("f8")
        draws[of_camera].append(draw)
capture = SimpleNamespace(clip=lambda draw: clips[draw.event])
picture = solve.Pass(draws[True], ("depth", 0), (), (0, 0, 640, 360), camera)
found = solve.map_of(solve.Pass(draws[False], ("map", 0), (), (0, 0, 1024, 1024)), picture, capture)
if not found or found.eye[3] != 0:
    sys.exit(f"FAILED: the map of a sun is read as {found and found.eye}")
# Light positions below 1 are rounded to 6e-8. The matrix must not add the rounding of the camera's positions, of which near leaves 0.02 for its constant.
if found.residual > 2e-7:
    sys.exit(f"FAILED: the matrix leaves {found.residual:.1e} of the clip unit")
# The scene is 12 m of 470 m, so a direction is known to 470 / 12 roundings.
off = np.abs(found.along - toward).max()
if off > 1e-5:
    sys.exit(f"FAILED: the direction is off by {off:.1e}")
print(f"direction within {off:.1e}, residual {found.residual:.1e}")
