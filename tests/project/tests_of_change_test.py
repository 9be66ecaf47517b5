# scripts/tests-of-change asks for what a change can break, and the tests have the labels that it asks for. tests_of_change_test.py SOURCE BUILD
import json
import re
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

source, build = Path(sys.argv[1]), sys.argv[2]
sys.dont_write_bytecode = True
change = SourceFileLoader("change", str(source / "scripts/tests-of-change")).load_module()
rooms = change.rooms_of_law()
listed = json.loads(subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], check=True, capture_output=True, text=True).stdout)["tests"]
labels = {test["name"]: {label for item in test["properties"] if item["name"] == "LABELS" for label in item["value"]} for test in listed}
labels = {name: of for name, of in labels.items() if not name.endswith("_NOT_BUILT")}  # in a build of some programs alone
faults = []

# A file, tests that its change asks for, and tests that it does not.
for path, asked, not_asked in (
        ("compare/judge/bounds.cpp", "bounds report engines experiment include_law.holds", "store gl scenes acceptance program"),
        ("compare/results/metrics.h", "store curves compare report experiment", "gl raytrace technique laws"),
        ("app/sweep/sweep.cpp", "views memory experiment program rejudge", "engines image_file compare"),
        ("gl/renderer.h", "gl live_page experiment", "raytrace store frames"),
        ("technique/bias.cpp", "technique settings gl raytrace frames bounds", "scenes file acceptance"),
        ("measure/workbench.cpp", "acceptance laws planted", "compare gl"),
        ("compare/ladder/ladder.h", "planted compare curves fuzz", "store laws"),
        ("tests/compare/judge/bounds_test.cpp", "bounds compare", "report store documents.site"),
        ("tests/gl/map_test.cpp", "gl", "report raytrace"),
        ("docs/reference/limits.md", "documents", "gl bounds"),
        ("base/error.h", "file scenes gl store bounds experiment", "laws"),
        ("CMakeLists.txt", "", "")):
    wanted = change.labels_of(path, rooms)
    if (path == "CMakeLists.txt") != (not wanted):
        faults.append(f"{path} asks for {wanted or 'all tests'}")
    for names, expected in ((asked, True), (not_asked, False)):
        faults += [f"{path}: {name} is {'not ' if expected else ''}asked for" for name in names.split()
                   if name in labels and bool(labels[name] & (wanted | {change.ALWAYS})) != expected]

of_rooms = {label.removeprefix("whole:") for of in labels.values() for label in of}
faults += [f"no test has the label of the room {room}" for room in sorted(set(rooms) - of_rooms) if room != "compare/results"]
faults += [f"{name} has the label {label}, which is no room" for name, of in labels.items() for label in of
           if not label.startswith("tests/") and label not in ("always", "documents", "package", "slow") and label.removeprefix("whole:") not in rooms]
faults += [f"{name} has no label of its folder" for name, of in labels.items() if not any(label.startswith("tests/") for label in of)]
rows = re.findall(r"^\| `([^`]+)` \| [0-9]+ s \|", (source / "CONTRIBUTING.md").read_text(), re.M)
# What needs a program that is not built yet, or Python's packages, may be unknown.
faults += [f"CONTRIBUTING.md: no test's name begins with {row}" for row in rows
           if not any((name + ".").startswith((row + ".", row + "_")) for name in labels) and not row.startswith(("program.", "picture."))]
if not rows or not any("slow" in of for of in labels.values()):
    faults.append("no test is slow")
sys.exit("\n".join(faults) or 0)
