"""Runs the commands of README, the how-tos, the tutorial and the reference of frames as they stand there, in their order.
   commands_test.py NOONMARK SOURCE WORK [PAGE...]      a page: docs/how-to/ci.md; none: all
A command stands in a block `sh`, after `$ ` in a block `text`, or as `noonmark VERB ...` in a line. Each page has a folder of its
own, with the files that its readers have: a model under each name that the page gives one, and the page's own experiment. There
`noonmark` is the program with small pictures, so that no command takes long. NOT_RUN names what is not run, with the reason. Of an
option that stands alone (`--answer best`) some verb must know the name."""
import base64
import json
import os
import pathlib
import re
import shlex
import shutil
import struct
import subprocess
import sys

program, source, work = (pathlib.Path(word).absolute() for word in sys.argv[1:4])

# The verbs whose pictures are made small.
SMALL = "render|run|check|recommend|map|section"
# By the beginning of the command. The reason stands behind it.
NOT_RUN = {
    "git clone": "install.readme does",
    "scripts/demo": "install.readme does",
    "cmake --install": "install.readme does",
    "export PATH": "install.readme does",
    "noonmark doctor": "install.readme does; it fails where the machine cannot measure",
    "scripts/test": "it runs this test",
    "scripts/docs": "documents.site does",
    "cmake --preset": "it builds",
    "cmake --build": "it builds",
    "build/release": "a benchmark, which takes minutes",
    "NOONMARK_TEST_PLACEMENTS=": "a test that takes minutes",
    "scripts/speed": "it takes ten minutes",
    "scripts/compare-cycles": "it needs Blender",
    "noonmark check experiments/atlas": "it takes minutes",
    "scripts/peak-memory": "it takes minutes",
    "apt install": "package.program installs the package",
    "sudo apt-get": "it installs",
    "podman": "it needs podman and the network",
    "cp -r": "engine_frames.are_judged has the adapters",
    "(cd ~/noonmark-engines": "it installs from the network",
    "export NODE_MODULES": "engine_frames.are_judged has the adapters",
    "noonmark recommend cube-room --engine": "engine_advice.works_typed_in tries the engines",
    "node shoot.mjs": "engine_frames.are_judged does, where node and Chromium are",
    "noonmark judge shots/": "engine_frames.are_judged has frames of an engine",
    "noonmark judge frame.json": "engine_frames.are_judged has frames of an engine",
    "noonmark judge FRAME.rdc": "picture.Capture does, with a reader of its own",
    "noonmark judge out/": "picture.Capture does, with a reader of its own",
    "noonmark capture": "picture.Capture does, with a reader of its own",
    "AFTER_S=": "it needs RenderDoc and a program to capture",
    "cc -shared": "it needs a header of RenderDoc's",
    "noonmark check frames.toml": "engine_frames.are_judged has frames of an engine",
    "examples/slurm/submit": "many_machines.slurm does, where Slurm is",
    "seq 8": "many_machines.parallel does, where GNU parallel is",
    "--sshlogin": "GNU parallel's option",
    "--against": "an option of scripts/speed",
    "...": "stands for the shares between",
    "cat ": "prints what the command before wrote",
    "noonmark render --set lookup.kind=<name>": "the reader's own lookup",
    "noonmark check shadows.toml --json --quiet | jq": "jq is no package that is set up",
}
# What a page's readers have. The first experiment of a page stands in the file that its commands name.
MODELS = {"README.md": ["MODEL.glb"], "docs/how-to/find-settings.md": ["helmet.glb", "models/helmet.gltf"], "docs/how-to/ci.md": ["models/street.glb"],
          "docs/how-to/live-page.md": ["helmet.glb"], "docs/how-to/other-engines.md": ["helmet.glb"], "docs/tutorial/own-model.md": ["FlightHelmet.gltf"]}
EXPERIMENTS = {"docs/how-to/ci.md": "shadows.toml", "docs/how-to/find-settings.md": "filters.toml", "docs/how-to/filtered-maps.md": "msm.toml"}
# Other files, made from what is there.
MADE = {"README.md": ["noonmark init MODEL.glb && mv MODEL.toml FILE.toml"],
        "docs/how-to/ci.md": ["mkdir checks && cp shadows.toml checks && sed -i 's:models:../models:' checks/shadows.toml"],
        "docs/how-to/find-settings.md": ["noonmark init helmet.glb"],
        "docs/how-to/live-page.md": ["cp experiments/cube-room.toml experiment.toml"],
        "docs/how-to/many-machines.md": ["cp experiments/cube-room.toml shadows.toml",
                                         "for i in `seq 2 8`; do noonmark run shadows.toml --shard $i/8 || exit; done"],
        "docs/how-to/other-engines.md": ["noonmark init helmet.glb"],
        # A picture is read by its content, whatever its name: NPY of 96 x 54 floats, all lit.
        "docs/reference/frame.md": ["""{ printf '\\x93NUMPY\\x01\\x00v\\x00%-117s\\n' "{'descr': '<f4', 'fortran_order': False, 'shape': (54, 96), }"
                                    for i in `seq 5184`; do printf '\\x00\\x00\\x80\\x3f'; done; } > engine.exr"""]}
wrong, used = [], set()


def commands_of(text):
    """The commands of a page in its order, with the options that stand alone among them."""
    for block in re.finditer(r"^ *```([\w-]*)\n(.*?)^ *```|`((?:noonmark(?=[\s`])|--)[^`]*)`", text, re.S | re.M):
        language, lines, inline = block.groups()
        if inline:
            yield " ".join(inline.split())
        elif language == "sh":
            yield from filter(None, (re.sub(r"\s#.*", "", line).strip() for line in lines.replace("\\\n", " ").splitlines()))
        elif language == "text":
            yield from (line[2:] for line in lines.splitlines() if line.startswith("$ "))


def run(command, folder, environment):
    """The exit code of a command, and the end of what it printed."""
    ran = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True)
    return ran.returncode, ran.stdout.strip()[-600:]


def not_run(command):
    begin = next((begin for begin in NOT_RUN if command.startswith(begin)), None)
    used.add(begin)
    return begin


def as_text(gltf):
    """Writes the GLB of this name as glTF. A GLB is a head of 12 bytes, and chunks: length, kind, content."""
    glb = gltf.with_suffix(".glb").read_bytes()
    length = struct.unpack_from("<I", glb, 12)[0]
    model = json.loads(glb[20:20 + length])
    model["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(glb[28 + length:]).decode()
    gltf.write_text(json.dumps(model))


def folder_of(page, text):
    folder = work / page.replace("/", "-")
    (folder / "bin").mkdir(parents=True)
    small = folder / "bin/noonmark"
    small.write_text(f"""#!/bin/sh
case $1 in {SMALL}) exec {shlex.quote(str(program))} "$@" --set view.width_px=96 --set view.height_px=54 ;; esac
exec {shlex.quote(str(program))} "$@"
""")
    small.chmod(0o755)
    for name in ("experiments", "examples"):
        (folder / name).symlink_to(source / name)
    environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "HOME": str(folder)}
    make = []
    for model in MODELS.get(page, []):
        (folder / model).parent.mkdir(exist_ok=True)
        make.append(f"noonmark export cube-room --out {pathlib.Path(model).with_suffix('.glb')}")
    if page in EXPERIMENTS:
        (folder / EXPERIMENTS[page]).write_text(re.search(r"^ *```toml\n(.*?)^ *```", text, re.S | re.M)[1])
    for command in make + MADE.get(page, []):
        code, said = run(command, folder, environment)
        if code:
            sys.exit(f"{page}: $ {command}\n  ended with {code}: {said}")
    for model in MODELS.get(page, []):
        if model.endswith(".gltf"):
            as_text(folder / model)
    return folder, environment


def main():
    shutil.rmtree(work, ignore_errors=True)
    verbs = re.findall(r"^  ([a-z]+)  ", subprocess.run([program, "--help"], capture_output=True, text=True).stdout, re.M)
    helps = "".join(subprocess.run([program, verb, "--help"], capture_output=True, text=True).stdout for verb in verbs)
    known = set(re.findall(r"--[a-z][\w-]*", helps))
    pages = [source / "README.md", *sorted((source / "docs/how-to").glob("*.md")), source / "docs/tutorial/own-model.md",
             source / "docs/reference/frame.md"]
    if chosen := sys.argv[4:]:
        pages = [source / page for page in chosen]
    ran = 0
    for path in pages:
        page = path.relative_to(source).as_posix()
        text = path.read_text(encoding="utf-8")
        folder, environment = folder_of(page, text)
        for command in commands_of(text):
            words = command.split()
            if not_run(command):
                continue
            if command.startswith("--"):
                wrong.extend(f"{page}: no verb has the option {word}" for word in words if word.startswith("--") and word not in known)
            elif words[0] == "noonmark" and len(words) <= 2 and "…" not in command:
                if len(words) == 2 and words[1] not in verbs:
                    wrong.append(f"{page}: there is no verb {words[1]}")
            elif "…" not in command:
                ran += 1
                # A bound may be broken in a small picture, and the tutorial breaks one.
                code, said = run(command, folder, environment)
                if code != 0 and not (code == 1 and words[1] == "check"):
                    wrong.append(f"{page}: $ {command}\n  ended with {code}: {said}")
    unused = NOT_RUN.keys() - used
    if unused and not chosen:
        wrong.append(f"NOT_RUN names what no page has: {sorted(unused)}")
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{ran} commands of {len(pages)} pages ran")


main()
