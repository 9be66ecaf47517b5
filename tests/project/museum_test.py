"""Each program of examples/museum/programs.toml can be started, and has its row in docs/museum/index.md; and scripts/museum
says what is missing instead of starting a program that is not there.

Argument: the source folder. Exit code 77: python3 is older than 3.11."""
import re
import subprocess
import sys
from pathlib import Path

try:
    import tomllib
except ImportError as missing:
    print(f"SKIPPED: {missing}")
    sys.exit(77)

source = Path(sys.argv[1])
museum, page = source / "examples/museum", (source / "docs/museum/index.md").read_text()
programs = tomllib.loads((museum / "programs.toml").read_text())
known = {"packages", "command", "page", "before", "environment", "seconds", "patience", "judge"}
failures = []
for name, entry in programs.items():
    if unknown := set(entry) - known:
        failures.append(f"{name}: scripts/museum does not read {unknown}")
    if ("command" in entry) == ("page" in entry) or not entry["packages"] or not entry["seconds"] > 0:
        failures.append(f"{name}: needs packages, seconds, and a command or a page")
    words = entry.get("command", []) + sum(entry.get("before", []), []) + ["{here}/" + entry.get("page", "").split("?")[0]]
    for word in words:
        if word.startswith("{here}/") and not (museum / word.removeprefix("{here}/")).exists():
            failures.append(f"{name}: there is no {word}")
    if f"`{name}`" not in page:
        failures.append(f"docs/museum/index.md lacks `{name}`")
for name in re.findall(r"^\| `([a-z][\w-]*)`", page, re.M):
    if name not in programs:
        failures.append(f"docs/museum/index.md names `{name}`, which scripts/museum does not have")

script = source / "scripts/museum"
listed = subprocess.run([sys.executable, script, "--list"], capture_output=True, text=True)
if listed.returncode or [line.split()[0] for line in listed.stdout.splitlines()] != list(programs):
    failures.append(f"scripts/museum --list: {listed.stdout}{listed.stderr}")
nowhere = subprocess.run([sys.executable, script, "three"], capture_output=True, text=True, env={"PATH": "/usr/bin:/bin", "NODE_MODULES": "/nowhere"})
if nowhere.returncode != 4 or "npm:three" not in nowhere.stderr:
    failures.append(f"scripts/museum three without its package: {nowhere.returncode} {nowhere.stderr}")
print("\n".join(failures) or f"{len(programs)} programs")
sys.exit(bool(failures))
