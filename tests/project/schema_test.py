"""The schema of the experiment file (noonmark schema) takes what the program takes, and refuses mistakes.

Arguments: the program, the source folder. Exit code 77: something that the test needs is missing.
"""
import copy
import json
import subprocess
import sys
from pathlib import Path

try:
    import tomllib

    import jsonschema
except ImportError as missing:
    print(f"SKIPPED: {missing} (python3 3.11, python3-jsonschema)")
    sys.exit(77)

program, source = sys.argv[1], Path(sys.argv[2])
schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True, text=True).stdout)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
failures = 0


def expect(holds, what):
    global failures
    if not holds:
        failures += 1
        print(f"FAILED: {what}")


def mistake(document):
    """The first mistake; None if there is none."""
    return next((f"{'/'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in validator.iter_errors(document)), None)


experiments = sorted([*source.glob("experiments/**/*.toml"), *(f for f in source.glob("examples/**/*.toml") if f.name != "programs.toml")])  # the museum's own list
expect(len(experiments) >= 5, f"there are experiments: {experiments}")
for file in experiments:
    found = mistake(tomllib.loads(file.read_text()))
    expect(found is None, f"{file}: {found}")

# The examples of the documents that the program takes.
for document in [*sorted((source / "docs").rglob("*.md")), *sorted((source / "examples").rglob("*.md"))]:
    for block in document.read_text().split("\n```toml")[1:]:
        head, _, rest = block.partition("\n")
        text = rest.split("\n```")[0]
        try:
            found = mistake(tomllib.loads(text))
        except tomllib.TOMLDecodeError as error:
            found = str(error)
        if head == "":
            expect(found is None, f"{document}: {found}\n{text}")

# A printed configuration has every setting, so every setting is in the schema.
for file in experiments:
    printed = subprocess.run([program, "run", str(file), "--print-config"], capture_output=True, text=True)
    expect(printed.returncode == 0, printed.stderr)
    found = mistake(tomllib.loads(printed.stdout))
    expect(found is None, f"{file} --print-config: {found}")

whole = tomllib.loads("""
title = "x"
scene = "plane"
[map]
resolution = 512
[sweep]
filter.kind = ["none", "box"]
"map.format" = [16, "32f"]
bias.constant = {min = 0, max = 1, steps = 3}
[[bound]]
metric = "acne"
max = 1
where = {"filter.kind" = "box"}
[[law]]
name = "x"
measured = "acne"
equals = 0
""")
expect(mistake(whole) is None, f"the example: {mistake(whole)}")
broken = {
    "an unknown key": lambda d: d.update(titel="x"),
    "an unknown setting": lambda d: d["map"].update(resolutoin=512),
    "an unknown group": lambda d: d.update(maps={}),
    "a value out of range": lambda d: d["map"].update(resolution=99999),
    "a number in quotes": lambda d: d["map"].update(resolution="512"),
    "a fraction for an integer": lambda d: d["map"].update(resolution=1.5),
    "auto without an automatic value": lambda d: d["map"].update(resolution="auto"),
    "no such choice": lambda d: d["map"].update(format="32"),
    "a flag that is a word": lambda d: d["map"].update(snap="true"),
    "a point of two numbers": lambda d: d.update(view={"eye_m": [1, 2]}),
    "no such scene": lambda d: d.update(scene="cube-rom"),
    "an empty list": lambda d: d["sweep"]["filter"].update(kind=[]),
    "a value twice": lambda d: d["sweep"]["filter"].update(kind=["box", "box"]),
    "a sweep of one value": lambda d: d["sweep"]["filter"].update(kind="box"),
    "a range of a choice": lambda d: d["sweep"]["filter"].update(kind={"min": 0, "max": 1, "steps": 2}),
    "a range without steps": lambda d: d["sweep"]["bias"]["constant"].pop("steps"),
    "a swept setting that is unknown": lambda d: d["sweep"].update({"map.resolutoin": [1, 2]}),
    "a bound without a limit": lambda d: d["bound"][0].pop("max"),
    "a bound without a metric": lambda d: d["bound"][0].pop("metric"),
    "a metric that is unknown": lambda d: d["bound"][0].update(metric="acn"),
    "a level that is unknown": lambda d: d["bound"][0].update(level="info"),
    "a condition that is unknown": lambda d: d["bound"][0].update(where={"filter.kin": "box"}),
    "one bound that is no list": lambda d: d.update(bound={"metric": "acne", "max": 1}),
    "a law with two relations": lambda d: d["law"][0].update(at_most=1),
    "a law without a relation": lambda d: d["law"][0].pop("equals"),
    "a cost that is no metric": lambda d: d.update(answer={"cost": "window_min_m"}),
    "a bound of the curve above 1": lambda d: d.update(curve={"acne_bound": 1.5}),
    "too many texel sizes": lambda d: d.update(phase={"texel_sizes": 1000}),
    "a sweep beside parts": lambda d: d.update(part=[{"name": "a"}]),
    "a part without a name": lambda d: [d.pop(k) for k in ("sweep", "bound", "law")] and d.update(part=[{}]),
    "a title inside a part": lambda d: [d.pop(k) for k in ("sweep", "bound", "law")] and d.update(part=[{"name": "a", "title": "x"}]),
}
for what, damage in broken.items():
    document = copy.deepcopy(whole)
    damage(document)
    expect(mistake(document) is not None, f"the schema takes {what}")
sys.exit(1 if failures else 0)
