"""The adapters of examples/engines refuse a setting that they do not know, and the README lists those that they know.
   engine_settings_test.py SOURCE FOLDER
It needs no engine: a setting is refused before one starts. The pages' part needs node, without which it is left out and named."""
import json
import pathlib
import re
import shutil
import subprocess
import sys

source, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
engines = source / "examples/engines"
PAGES = ["three/page.html", "babylon/page.html", "playcanvas/page.html", "filament/page.html", "eevee/shoot.py"]
bad = []


def expect(true, what):
    if not true:
        bad.append(what)
        print(what)


def rows(path):
    return json.loads((engines / path / "settings.json").read_text())


def number(x):
    return f"{x:.10f}".rstrip("0").rstrip(".")


def cell(name, row):
    """A setting as the README shows it, with its choices or its default."""
    values = [f"`{choice}`" for choice in row["choices"]] if "choices" in row else [number(x) for x in row["default"]] if isinstance(row.get("default"), list) \
        else [number(row["default"])] if "default" in row else []
    return f"`{name}`" + (f" ({', '.join(values)})" if values else "")


readme = (engines / "README.md").read_text()
shared = rows(".")
expect(", ".join(cell(*one) for one in shared.items()) in readme, "the README does not say: " + ", ".join(cell(*one) for one in shared.items()))
for page in PAGES:
    own = rows(pathlib.Path(page).parent)
    cells = ", ".join(cell(*one) for one in own.items())
    expect(any(line.startswith(f"| `{page}` |") and line.endswith(f"| {cells} |") for line in readme.splitlines()),
           f"the README's row of {page} does not end with: | {cells} |")
    code = (engines / page).read_text() + ("" if page.endswith("py") else (engines / "page.mjs").read_text())
    read = set(re.findall(r"\bsettings\.(?!mjs)(\w+)" if page.endswith("html") else r'\bsettings\["(\w+)"\]', code)) | {"width", "height"}
    expect(read == set(shared) | set(own), f"{page} reads {sorted(read)}; settings.json declares {sorted(set(shared) | set(own))}")

shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
model, out = folder / "model.glb", folder / "out"
model.write_bytes(b"")  # nothing reads it
# What is wrong, of which engine (None: of all), and what is said.
WRONG = [(None, ["biass=0.1"], 'there is no setting "biass"'),
         (None, ["bias=much"], '"bias" takes a number'),
         (None, ["bias="], '"bias" takes a number'),
         (None, ["bias"], "is no name=value"),
         (None, ["eye=1,2"], '"eye" takes 3 numbers with commas'),
         (None, ["width=0"], '"width" takes a whole number above 0'),
         (None, ["width=1.5"], '"width" takes a whole number above 0'),
         (None, ["bias=1", "bias=2"], '"bias" is given twice'),
         ("three", ["type=Nope"], '"type" takes PCFShadowMap | BasicShadowMap | VSMShadowMap'),
         ("babylon", ["filter=foo"], '"filter" takes none | usePercentageCloserFiltering'),
         ("three", ["lines=none.txt"], '"lines" takes the path of a file'),
         ("babylon", [f"lines={__file__}", "resolution=512"], '"resolution" and "lines" are given, and the lines set the map'),
         ("three", ["cascades=4"], '"cascades" has no effect with class=DirectionalLight; it needs class=CSM'),
         ("three", ["class=CSM", "extent=5"], '"extent" has no effect with class=CSM'),
         ("three", ["class=SunLight", "splits=5,20"], '"splits" has no effect with class=SunLight'),
         ("three", ["class=CSM", "splits=5,"], '"splits" takes numbers with commas above 0'),
         ("three", ["blurSamples=7"], '"blurSamples" has no effect with type=PCFShadowMap; it needs type=VSMShadowMap'),
         ("babylon", ["depthScale=20"], '"depthScale" has no effect with filter=none'),
         ("babylon", ["filter=useBlurExponentialShadowMap", "blurKernel=9"], '"blurKernel" has no effect with useKernelBlur=false'),
         ("babylon", ["lambda=0.5"], '"lambda" has no effect with class=ShadowGenerator'),
         ("eevee", ["high_bitdepth=yes"], '"high_bitdepth" takes true | false')]
for page in PAGES:
    if page.endswith("html") and not shutil.which("node"):
        print(f"not run: {page}, which needs node")
        continue
    start = ["node", engines / "shoot.mjs", page] if page.endswith("html") else [sys.executable, engines / page, "--"]
    for engine, wrong, message in WRONG:
        if engine and not page.startswith(engine + "/"):
            continue
        ran = subprocess.run([*start, model, out, *wrong], capture_output=True, text=True)
        listed = re.findall(r"^  (\w+)=", ran.stderr, re.M)
        expect(ran.returncode == 2 and message in ran.stderr, f"{page} {wrong}: exit code {ran.returncode}, {ran.stderr}")
        expect(listed == [*shared, *rows(pathlib.Path(page).parent)], f"{page} {wrong} lists {listed}")
        expect(not out.exists(), f"{page} {wrong} wrote {out}")
    ran = subprocess.run([*start, folder / "none.glb", out], capture_output=True, text=True)
    expect(ran.returncode == 2 and "There is no model" in ran.stderr and not out.exists(), f"{page}: a missing model is {ran.returncode}, {ran.stderr}")
sys.exit(bool(bad))
