"""Runs the steps of examples/ci/shadows.yml as GitHub Actions does, as far as that is possible here.

Arguments: the program, the source folder, an empty folder to work in. A step with `uses` is not run. The steps that install
and build are only read: the program is there. Exit code 77: something that the test needs is missing.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

try:
    import yaml
except ImportError:
    print("SKIPPED: python3-yaml is not installed")
    sys.exit(77)

program, source, work = (Path(argument) for argument in sys.argv[1:4])
failures = 0


def expect(holds, what):
    global failures
    if not holds:
        failures += 1
        print(f"FAILED: {what}")


workflow = yaml.safe_load((source / "examples/ci/shadows.yml").read_text())
# YAML 1.1 reads the key `on` as true.
expect(workflow.get("on", workflow.get(True)) == ["push", "pull_request"], "the workflow runs on pushes")
expect(list(workflow["jobs"]) == ["shadows"], "one job")
job = workflow["jobs"]["shadows"]
shell = job["defaults"]["run"]["shell"]
expect(shell == "bash", "the steps are for bash")
for step in job["steps"]:
    expect(("run" in step) != ("uses" in step), f"a step runs or uses something: {step}")
    if "run" in step:
        syntax = subprocess.run([shell, "-n"], input=step["run"], text=True, capture_output=True)
        expect(syntax.returncode == 0, f"{step['name']}: {syntax.stderr}")
not_here = {"Install git", "Build the package", "Install Noonmark"}
expect(not_here <= {step.get("name") for step in job["steps"]}, "the steps that are not run have these names")
kept = [step for step in job["steps"] if step.get("uses", "").startswith("actions/upload-artifact")]
expect(len(kept) == 1 and kept[0]["if"] == "always()", "the artifact is kept of a failed job too")

# The package: the name under which cpack writes it, the sections that scripts/setup knows, and one key for each commit.
steps = {step.get("name"): step for step in job["steps"]}
keep, make, install = steps["Keep the package"], steps["Build the package"], steps["Install Noonmark"]
expect(keep["with"]["path"] == "noonmark_*.deb" and "./noonmark_*.deb" in install["run"], "what is kept is installed")
expect("${{ steps.noonmark.outputs.commit }}" in keep["with"]["key"] and steps["Get Noonmark"]["id"] == "noonmark",
       "another commit of Noonmark is another package")
expect(make["if"] == f"steps.{keep['id']}.outputs.cache-hit != 'true'", "a package that is kept is not built again")
listed = re.findall(r"^# ([a-z ]+?)(?::.*)?$", (source / "scripts/packages.txt").read_text(), re.M)
asked = re.search("scripts/setup (.*)", make["run"])[1].split()
expect(asked and set(asked) <= set(listed), f"{asked} are sections of scripts/packages.txt, which has {listed}")
presets = json.loads((source / "CMakePresets.json").read_text())["configurePresets"]
expect(any(f"--preset {preset['name']} " in make["run"] for preset in presets), "the preset exists")
others = yaml.safe_load((source / "examples/ci/matrix.yml").read_text())["jobs"]["package"]["steps"]
for name in ("Keep the package", "Build the package"):
    expect(steps[name] in others, f"matrix.yml has the same step '{name}'")


def run_job(experiment):
    """Runs the steps in a new folder. Returns the failed steps, and the folder."""
    folder = work / f"job{len(list(work.iterdir()))}"
    (folder / "shadows").mkdir(parents=True)
    (folder / "bin").mkdir()
    (folder / "bin/noonmark").symlink_to(program)
    (folder / "shadows/shadows.toml").write_text(experiment)
    environment = dict(os.environ, **{key: str(value) for key, value in job["env"].items()})
    environment |= {"GITHUB_STEP_SUMMARY": str(folder / "step-summary.md"), "PATH": f"{folder}/bin:{os.environ['PATH']}"}
    made = subprocess.run(
        ["noonmark", "check", environment["EXPERIMENT"], "--baseline", environment["BASELINE"], "--update-baseline",
         "--out", "elsewhere", "--quiet"], cwd=folder, env=environment, capture_output=True, text=True)
    expect((folder / environment["BASELINE"]).exists(), f"the baseline is written: {made.stdout}{made.stderr}")
    failed = []
    for step in job["steps"]:
        if "run" not in step or step["name"] in not_here or (failed and step.get("if") != "always()"):
            continue
        # As GitHub runs `shell: bash`.
        done = subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]], cwd=folder,
                              env=environment, capture_output=True, text=True)
        print(f"== {step['name']}: {done.returncode}\n{done.stdout}{done.stderr}")
        if done.returncode != 0:
            failed.append(step["name"])
    return failed, folder


shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
small = (source / "examples/ci/shadows.toml").read_text().replace("width_px = 640", "width_px = 96")
small = small.replace("height_px = 360", "height_px = 54").replace("[1024, 2048]", "[128, 256]")
expect("width_px = 96" in small and "[128, 256]" in small, "the experiment is made small")

loose = small.replace("max = 0.002", "max = 1").replace("max = 0.01", "max = 1")
failed, folder = run_job(loose)
expect(failed == [], f"all steps pass, but {failed} failed")
summary = (folder / "step-summary.md").read_text()
expect("Held" in summary and "no worse than the baseline" in summary, f"the job's page has the verdict: {summary}")

failed, folder = run_job(small.replace("constant = 4", "constant = 0.1"))
expect(failed == ["Check the shadows"], f"a broken bound fails one step, but {failed} failed")
summary = (folder / "step-summary.md").read_text()
expect("Broken" in summary, f"the page of a failed job says what is broken: {summary}")
for pattern in kept[0]["with"]["path"].split():
    expect(list(folder.glob(pattern)), f"the artifact has {pattern}")
picture = next(folder.glob("out/shadows/worst-pixel-*.png"), None)
expect(picture is not None and f"({picture.name})" in summary, "summary.md shows the worst pixel")
cases = ElementTree.parse(folder / "out/shadows/junit.xml").getroot().iter("testcase")
expect(any(case.find("failure") is not None for case in cases), "junit.xml has the failure")
sys.exit(1 if failures else 0)
