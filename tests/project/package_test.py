"""Tests the Debian package that cpack makes of the build.

Arguments: the step, the build folder, the source folder, the built program, an empty folder to work in. Steps:
  made          cpack makes the package, which is unpacked into an empty root; the other steps need it
  contents      its files, its fields, and whose licences its copyright file states
  dependencies  its dependencies cover the libraries that it is linked with, and those that it opens at run time
  program       from its root the program runs the demo's experiment, and bash completes its command line
  lintian       lintian finds nothing that cmake/package/lintian-overrides gives no reason for
The libraries are those of this system; scripts/test-package installs the package into a system of its own. Exit code 77:
something that the test needs is missing.
"""
import gzip
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

step = sys.argv[1]
build, source, built_program, work = (Path(argument).resolve() for argument in sys.argv[2:6])
root = work / "root"
failures = 0


def expect(holds, what):
    global failures
    if not holds:
        failures += 1
        print(f"FAILED: {what}")


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(77)


def call(*command, **more):
    return subprocess.run(command, capture_output=True, text=True, **more)


def output(*command, **more):
    done = call(*command, **more)
    if done.returncode != 0:
        sys.exit(f"{command} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


missing = [tool for tool in ("cpack", "dpkg-deb", "dpkg-query", "dpkg-shlibdeps", "file", "readelf") if not shutil.which(tool)]
if missing:
    skip(f"not installed: {', '.join(missing)}; on Debian, apt install dpkg-dev file")


def packages():
    found = list(work.glob("*.deb"))
    if len(found) != 1:
        sys.exit(f"cpack makes one package, but there are {found}")
    return found


def depends():
    """The packages that the package names as needed. Of alternatives, all."""
    text = output("dpkg-deb", "-f", packages()[0], "Depends")
    return {re.match(r"[a-z0-9.+-]+", name.strip())[0] for name in re.split("[,|]", text) if name.strip()}


def made():
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    print(output("cpack", "--config", build / "CPackConfig.cmake", "-G", "DEB", "-B", work))
    shutil.rmtree(work / "_CPack_Packages")
    output("dpkg-deb", "-x", packages()[0], root)


def contents():
    version, architecture = output(built_program, "--version").split()[0], output("dpkg", "--print-architecture").strip()
    name = f"noonmark_{version}-1_{architecture}.deb"
    expect(packages()[0].name == name, f"the package is named {name}")
    # The workflows of examples/ci install the package by this pattern.
    expect(packages()[0].match("noonmark_*.deb"), "examples/ci finds the package")
    fields = dict(line.split(": ", 1) for line in output("dpkg-deb", "-f", packages()[0]).splitlines()
                  if line[:1].strip())
    for field, value in (("Package", "noonmark"), ("Section", "graphics"), ("Priority", "optional"),
                         ("Architecture", architecture), ("Version", f"{version}-1")):
        expect(fields.get(field) == value, f"{field} is {value}, not {fields.get(field)}")
    expect(re.fullmatch(r"\S.* <\S+@\S+>", fields["Maintainer"]), f"the maintainer has an address: {fields['Maintainer']}")

    files = {str(path.relative_to(root)): path for path in root.rglob("*") if not path.is_dir()}
    examples, adapters, reader = "usr/share/doc/noonmark/examples/", "usr/share/noonmark/engines/", "usr/share/noonmark/captures/"
    # All but the examples, the engines' adapters and the reader of captures, so that no header, archive or file of the build comes in unseen.
    modules = [name for name in files if name.endswith("/noonmark/noonmark_images.so") and name.startswith("usr/lib/")]
    wanted = {"usr/bin/noonmark", "usr/share/man/man1/noonmark.1.gz", "usr/share/bash-completion/completions/noonmark",
              "usr/share/lintian/overrides/noonmark",
              *("usr/share/doc/noonmark/" + name for name in ("copyright", "changelog.gz", "changelog.Debian.gz")), *modules}
    others = {name for name in files if not name.startswith((examples, adapters, reader))}
    expect(len(modules) == 1 and others == wanted, f"missing: {wanted - others}; too many: {others - wanted}")
    for folder, installed, what in (("experiments", examples, "experiments"), ("examples/engines", adapters, "adapters"),
                                    ("captures", reader, "files of the reader")):
        in_source = {str(path.relative_to(source / folder)) for path in (source / folder).rglob("*")
                     if path.is_file() and not {"node_modules", "__pycache__"} & set(path.parts) and path.name != "package-lock.json"}
        expect({name.removeprefix(installed) for name in files if name.startswith(installed)} == in_source, f"all {what} are there")
    if failures:
        return
    for path in root.rglob("*"):
        mode = path.stat().st_mode & 0o777
        expect(mode == (0o755 if path.is_dir() or path.parent.name == "bin" else 0o644), f"{path} has the mode {mode:o}")

    # What is stripped is smaller; the build id is the program's identity for its results.
    build_id = re.search("Build ID: (.*)", output("readelf", "-n", files["usr/bin/noonmark"]))
    expect(build_id and build_id[1] in output("readelf", "-n", built_program), "the build id is that of the build")
    for binary in ("usr/bin/noonmark", modules[0]):
        expect(".symtab" not in output("readelf", "-SW", files[binary]), f"{binary} is stripped")

    texts = {name: gzip.open(files[name], "rt").read() for name in files if name.endswith(".gz")}
    page = texts["usr/share/man/man1/noonmark.1.gz"]
    expect(page == (built_program.parent / "noonmark.1").read_text(), "the man page is that of the build")
    expect(texts["usr/share/doc/noonmark/changelog.gz"] == (source / "CHANGELOG.md").read_text(), "the changelog is ours")
    parsed = output("dpkg-parsechangelog", "-l", "-", "-S", "Version", input=texts["usr/share/doc/noonmark/changelog.Debian.gz"])
    expect(parsed.strip() == f"{version}-1", "Debian's changelog has the version")

    # A library that the package does not depend on is compiled in, and its licence asks to be stated.
    copyright_text = files["usr/share/doc/noonmark/copyright"].read_text()
    needed = depends()
    for library in re.search("# libraries\n(.*?)\n\n", (source / "scripts/packages.txt").read_text(), re.S)[1].splitlines():
        library = library.split()[0]
        listed = call("dpkg-query", "-L", library)
        if listed.returncode != 0:
            continue
        shared = {str(Path(path).resolve()) for path in listed.stdout.split() if path.endswith(".so")}
        owners = set(owners_of(shared).values())
        upstream = re.search("Upstream-Name: *(.*)", (Path("/usr/share/doc") / library / "copyright").read_text())
        upstream = upstream[1] if upstream else library.removeprefix("lib").removesuffix("-dev")
        expect(owners & needed or upstream.lower() in copyright_text.lower(),
               f"{library} is compiled in, and the copyright file does not name {upstream}")


def owners_of(paths):
    """The package of each file, by its path. /lib is a link to /usr/lib, and a file is known by either name."""
    names = {}  # what the file may be called: the path that was asked for
    for path in paths:
        for name in {str(path), str(Path(path).resolve())}:
            names |= {name: path, name.removeprefix("/usr"): path, "/usr" + name: path}
    # It fails if it does not know one of the names; what it says of the others counts.
    said = call("dpkg-query", "-S", *names).stdout
    return {names[name]: package for package, name in re.findall(r"^([a-z0-9.+-]+)\S*: (/.*)$", said, re.M) if name in names}


def reached(names):
    """The packages that are installed with these: they, what they depend on, what that depends on."""
    needs, provided = installed()
    seen, todo = set(), set(names)
    while todo:
        name = todo.pop()
        if name in seen:
            continue
        seen.add(name)
        todo |= needs.get(name, set()) | provided.get(name, set())
    return seen


def installed():
    """Of the installed packages: what each needs, and which ones provide a name."""
    needs, provided = {}, {}
    for line in output("dpkg-query", "-W", "-f", "${Package}\t${Pre-Depends}, ${Depends}\t${Provides}\n").splitlines():
        package, needed, also = line.split("\t")
        needs.setdefault(package, set()).update(re.findall(r"(?:^|[,|])\s*([a-z0-9][a-z0-9.+-]+)", needed))
        for name in re.findall(r"(?:^|,)\s*([a-z0-9][a-z0-9.+-]+)", also):
            provided.setdefault(name, set()).add(package)
    return needs, provided


def dependencies():
    named = depends()
    program = root / "usr/bin/noonmark"
    # What it is linked with, named directly, or by a name that the library's package provides.
    libraries = set()
    for binary in (program, next(root.rglob("noonmark_images.so"))):
        # "libm.so.6 => /lib/...", and for the dynamic linker, whose place every program names itself, "/lib64/ld-linux..." alone.
        found = {Path(name).name: path or name for name, path in re.findall(r"(\S+)(?: => (/\S+))? \(0x", output("ldd", binary))}
        for library in re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-d", binary)):
            expect(library in found, f"{binary.name} needs {library}, which is not here")
            libraries |= {found[library]} if library in found else set()
    provided = installed()[1]
    directly = named.union(*(provided.get(name, set()) for name in named))
    for library, owner in sorted(owners_of(libraries).items()):
        expect(owner in directly, f"the package is linked with {library} of {owner}, and does not depend on it")

    # What drawing and reading a picture open: the loader tells of each library when it initialises it.
    def opened_by(*words):
        run = call(program, *words, env=dict(os.environ, LD_DEBUG="files"))
        return run, set(re.findall(r"calling init: (/\S+)", run.stderr))

    drawn, opened = opened_by("render", "--out", work / "opened", "--set", "scene.name=plate", "--set", "view.width_px=32",
                              "--set", "view.height_px=18")
    if drawn.returncode == 4:
        skip("this machine cannot draw, so what is opened at run time is not known")
    expect(drawn.returncode == 0 and len(opened) > 20, f"render ended with {drawn.returncode} after {len(opened)} libraries")
    # A picture of colours is refused, after it has been read.
    _, read = opened_by("judge", "plate", "--picture", work / "opened/point-classes.png", "--out", work / "judged")
    expect(any("noonmark_images" in name for name in read), "pictures are read by the package's own library")
    opened = sorted(opened | read)
    opened = [name for name in opened if not name.startswith(str(root))]
    covered, owners = reached(named), owners_of(opened)
    for library, owner in sorted(owners.items()):
        # libepoxy takes libOpenGL.so.0 where it is, and otherwise libGL.so.1.
        if "/libOpenGL.so" not in library:
            expect(owner in covered, f"the program opens {library} of {owner}, which no dependency brings in")
    print(len(opened), "libraries are opened, of no package:", sorted(set(opened) - set(owners)))  # a driver, say


def program():
    packaged = root / "usr/bin/noonmark"
    if call(packaged, "doctor").returncode == 4:
        skip(f"this machine cannot measure: {call(packaged, 'doctor').stdout}")
    # The demo's experiment with small pictures and an eighth of the resolutions. Some of its bounds break then.
    text = (root / "usr/share/doc/noonmark/examples/cube-room.toml").read_text()
    for whole, little in (("width_px = 960", "width_px = 96"), ("height_px = 540", "height_px = 54"), ("\nwidth_px = 320\n", "\nwidth_px = 32\n")):
        expect(whole in text, f"the demo says {whole}")
        text = text.replace(whole, little)
    text = re.sub(r"\b(512|1024|2048|4096)\b", lambda found: str(int(found[0]) // 8), text)
    folder = work / "demo"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "demo.toml").write_text(text)
    ran = call(packaged, "check", "demo.toml", "--out", "out", "--quiet", cwd=folder)
    expect(ran.returncode in (0, 1), f"the demo's experiment ends with {ran.returncode}: {ran.stdout}{ran.stderr}")
    expect((folder / "out/report.html").is_file() and list(folder.glob("out/images/**/*.png")), "there are a report and pictures")
    rows = (folder / "out/results.csv").read_text().splitlines()
    expect(len(rows) == 33, f"results.csv has 32 points: {len(rows) - 1}")
    completed = call("bash", source / "tests/project/completion_test.sh", packaged,
                     root / "usr/share/bash-completion/completions/noonmark", work / "completion")
    expect(completed.returncode == 0, f"bash completes: {completed.stdout}{completed.stderr}")


def lintian():
    if not shutil.which("lintian"):
        skip("lintian is not installed; on Debian, apt install lintian")
    done = call("lintian", "--allow-root", "--fail-on", "error,warning", packages()[0])
    expect(done.returncode == 0, f"lintian finds\n{done.stdout}{done.stderr}")
    overridden = output("lintian", "--allow-root", "--show-overrides", packages()[0])
    used = set(re.findall(r"^O: noonmark: (\S+)", overridden, re.M))
    stated = set(re.findall(r"^noonmark: (\S+)", (source / "cmake/package/lintian-overrides").read_text(), re.M))
    expect(used == stated, f"overrides that nothing needs: {stated - used}")


{"made": made, "contents": contents, "dependencies": dependencies, "program": program, "lintian": lintian}[step]()
sys.exit(1 if failures else 0)
