"""Runs shares of an experiment as their users do, and compares the merged results with those of one run.

Arguments: what to run (parallel, slurm or matrix), the program, the source folder, an empty folder to work in.
Exit code 77: something that the test needs is missing.
  parallel  GNU parallel, three processes
  slurm     a Slurm of one node that the test starts and stops: examples/slurm with an array of 4 tasks, of which one is
            killed and requeued
  matrix    the steps of examples/ci/matrix.yml
"""
import contextlib
import csv
import os
import re
import secrets
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

what = sys.argv[1]
program, source, work = (Path(argument).resolve() for argument in sys.argv[2:5])
failures = 0
patience_s = 400  # for what takes seconds on an idle machine


def expect(holds, message):
    global failures
    if not holds:
        failures += 1
        print(f"FAILED: {message}")


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(77)


def found(*names):
    # Debian keeps the daemons in /usr/sbin, which is not in every user's PATH.
    places = os.environ["PATH"] + ":/usr/sbin:/sbin"
    return {name: shutil.which(name, path=places) for name in names}


def call(command, **more):
    done = subprocess.run(command, cwd=work, capture_output=True, text=True, **more)
    print(f"== {command}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def wait_until(holds, what_for):
    end = time.monotonic() + patience_s
    while not holds():
        if time.monotonic() > end:
            raise TimeoutError(what_for)
        time.sleep(0.02)


# The demo's experiment with small pictures and an eighth of the resolutions: 16 maps with two filters each, and a phase
# diagram. Some of its bounds break then, and the verdict is to be the same in any case.
text = (source / "experiments/cube-room.toml").read_text()
for whole, little in (('pictures = "extremes"', 'pictures = "none"'), ("\nwidth_px = 320\n", "\nwidth_px = 32\n")):
    expect(whole in text, f"the demo says {whole}")
    text = text.replace(whole, little)
text = re.sub(r"\b(512|1024|2048|4096)\b", lambda found: str(int(found[0]) // 8), text)
shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
(work / "demo.toml").write_text(text)
small = ["--set", "view.width_px=96", "--set", "view.height_px=54"]
(work / "bin").mkdir()


def install(shim):
    """Puts a program `noonmark` into the folder bin."""
    (work / "bin/noonmark").write_text(shim)
    (work / "bin/noonmark").chmod(0o755)


# The examples give no --set, so the program's stand-in does.
install(f"""#!/bin/bash
if [[ $1 == merge ]]; then exec {program} "$@"; fi
exec {program} "$@" {' '.join(small)}
""")
environment = {key: value for key, value in os.environ.items() if not key.startswith("SLURM_")}
environment["PATH"] = f"{work}/bin:{environment['PATH']}:/usr/sbin:/sbin"


def rows_of(folder):
    """Every column of results.csv without what two runs need not share: times, and where and when a point was measured."""
    expect(call([program, "report", folder, "--all"]).returncode == 0, f"{folder} has a report")
    with open(work / folder / "results.csv") as file:
        rows = list(csv.DictReader(file))
    return [{name: value for name, value in row.items() if not name.endswith("_ms") and not name.startswith("machine_")
             and "_ms_" not in name} for row in rows]


def testcases(folder):
    """junit.xml without when and by which command it was written, and how long it took."""
    lines = (work / folder / "junit.xml").read_text().splitlines()
    return [re.sub(' (timestamp|time)="[^"]*"', "", line) for line in lines if 'name="command"' not in line]


def compare_with_one_run(merged):
    one = call(["noonmark", "check", "demo.toml", "--out", "one", "--quiet"], env=environment)
    expect(one.returncode in (0, 1), "one run measures all points")
    expect(merged.returncode == one.returncode, f"the merge has the verdict of one run, {one.returncode}")
    a, b = rows_of("one"), rows_of("joined")
    expect(len(a) == len(b) and len(a) > 8, f"as many points: {len(a)} and {len(b)}")
    expect(len(a[0]) > 60, f"many columns are compared: {len(a[0])}")
    for here, there in zip(a, b):
        different = [name for name in here if here[name] != there.get(name)]
        expect(not different and set(here) == set(there), f"point {here.get('point')}: {different[:5]}")
    expect((work / "joined/report.html").stat().st_size > 100000, "the report is written")
    expect(testcases("joined") == testcases("one"), "junit.xml is that of one run")
    with contextlib.closing(sqlite3.connect(work / "joined/results.sqlite")) as joined:
        hosts = {host for host, in joined.execute("SELECT machine_host FROM points")}
    expect(hosts == {socket.gethostname()}, f"the hosts are recorded: {hosts}")
    store = (work / "joined/results.sqlite").read_bytes()
    expect(str(work).encode() not in store, "no path of the host is in the merged store")


def gnu_parallel():
    if not all(found("parallel").values()):
        skip("GNU parallel is not installed")
    done = call(["bash", "-c", "seq 3 | parallel --will-cite -j 3 noonmark run demo.toml --out joined --quiet --shard {}/3"],
                env=environment)
    expect(done.returncode == 0, "the shares are measured")
    shares = sorted((work / "joined").glob("share-*-of-*"))
    expect([share.name for share in shares] == [f"share-{i}-of-3" for i in (1, 2, 3)], f"each share has a folder: {shares}")
    # What is missing is named with the command that measures it, and the command does.
    shutil.move(work / "joined/share-2-of-3", work / "lost")
    part = call(["bash", "-c", "noonmark merge joined joined/share-*-of-*"], env=environment)
    expect(part.returncode == 6 and "measured by: noonmark run" in part.stderr and "--shard 2/3" in part.stderr,
           "the merge names the lost share")
    shutil.move(work / "lost", work / "joined/share-2-of-3")
    compare_with_one_run(call(["bash", "-c", "noonmark merge joined joined/share-*-of-*"], env=environment))


def matrix():
    try:
        import yaml
    except ImportError:
        skip("python3-yaml is not installed")
    workflow = yaml.safe_load((source / "examples/ci/matrix.yml").read_text())
    jobs = workflow["jobs"]
    expect({name: job.get("needs") for name, job in jobs.items()} == {"package": None, "share": "package", "merge": ["package", "share"]},
           "three jobs, one after the other")
    shares = jobs["share"]["strategy"]["matrix"]["share"]
    run_here = dict(environment, OUT="joined", EXPERIMENT="demo.toml", GITHUB_STEP_SUMMARY=str(work / "step-summary.md"))

    def step(job, name):
        steps = [one for one in jobs[job]["steps"] if one.get("name") == name]
        expect(len(steps) == 1, f"{job} has the step '{name}'")
        return steps[0]["run"]

    def run(script):
        # As GitHub runs `shell: bash`.
        return call(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script], env=run_here)

    for job in jobs.values():
        for one in job["steps"]:
            expect(("run" in one) != ("uses" in one), f"a step runs or uses something: {one}")
    for share in shares:
        script = step("share", "Measure the share").replace("${{ matrix.share }}", str(share))
        expect(f"{share}/{len(shares)}" in script, f"as many shares as machines: {script}")
        expect(run(script).returncode == 0, f"share {share} is measured")
    merged = run(step("merge", "Merge the shares"))
    expect(run(step("merge", "Show the summary")).returncode == 0, "the summary is shown")
    expect((work / "step-summary.md").stat().st_size > 100, "the summary says something")
    expect(merged.returncode in (0, 1) and len(rows_of("joined")) == 32, "the merge has all points and a verdict")


class Slurm:
    """Slurm on this node alone, as root, in a folder and with ports of its own."""

    def __init__(self):
        # Paths of sockets are short, and munged wants a folder that others cannot write.
        self.folder = Path(f"/tmp/noonmark-slurm-{os.getpid()}")
        self.started = []

    def __enter__(self):
        tools = found("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo", "squeue")
        if not all(tools.values()):
            skip(f"not installed: {', '.join(name for name, path in tools.items() if not path)}")
        if os.geteuid() != 0:
            skip("only root can start Slurm's daemons")
        self.folder.mkdir(mode=0o755)
        d, host = self.folder, socket.gethostname().split(".")[0]
        (d / "munge.key").write_bytes(secrets.token_bytes(1024))
        (d / "munge.key").chmod(0o400)
        ports = []
        for _ in range(2):
            with socket.socket() as free:
                free.bind(("127.0.0.1", 0))
                ports.append(free.getsockname()[1])
        (d / "slurm.conf").write_text(f"""ClusterName=noonmark
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={d}/munge.sock,cred_expire=5
CryptoType=crypto/munge
StateSaveLocation={d}/state
SlurmdSpoolDir={d}/spool
SlurmctldPidFile={d}/slurmctld.pid
SlurmdPidFile={d}/slurmd.pid
SlurmctldLogFile={d}/slurmctld.log
SlurmdLogFile={d}/slurmd.log
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
# AuthInfo's cred_expire: a requeued job waits as long as its credential is valid, by default two minutes.
SchedulerParameters=batch_sched_delay=1,sched_interval=2
ReturnToService=2
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
""")
        for name in ("state", "spool"):
            (d / name).mkdir()
        environment["SLURM_CONF"] = str(d / "slurm.conf")
        try:
            self.start([tools["munged"], "--force", f"--socket={d}/munge.sock", f"--key-file={d}/munge.key",
                        f"--pid-file={d}/munged.pid", f"--log-file={d}/munged.log", f"--seed-file={d}/munge.seed"], "munged")
            self.start([tools["slurmctld"]], "slurmctld")
            self.start([tools["slurmd"], "-N", host], "slurmd")
            wait_until(lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%T"], env=environment, capture_output=True,
                                                        text=True).stdout, "the node is idle")
        except (TimeoutError, subprocess.CalledProcessError) as error:
            logs = "".join(f"--- {log.name}\n{log.read_text()[-2000:]}" for log in sorted(d.glob("*.log")))
            self.__exit__()
            print(logs)
            skip(f"Slurm does not start here: {error}")
        return self

    def start(self, command, name):
        self.started.append(name)
        subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def __exit__(self, *_):
        order = [name for name in ("slurmctld", "slurmd", "munged") if name in self.started]
        for name in order:
            try:
                pid = int((self.folder / f"{name}.pid").read_text())
                os.kill(pid, signal.SIGTERM)
                wait_until(lambda: not Path(f"/proc/{pid}").exists(), f"{name} ends")
            except (OSError, ValueError, TimeoutError) as error:
                print(f"{name} was not stopped: {error}")
        shutil.rmtree(self.folder, ignore_errors=True)


def slurm():
    with Slurm():
        # The first start of share 2 leaves its process id and stops. It is then let run for a moment at a time, so that it
        # can be killed between two points on a slow or busy machine too.
        install(f"""#!/bin/bash
if [[ $1 == merge ]]; then exec {program} "$@"; fi
if [[ $SLURM_ARRAY_TASK_ID == 2 && ${{SLURM_RESTART_COUNT:-0}} == 0 ]]; then echo $$ > {work}/pid.part; mv {work}/pid.part {work}/pid; kill -STOP $$; fi
exec {program} "$@" {' '.join(small)}
""")
        done = call([source / "examples/slurm/submit", "demo.toml", "4", "joined"], env=environment)
        expect(done.returncode == 0, "the jobs are submitted")
        store = work / "joined/share-2-of-4/results.sqlite"

        def finished():
            try:
                with sqlite3.connect(f"file:{store}?mode=ro", uri=True, timeout=5) as db:
                    return db.execute("SELECT count(*) FROM finished").fetchone()[0]
            except sqlite3.Error:
                return 0

        wait_until(lambda: (work / "pid").exists(), "share 2 starts")
        pid = int((work / "pid").read_text())

        def has_a_point_after_a_moment():
            os.kill(pid, signal.SIGCONT)
            time.sleep(0.03)
            os.kill(pid, signal.SIGSTOP)
            return finished() > 0

        wait_until(has_a_point_after_a_moment, "share 2 has a point")
        os.kill(pid, signal.SIGKILL)
        kept = finished()
        print(f"share 2 was killed with {kept} points")
        wait_until(lambda: not subprocess.run(["squeue", "-h"], env=environment, capture_output=True, text=True).stdout.strip(),
                   "all jobs have ended")
        logs = {log.name: log.read_text() for log in sorted((work / "joined/logs").glob("*"))}
        for name, log in logs.items():
            print(f"--- {name}\n{log}")
        expect(set(logs) == {"merge.txt", *(f"share-{i}.txt" for i in range(1, 5))}, "each task has its log")
        expect("killed" in logs["share-2.txt"].lower(), "share 2 was killed")
        expect(" kept" in logs["share-2.txt"] and kept > 0, "share 2 continued behind its points")
        expect("the report is joined/report.html" in logs["merge.txt"], "the merge ran after the shares")
        merged = call(["bash", "-c", "noonmark merge joined joined/share-*-of-*"], env=environment)  # again: its exit code
        compare_with_one_run(merged)


{"parallel": gnu_parallel, "slurm": slurm, "matrix": matrix}[what]()
sys.exit(1 if failures else 0)
