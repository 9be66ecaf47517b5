"""What recommend --engine starts ends on every way out, its answer is written first, and its browser gets nothing but what it may.
   engine_trial_test.py NOONMARK SOURCE FOLDER
The program runs with a node that never ends, the adapter (examples/engines/shoot.mjs) with browsers that only speak its protocol. What
needs node, or Chromium and three.js (NODE_MODULES), is left out where they are missing, and named."""
import http.server
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

program, source, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
shoot = source / "examples/engines/shoot.mjs"
modules = pathlib.Path(os.environ.get("NODE_MODULES", source / "examples/engines/node_modules"))
temporary = pathlib.Path(tempfile.mkdtemp(prefix="noonmark-trial-"))  # short, because sockets lie in it; every process of a trial names it
bad = []


def expect(true, what):
    if not true:
        bad.append(what)
        print(what)


def write(path, text, mode=0o644):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(mode)
    return path


def left():
    """Processes of a trial that run: those that have the folder in their environment or in their command."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            named = (process / "environ").read_bytes() + (process / "cmdline").read_bytes()
            state = (process / "stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            continue
        if int(process.name) != os.getpid() and state not in "ZX" and str(temporary).encode() in named:
            found.append(named.split(b"\0")[-2:] + [process.name])
    return found


def expect_none_left(what):
    for _ in range(1000):  # signals are delivered a little later
        if not left():
            break
        time.sleep(0.02)
    expect(not left(), f"{what}: these processes are left: {left()}")
    profiles = list(temporary.glob("shoot-*"))
    expect(not profiles, f"{what}: these folders are left: {profiles}")


def wait_for(path, process):
    for _ in range(6000):
        if path.exists() or process.poll() is not None:
            break
        time.sleep(0.02)
    expect(path.exists(), f"{path} was never written, exit code {process.poll()}")


shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
environment = {**os.environ, "TMPDIR": str(temporary), "NODE_MODULES": str(folder / "modules")}
(folder / "modules/three").mkdir(parents=True)

# The program: its whole answer is there while the engine still draws, and no signal leaves a process.
started = folder / "started"
write(folder / "bin/node", f"#!/bin/sh\ntrap '' TERM\nsleep 1000 &\n: > {started}\nwait\n", 0o755)
write(folder / "bin/chromium", "#!/bin/sh\n", 0o755)
for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGKILL"):
    out = folder / f"advice-{name}"
    started.unlink(missing_ok=True)
    trial = subprocess.Popen([program, "recommend", "cube-room", "--engine", "three", "--out", str(out), "--quiet", "--views", "1", "--acne", "1%",
                              "--set", "map.resolution=256", "--set", "filter.kind=none"],
                             env={**environment, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    wait_for(started, trial)
    there = {path.name for path in out.glob("*")} if out.exists() else set()
    for wanted in ("recommended.json", "recommended.toml", "recommended.txt", "engines.txt"):
        expect(wanted in there, f"{name}: {wanted} is not written before the engine draws: {sorted(there)}")
    trial.send_signal(getattr(signal, name))
    said = trial.communicate()[0].decode()
    expect(trial.returncode == -getattr(signal, name), f"{name}: exit code {trial.returncode}: {said}")
    expect("bias.constant" in said, f"{name}: the answer is not printed before the engine draws: {said}")
    expect_none_left(f"recommend, {name}")
    expect(json.loads((out / "recommended.json").read_text()), f"{name}: recommended.json")

# The adapter with browsers that speak its protocol alone.
BROWSER = f"""#!{sys.executable}
import http.client, json, os, sys, time, urllib.parse
here, folder = urllib.parse.urlsplit(sys.argv[-1]), {str(folder)!r}
def ask(path, method="GET", headers={{}}, body=None):
    connection = http.client.HTTPConnection(here.netloc)
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    return [answer.status, answer.read().decode("latin1"), answer.getheader("Content-Security-Policy")]
kind = os.environ["BROWSER"]
if kind == "hangs":
    time.sleep(1000)
if kind == "ends":
    sys.exit("the browser is broken")
if kind == "has no sandbox" and "--no-sandbox" not in sys.argv:
    sys.exit("[0101/FATAL:zygote_host_impl_linux.cc] No usable sandbox! Update your kernel")
if kind == "asks":
    asked = json.load(open(folder + "/asked.json"))
    model = urllib.parse.parse_qs(here.query)["model"][0]
    answers = {{path: ask(path) for path in asked}}
    answers["model"] = ask(model)
    answers["another host"] = ask("/page.mjs", headers={{"Host": "example.org"}})
    answers["another origin"] = ask("/save/frame.json", "POST", {{"Origin": "http://example.org"}}, "{{}}")
    answers["no origin"] = ask("/save/frame.json", "POST", {{}}, "{{}}")
    json.dump(answers, open(folder + "/answers.json", "w"))
json.dump(sys.argv[1:], open(folder + "/flags.json", "w"))
ask("/save/frame.json", "POST", {{"Origin": "http://" + here.netloc}}, "{{}}")
time.sleep(1000)
"""


def adapter(kind, model, **more):
    return subprocess.Popen(["node", str(shoot), "three/page.html", str(model), str(folder / "frame")], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, env={**environment, "CHROMIUM": str(folder / "browser"), "BROWSER": kind, **more})


def ended(process):
    said = process.communicate()[0]
    return process.returncode, said


if not shutil.which("node"):
    print("not run: the adapter, which needs node")
else:
    write(folder / "browser", BROWSER, 0o755)
    models = folder / "models"
    for name in ("a#b.gltf", "a b.gltf", "a%20b.gltf", "?.glb"):
        write(models / name, name)
    write(folder / "models-private/secret.txt", "secret")
    # Of each address whether a file is given for it. A missing picture is white.
    FOUND = {"/model/a%23b.gltf": "a#b.gltf", "/model/a%20b.gltf": "a b.gltf", "/model/a%2520b.gltf": "a%20b.gltf", "/model/%3F.glb?x#y": "?.glb", "/page.mjs": None}
    LOST = ["/model/..%2fmodels-private%2fsecret.txt", "/model/../models-private/secret.txt", "/..%2f..%2fREADME.md", "/model/%zz.gltf", "/model/%", "/model/", "/model",
            "/", "//", "/model/%00", "/model/none.gltf", "/node_modules/"]
    WHITE = ["/model/a%zz.png", "/model/none.jpg"]
    for name in ("a#b.gltf", "a%20b.gltf"):
        (folder / "asked.json").write_text(json.dumps([*FOUND, *LOST, *WHITE]))
        code, said = ended(adapter("asks", models / name))
        expect(code == 0, f"{name}: exit code {code}: {said}")
        answers = json.loads((folder / "answers.json").read_text())
        for path, text in {**FOUND, "model": name}.items():
            expect(answers[path][0] == 200 and text in (None, answers[path][1]), f"{name}: {path} gives {answers[path][:2]}")
            expect((answers[path][2] or "").startswith("default-src 'self'"), f"{name}: {path} has the policy {answers[path][2]}")
        for path in LOST:
            expect(answers[path][0] == 404 and not answers[path][1], f"{name}: {path} gives {answers[path][:2]}")
        for path in WHITE:
            expect(answers[path][0] == 200 and "PNG" in answers[path][1], f"{name}: {path} gives {answers[path][:2]}")
        for path in ("another host", "another origin", "no origin"):
            expect(answers[path][0] == 403, f"{name}: {path} gives {answers[path][:2]}")
        expect_none_left(name)
    # The sandbox: only root has none from the start.
    flags = json.loads((folder / "flags.json").read_text())
    root = os.getuid() == 0
    expect(("--no-sandbox" in flags) == root and ("without its sandbox, because it has none for root" in said) == root, f"flags {flags}: {said}")
    expect("--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1" in flags, f"flags {flags}")
    code, said = ended(adapter("has no sandbox", models / "a b.gltf"))
    expect(code == 0 and "note: Chromium runs without its sandbox" in said, f"without a sandbox: exit code {code}: {said}")
    expect_none_left("without a sandbox")
    code, said = ended(adapter("ends", models / "a b.gltf"))
    expect(code == 1 and "Chromium ended (1) before the frame: the browser is broken" in said, f"a browser that ends: exit code {code}: {said}")
    expect_none_left("a browser that ends")
    code, said = ended(adapter("hangs", models / "a b.gltf", SHOOT_SECONDS="1"))
    expect(code == 1 and "no frame after 1 s" in said, f"a browser that hangs: exit code {code}: {said}")
    expect_none_left("a browser that hangs")

# The engine itself: a model that names addresses everywhere.
if not shutil.which("node") or not shutil.which("chromium") or not (modules / "three").is_dir():
    print(f"not run: three.js, which needs node, chromium and {modules}/three")
else:
    hits = []

    class Listener(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            hits.append(self.path)
            self.send_error(404)

        def log_message(self, *_):
            pass

    elsewhere = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Listener)
    threading.Thread(target=elsewhere.serve_forever, daemon=True).start()
    address = f"127.0.0.1:{elsewhere.server_port}"
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": k} for k in range(3)]}],
                "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": k}}} for k in range(3)],
                "textures": [{"source": k} for k in range(3)], "images": [{"uri": uri} for uri in ("a%zz.png", f"http://{address}/a.png", f"//{address}/b.jpg")],
                "buffers": [{"uri": "data:application/octet-stream;base64,AADAwAAAAAAAAMBAAADAQAAAAAAAAMBAAAAAAAAAAAAAAMDAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAABAAIA", "byteLength": 66}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}, {"buffer": 0, "byteOffset": 60, "byteLength": 6}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-6, 0, -6], "max": [6, 0, 6]},
                              {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}, {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"}]}
    model = write(folder / "a#b%20c.gltf", json.dumps(document))
    real = {**environment, "NODE_MODULES": str(modules)}
    drawn = subprocess.run(["node", str(shoot), "three/page.html", str(model), str(folder / "frame"), "width=64", "height=36", "eye=3,4,3", "target=0,0,0"],
                           capture_output=True, text=True, env=real)
    expect(drawn.returncode == 0, f"three.js: exit code {drawn.returncode}: {drawn.stdout}{drawn.stderr}")
    expect(not hits, f"three.js asked another server for {hits}")
    expect_none_left("three.js")
    for name in ("SIGTERM", "SIGINT", "SIGHUP"):
        drawing = subprocess.Popen(["node", str(shoot), "three/page.html", str(model), str(folder / "frame")], env=real, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(1000):
            if list(temporary.glob("shoot-*/*")) or drawing.poll() is not None:
                break
            time.sleep(0.01)
        drawing.send_signal(getattr(signal, name))
        drawing.wait()
        expect_none_left(f"three.js, {name}")
shutil.rmtree(temporary, ignore_errors=True)
sys.exit(bool(bad))
