"""Two shares measured from copies of a project in two folders, as on two hosts, are one experiment: merge joins them, and no
path of either folder is left in the joined results. A scene with other contents is refused.

Arguments: the program, the source folder, an empty folder to work in.
"""
import csv
import json
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

program, source, work = (Path(argument).resolve() for argument in sys.argv[1:4])
failures = 0


def expect(holds, message):
    global failures
    if not holds:
        failures += 1
        print(f"FAILED: {message}")


def noonmark(*arguments):
    done = subprocess.run([program, *map(str, arguments)], cwd=work, capture_output=True, text=True)
    print(f"== {arguments}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done


shutil.rmtree(work, ignore_errors=True)
for host in ("ann", "bob", "eve"):
    shutil.copytree(source / "experiments/atlas/models", work / host / "project/models")
    (work / host / "project/sets").mkdir()
    (work / host / "project/sets/x.toml").write_text("""scene = "../models/wedge.gltf"
pictures = "none"
[view]
width_px = 48
height_px = 27
[sweep]
map.resolution = [32, 64, 128]
filter.kind = ["none", "box"]
[[bound]]
metric = "acne"
max = 1
""")
# Eve's wedge is another one.
model = work / "eve/project/models/wedge.gltf"
gltf = json.loads(model.read_text())
gltf["nodes"][0]["scale"] = [1, 1.1, 1]
model.write_text(json.dumps(gltf))


def share(host, number):
    folder = work / host / "project/sets"
    done = noonmark("run", folder / "x.toml", "--out", folder / "out", "--shard", f"{number}/2", "--quiet")
    expect(done.returncode == 0, f"{host} measures share {number}")
    return folder / f"out/share-{number}-of-2"


def rows(folder):
    """Every column of results.csv but for times, machines and the path of the scene."""
    expect(noonmark("report", folder, "--all").returncode == 0, f"the report of {folder} is written again")
    with open(work / folder / "results.csv") as file:
        return [{name: value for name, value in row.items()
                 if "_ms" not in name and name != "scene.name" and not name.startswith("machine_")}
                for row in csv.DictReader(file)]


shares = [share("ann", 1), share("bob", 2)]
merged = noonmark("merge", "joined", *shares)
expect(merged.returncode == 0, "shares from two folders are joined")
one = noonmark("check", "ann/project/sets/x.toml", "--out", "one", "--quiet")
expect(one.returncode == 0, "one run measures all")
if not failures:
    expect(len(rows("joined")) == 6, "all points are there")
    expect(rows("joined") == rows("one"), "the numbers are those of one run")
    for file in (work / "joined").rglob("*"):
        if file.is_file():
            expect(str(work).encode() not in file.read_bytes(), f"no path of a host is in {file.name}")
    with sqlite3.connect(work / "joined/results.sqlite") as db:
        names = {row[0] for row in db.execute("SELECT DISTINCT text FROM settings WHERE name = 'scene.name'")}
        expect(names == {"../models/wedge.gltf"}, f"the scene is named from the experiment's folder: {names}")
    # Seals: a damaged row would be refused.
    expect(noonmark("report", "joined").returncode == 0, "the joined store can be read")

# A merge of the same points twice is no contradiction, whatever the folder.
again = noonmark("merge", "again", *shares, share("bob", 1))
expect(again.returncode == 0 and "in more than one, and alike" in again.stdout, "points that two hosts have agree")

# What is missing is measured by the command as it is typed on the first share's host.
part = noonmark("merge", "part", shares[0])
command = f"noonmark run {work}/ann/project/sets/x.toml --shard 2/2 --out {work}/ann/project/sets/out"
expect(part.returncode == 6 and command in part.stderr, "the command names the experiment on its host")

# Another scene under the same name is refused.
other = noonmark("merge", "other", shares[0], share("eve", 2))
expect(other.returncode == 2 and "the contents of the scene ../models/wedge.gltf" in other.stderr,
       "another scene is refused")
expect(not (work / "other/results.sqlite").exists(), "nothing is joined")

sys.exit(1 if failures else 0)
