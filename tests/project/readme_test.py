"""Installs Noonmark as README says: in a fresh clone, in README's order, each command of its blocks `sh` as it stands.
   readme_test.py SOURCE BUILD WORK
BUILD is where this source is built; the clone takes its preset, and finds in ccache what it compiled. Exit code 77: no ccache or git
here, a preset whose objects ccache does not share between clones, or a machine that cannot measure."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

source, build, work = (pathlib.Path(word).absolute() for word in sys.argv[1:4])


def skip(why):
    print("SKIPPED:", why)
    sys.exit(77)


def run(command, where, **environment):
    ran = subprocess.run(["bash", "-c", command], cwd=where, env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if ran.returncode:
        sys.exit(f"$ {command}\nended with {ran.returncode}:\n{ran.stdout[-3000:]}")
    return ran.stdout


if not shutil.which("ccache") or not shutil.which("git") or not (source / ".git").exists():
    skip("this needs ccache, git and the repository")
if build.name not in ("release", "ci"):
    skip("ccache shares no objects with debug information between clones")
if subprocess.run([build / "app/noonmark", "doctor"], capture_output=True).returncode:
    skip("this machine cannot measure")

readme = (source / "README.md").read_text(encoding="utf-8")
blocks = list(re.finditer(r"^```sh\n(.*?)^```", readme, re.S | re.M))
installed = readme.index("\ncmake --install")
early = [use[0] for use in re.finditer(r"(`|^\$ )noonmark [^`\n]*", readme, re.M) if use.start() < installed]
if early:
    sys.exit(f"README uses the program before it says how to install it: {early}")

# The repository is that of the working tree, so that changes are tested before they are committed.
shutil.rmtree(work, ignore_errors=True)
home, origin = work / "home", work / "origin"
home.mkdir(parents=True)
files = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=source,
                       check=True, capture_output=True, text=True).stdout.split("\0")
for file in filter(None, files):
    if (source / file).is_file():
        (origin / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source / file, origin / file)
run("git init -q . && git add -A && git -c user.name=test -c user.email=test@example.org commit -qm test", origin)

cache = run("ccache --get-config cache_dir", work).strip()
commands = "".join(block[1] for block in blocks)
if build.name != "release":  # README's preset
    clone, rest = commands.split("\n", 1)
    commands = f"{clone}\nmkdir build && ln -s {build.name} build/release\n{rest}"
run("set -ex\n" + commands, work, REPOSITORY=str(origin), HOME=str(home), CCACHE_DIR=cache, NOONMARK_SETUP="skip", NOONMARK_PRESET=build.name)
for file in ("bin/noonmark", "share/man/man1/noonmark.1", "include/noonmark.h"):
    if not (home / ".local" / file).is_file():
        sys.exit(f"{file} is not installed")
shutil.rmtree(work)
print(commands, end="")
