# scripts/mutants --check finds what no longer applies, and takes a file that was only formatted anew. mutants_test.py SOURCE WORK
import shutil
import subprocess
import sys
from pathlib import Path

source, work = Path(sys.argv[1]), Path(sys.argv[2])
CODE = 'double half(double x) {\n  if (x < 0) return 0;\n  return call("a b", x) / 2;\n}\nint one = 1;\n'
GOOD = {"file": "base/half.cpp", "test": "base.Half.IsHalf", "old": "x) / 2;", "new": "x) / 3;"}


def check(mutant, code=CODE):
    shutil.rmtree(work, ignore_errors=True)
    for folder in ("scripts", "base", "tests/mutants"):
        (work / folder).mkdir(parents=True)
    shutil.copy(source / "scripts" / "mutants", work / "scripts")
    (work / "base/half.cpp").write_text(code)
    (work / "tests/CMakeLists.txt").write_text("noonmark_test(base half_test.cpp LIBS noonmark_base)\n")
    (work / "tests/half_test.cpp").write_text("TEST(Half, IsHalf) {}\nTEST_P(HalfOf, Each) {}\n")
    (work / "tests/mutants/m.mutant").write_text(mutant)
    return subprocess.run([sys.executable, work / "scripts/mutants", "--check"], capture_output=True, text=True, check=False)


def text_of(**other):
    return "# Why.\n" + "".join(f"{field}: {value}\n" for field, value in {**GOOD, **other}.items())


def fails(what, mutant, says, **options):
    ran = check(mutant, **options)
    if ran.returncode != 1 or "error: tests/mutants/m.mutant: " not in ran.stderr or says not in ran.stderr:
        sys.exit(f"{what}: expected exit code 1 and '{says}', got {ran.returncode}:\n{ran.stdout}{ran.stderr}")


def holds(what, mutant, **options):
    ran = check(mutant, **options)
    if ran.returncode != 0 or ran.stderr or ran.stdout != "1 mutants apply, 0 do not\n":
        sys.exit(f"{what}: expected that it applies, got {ran.returncode}:\n{ran.stdout}{ran.stderr}")


holds("one line", text_of())
holds("two lines", text_of(old="if (x < 0)\n  return 0;", new=""))
holds("a program alone", text_of(test="base"))
holds("one instance", text_of(test="base.All/HalfOf.Each/3"))
holds("a suite, and a second test", text_of(test="base.Half.* base.HalfOf.Each"))
holds("formatted anew", text_of(old="if (x < 0) return 0;"), code=CODE.replace("if (x < 0) return 0;", "if( x<0 )\n    return   0 ;"))
fails("file gone", text_of(file="base/third.cpp"), "there is no base/third.cpp")
fails("old text gone", text_of(old="x) / 4;"), "is not in base/half.cpp")
fails("old text twice", text_of(old="return"), "stands 2 times in base/half.cpp")
fails("a part of a word", text_of(old="on"), "is not in base/half.cpp")
fails("two words made one", text_of(old="inton e = 1"), "is not in base/half.cpp")
fails("new text equal", text_of(new="x)  /  2;"), "the new text equals the old one")
fails("program gone", text_of(test="other.Half.IsHalf"), "there is no test program test_other")
fails("test gone", text_of(test="base.Half.IsWhole"), "there is no test Half.IsWhole")
fails("no old text", text_of(old=""), "it has no 'old'")
fails("no test", text_of(test=""), "it has no 'test'")
fails("another field", text_of(by="me"), "begins with none of file, test, old, new")
fails("a field twice", text_of() + "new: y\n", "gives 'new' a second time")
fails("text without a field", "  x\n" + text_of(), "goes on with a text")
