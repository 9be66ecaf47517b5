"""What a replay may not do: it writes outside of its folder, reaches the network, takes more memory or time than its limits, or outlives the
reader. What this kernel does not offer is said and left out. Argument: the source folder."""
import ctypes
import multiprocessing
import os
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, sys.argv[1] + "/captures")
import capture  # noqa: E402

temporary = tempfile.TemporaryDirectory()
home = temporary.name
inside = os.path.join(home, "out")
os.mkdir(inside)
mine = os.path.join(home, "mine")
open(mine, "w").close()
LOWER = capture.SECONDS // 2
server = socket.create_server(("127.0.0.1", 0))


def tries(pipe):
    """In a process that is confined, under a limit of processor time that is lower already."""
    resource.setrlimit(resource.RLIMIT_CPU, (LOWER, LOWER))
    capture.confine(inside)
    done = []
    for name, act in {
            "a file in its folder": lambda: open(os.path.join(inside, "file"), "w"), "a file that is read": lambda: open(mine),
            "a file elsewhere": lambda: open(os.path.join(home, "new"), "w"), "a file that is there": lambda: open(mine, "r+"),
            "a file removed": lambda: os.remove(mine), "a folder elsewhere": lambda: os.mkdir(os.path.join(home, "folder")),
            "the network": lambda: socket.create_connection(server.getsockname(), 2)}.items():
        try:
            act()
            done.append(name)
        except OSError:
            pass
    limits = [resource.getrlimit(which) for which in (resource.RLIMIT_AS, resource.RLIMIT_CPU, resource.RLIMIT_CORE)]
    pipe.send((done, limits))


def reader(pipe):
    child = multiprocessing.get_context("fork").Process(target=lambda: (capture.confine(inside), pipe.send(os.getpid()), time.sleep(600)))
    child.start()
    time.sleep(600)


def run(target):
    here, there = multiprocessing.Pipe()
    process = multiprocessing.get_context("fork").Process(target=target, args=[there])
    process.start()
    there.close()  # so that its end is seen here
    try:
        return process, here.recv()
    except EOFError:
        sys.exit("FAILED: it ends while it is confined")


bad = []
process, (done, limits) = run(tries)
process.join()
has_landlock = ctypes.CDLL(None).syscall(capture.LANDLOCK_CREATE, None, 0, 1) > 0
has_no_network = subprocess.run(["unshare", "-rn", "true"], stderr=subprocess.DEVNULL).returncode == 0
may = {"a file in its folder", "a file that is read"}
if not may <= set(done):
    bad.append(f"cannot do {may - set(done)}")
for offered, which in ((has_landlock, {"a file elsewhere", "a file that is there", "a file removed", "a folder elsewhere"}), (has_no_network, {"the network"})):
    if not offered:
        print(f"left out, as this kernel does not offer it: {', '.join(sorted(which))}")
    elif which & set(done):
        bad.append(f"can do {which & set(done)}")
if limits != [(capture.MEMORY, capture.MEMORY), (LOWER, LOWER), (0, 0)]:
    bad.append(f"its limits are {limits}")
process, child = run(reader)
os.kill(process.pid, signal.SIGKILL)
process.join()
for _ in range(500):
    if not os.path.exists(f"/proc/{child}") or open(f"/proc/{child}/stat").read().split()[2] == "Z":
        break
    time.sleep(0.02)
else:
    os.kill(child, signal.SIGKILL)
    bad.append("it outlives a reader that is killed")
# A replay that crashes once is made again; one that is killed is not.
STAND_IN = """import os
class Refusal(Exception): pass
def read(options):
    if not os.path.exists(options.out + '/once'):
        open(options.out + '/once', 'w').close()
        os.kill(os.getpid(), {})
"""
for number, code in ((signal.SIGSEGV, 0), (signal.SIGKILL, 3)):
    place = tempfile.mkdtemp(dir=home)
    shutil.copy(sys.argv[1] + "/captures/capture.py", place)
    for name, text in (("read_capture.py", STAND_IN.format(int(number))), ("frame.rdc", "RDOC")):
        with open(os.path.join(place, name), "w") as file:
            file.write(text)
    ran = subprocess.run([sys.executable, place + "/capture.py", place + "/frame.rdc", place + "/out"], stderr=subprocess.DEVNULL, timeout=60)
    if ran.returncode != code:
        bad.append(f"after a replay that ends by {number.name} once the code is {ran.returncode}, not {code}")
if bad:
    sys.exit("FAILED: " + "; ".join(bad))
print("a replay is confined")
