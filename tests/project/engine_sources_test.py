"""scripts/engine-sources tells lines that are the same, that moved, and that changed, in repositories made here.
   engine_sources_test.py SOURCE FOLDER
Skips (77) without git."""
import pathlib
import re
import shutil
import subprocess
import sys

source, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
if not shutil.which("git"):
    print("git is not installed")
    sys.exit(77)
shutil.rmtree(folder, ignore_errors=True)
repository = folder / "clones/engine"
repository.mkdir(parents=True)
(folder / "clones/empty").mkdir()


def git(*arguments):
    return subprocess.run(["git", "-C", str(repository), "-c", "user.name=a", "-c", "user.email=a@b.c", *arguments], check=True, capture_output=True, text=True).stdout


def commit(text):
    (repository / "shadow.glsl").write_text(text)
    git("add", "-A")
    git("commit", "-qm", "shadows")


def run(*rows):
    page = folder / "page.md"
    page.write_text("# Page\n| engine | repository | commit or release | line | text |\n|---|---|---|---|---|\n" + "".join(f"| E | {row} |\n" for row in rows))
    ran = subprocess.run([source / "scripts/engine-sources", folder / "clones", page], capture_output=True, text=True)
    return ran.returncode, ran.stdout


git("init", "-q")
commit("first\nz += bias / range;\nn = 0.5;\n")
git("tag", "v1")
commit("first\nsecond\nz  +=bias;\nn = 0.5;\n")
bad = False
for rows, code, said in [
        (["o/engine | v1 | shadow.glsl:3 | `n=0.5;`"], 0, r"same .*at v1 as stated; newest: in line 4"),
        (["o/engine | v1 | shadow.glsl | `n = 0.5;`"], 0, r"same .*at v1 in line 3"),
        (["o/engine | v1 | shadow.glsl:2 | `z += bias / range;`"], 1, r"CHANGED .*at v1 as stated; newest: the text is not there"),
        (["o/engine | v1 | shadow.glsl:2 | `z += bias;`"], 1, r"CHANGED .*at v1 the text is not there; newest: in line 3"),
        (["o/engine | v2 | shadow.glsl:2 | `n = 0.5;`"], 1, r"CHANGED .*at v2 no such commit here"),
        (["o/engine | v1 | light.glsl:2 | `n = 0.5;`"], 1, r"CHANGED .*at v1 no such file; newest: no such file"),
        (["o/empty | v1 | shadow.glsl:3 | `n = 0.5;`", "o/engine | v1 | shadow.glsl:3 | `n=0.5;`"], 2, r"o/empty cannot be read")]:
    found = run(*rows)
    if found[0] != code or not re.search(said, found[1]):
        bad = True
        print(f"{rows}: {found}, not {code}, {said}")
# It reads every row of the page that the program's rows are written in.
page = (source / "docs/reference/engine-sources.md").read_text()
rows = page.split("| engine | repository | commit or release | line | text |\n")[1].split("\n\n")[0].splitlines()[1:]
for name in {row.split("|")[2].strip().split("/")[1] for row in rows}:
    (folder / "none" / name).mkdir(parents=True)
ran = subprocess.run([source / "scripts/engine-sources", folder / "none"], capture_output=True, text=True)
if ran.stdout.count("cannot be read") != len(rows) or ran.returncode != 2:
    bad = True
    print(f"of {len(rows)} rows: {ran.returncode} {ran.stdout}")
sys.exit(bad)
