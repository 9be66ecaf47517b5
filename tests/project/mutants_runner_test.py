# scripts/mutants in a repository of its own, with a small program in place of GoogleTest's: which mutants are caught and by
# which case, that names are written down, and that a second run tries only what was not caught. mutants_runner_test.py SOURCE WORK
import os
import shutil
import subprocess
import sys
from pathlib import Path

source, work = Path(sys.argv[1]), Path(sys.argv[2])
FILES = {
    ".gitignore": "/build/\n",
    "CMakePresets.json": '{"version": 6, "configurePresets": [{"name": "mutants", "generator": "Ninja", "binaryDir": "${sourceDir}/build/mutants"}]}',
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(halves C)\nadd_subdirectory(tests)\n",
    "tests/CMakeLists.txt": "# noonmark_test(half half_test.cpp)\nadd_executable(test_half half_test.c ../half.c ../more.c)\n"
                            "set_target_properties(test_half PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)\n",
    "half.c": "int half(int x) {\n  return x / 2;\n}\n",
    "more.c": "int more(int x) { return x + 1; }\n",
    "tests/half_test.cpp": "TEST(Half, OfZero)\nTEST(Half, OfTen)\nTEST(Half, Skips)\nTEST(Half, Fails)\n",  # what --check reads
    # Answers --gtest_list_tests and --gtest_filter=CASE.
    "tests/half_test.c": r"""
#include <stdio.h>
#include <string.h>
int half(int x);
int main(int n, char** words) {
  if (strcmp(words[n - 1], "--gtest_list_tests") == 0) return puts("Half.\n  OfZero\n  OfTen\n  Skips\n  Fails\n  DISABLED_Not"), 0;
  const char* wanted = strchr(words[n - 1], '=') + 1;
  if (strcmp(wanted, "Half.Skips") == 0) return puts("[  SKIPPED ] 1 test.\n[  PASSED  ] 0 tests."), 0;
  if (strcmp(wanted, "Half.OfZero") == 0 ? half(0) != 0 : strcmp(wanted, "Half.OfTen") == 0 ? half(10) != 5 : 1) return 1;
  return puts("[  PASSED  ] 1 test."), 0;
}
""",
    "scripts/mutants": (source / "scripts/mutants").read_text(),
    "tests/mutants/caught.mutant": "file: half.c\ntest: half\nold: x / 2;\nnew: x / 3;\n",
    "tests/mutants/named.mutant": "# Why.\nfile: half.c\ntest: half.Half.OfZero\nold: x / 2;\nnew: x / 2 + 1;\n",
    "tests/mutants/survives.mutant": "file: more.c\ntest: half.Half.OfTen\nold: x + 1\nnew: x + 2\n",
}


def git(*arguments):
    subprocess.run(("git", "-C", work, "-c", "user.name=a", "-c", "user.email=a@b.c", *arguments), check=True, stdout=subprocess.DEVNULL)


def run(what, expected, code, *arguments):
    ran = subprocess.run([sys.executable, work / "scripts/mutants", *arguments], capture_output=True, text=True, check=False,
                         env={**os.environ, "NOONMARK_JOBS": "1"})
    said = [line for line in (ran.stdout + ran.stderr).splitlines() if not line.startswith("==")]
    said = [" ".join(line.split(";")[0].split()) for line in said]
    if ran.returncode != code or said != expected:
        sys.exit(f"{what}: expected exit code {code} and {expected}, got {ran.returncode} and {said}\n{ran.stdout}{ran.stderr}")


def write(name, text):
    (work / name).parent.mkdir(parents=True, exist_ok=True)
    (work / name).write_text(text)


if not shutil.which("git"):
    sys.exit(77)
shutil.rmtree(work, ignore_errors=True)
for name, text in FILES.items():
    write(name, text)
git("init", "--quiet")
git("add", ".")
git("commit", "--quiet", "--message", "a")

run("all", ["caught caught by half.Half.OfTen", "named caught by half.Half.OfZero", "survives SURVIVED", "2 caught, 1 survived"], 1)
run("again, and names", ["caught caught by half.Half.OfTen", "named caught by half.Half.OfZero", "survives SURVIVED", "2 caught, 1 survived"], 1, "--name-tests")
rows = (work / "build/mutants.results").read_text()
if [rows.count(f'"name": "{name}"') for name in ("caught", "named", "survives")] != [1, 1, 2]:
    sys.exit(f"only what was not caught is tried again:\n{rows}")
if (work / "tests/mutants/caught.mutant").read_text() != FILES["tests/mutants/caught.mutant"].replace("test: half", "test: half.Half.OfTen"):
    sys.exit("the test that caught a mutant is not in its file")
if (work / "tests/mutants/named.mutant").read_text() != FILES["tests/mutants/named.mutant"]:
    sys.exit("a mutant with its test named was changed")

write("tests/mutants/survives.mutant", FILES["tests/mutants/survives.mutant"].replace("Half.OfTen", "Half.Skips"))
run("a skipped test", ["survives ERROR its test fails without a mutant too, or is skipped here", "0 caught, 0 survived", "error: 1 mutants could not be tried"], 1, "survives")
write("tests/mutants/survives.mutant", FILES["tests/mutants/survives.mutant"].replace("x + 2", "y"))
run("does not build", ["survives ERROR it does not build", "0 caught, 0 survived", "error: 1 mutants could not be tried"], 1, "survives")
write("tests/mutants/survives.mutant", FILES["tests/mutants/survives.mutant"])
git("commit", "--quiet", "--all", "--message", "b")
run("only what changed", ["caught caught by half.Half.OfTen", "1 caught, 0 survived"], 0, "--changed", "HEAD~1")
run("none", ["0 mutants apply, 1 do not", "error: tests/mutants/other.mutant: there is no such mutant"], 1, "other")
