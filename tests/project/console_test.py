"""Runs the commands of a page's console blocks again and compares what they print with the lines that stand below them.
   console_test.py NOONMARK SOURCE FOLDER PAGE
The commands run in FOLDER, which has the source's experiments and examples; `noonmark` is the program. A line of a block has to
stand in the output of the command above it, word for word; its numbers may differ by TOLERANCE. Blocks with `node` are
skipped where node or Chromium is missing, and the test says so; 77 if nothing could run."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

program, source, folder, page = (pathlib.Path(word).absolute() for word in sys.argv[1:5])
# Drivers and instruction sets differ in single pixels of the picture: 0.0006 % each, here a handful. Other numbers are given
# with up to six digits; 2 % is far less than what any sentence of the pages says.
TOLERANCE, PERCENT_POINTS = 0.02, 0.004
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def same(pasted, printed):
    """Whether two lines say the same."""
    spaces = lambda line: re.sub(r"\s+", " ", line.strip())
    pasted, printed = spaces(pasted), spaces(printed)
    if NUMBER.split(pasted) != NUMBER.split(printed):
        return False
    pairs = zip(NUMBER.findall(pasted), NUMBER.findall(printed))
    return all(abs(float(a) - float(b)) <= max(TOLERANCE * abs(float(a)), PERCENT_POINTS if "%" in pasted else 0) for a, b in pairs)


def blocks_of(text):
    """Each block as a list of (command, lines below it)."""
    for block in re.findall(r"^```console\n(.*?)^```", text, re.S | re.M):
        steps = []
        for line in block.splitlines():
            if line.startswith("$ "):
                steps.append((line[2:], []))
            elif steps:
                steps[-1][1].append(line)
            else:
                sys.exit(f"{page}: a console block begins without a command: {line}")
        yield steps


def main():
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "bin").mkdir(parents=True)
    (folder / "bin/noonmark").symlink_to(program)
    for name in ("experiments", "examples"):
        (folder / name).symlink_to(source / name)
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    browser = shutil.which("node") and shutil.which(os.environ.get("CHROMIUM", "chromium"))
    wrong, ran, left_out = [], 0, 0
    for steps in blocks_of(page.read_text(encoding="utf-8")):
        if not browser and any(command.startswith("node ") for command, _ in steps):
            left_out += 1
            continue
        for command, pasted in steps:
            run = subprocess.run(command, shell=True, cwd=folder, env=environment, capture_output=True, text=True)
            ran += 1
            printed = (run.stdout + run.stderr).splitlines()
            if not pasted and run.returncode != 0:
                wrong.append(f"$ {command}\n  ended with {run.returncode}: {run.stderr.strip()}")
            for line in pasted:
                if not any(same(line, other) for other in printed):
                    first = line.split()[0]
                    now = [other for other in printed if other.split()[:1] == [first]]
                    wrong.append(f"$ {command}\n  pasted: {line.strip()}\n  now:    {(now or printed or ['nothing'])[0].strip()}")
    if left_out:
        print(f"not run: {left_out} blocks, which need node and Chromium")
    if wrong:
        sys.exit(f"{page}:\n" + "\n".join(wrong))
    if ran == 0:
        sys.exit(77 if left_out else f"{page} has no console block")
    print(f"{ran} commands print what {page.name} says")


main()
