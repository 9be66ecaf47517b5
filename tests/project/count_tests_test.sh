#!/usr/bin/env bash
# Tests how scripts/count-tests.awk counts: CTest runs stand-ins for test programs, which print what GoogleTest prints and end
# in each way in which a program can end.
#   count_tests_test.sh SOURCE WORK
set -euo pipefail
source=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work"

# stand_in NAME END LINE...: a test of CTest that prints the lines and then does END.
stand_in() {
  local name=$1 end=$2
  shift 2
  { printf "printf '%%s\\\\n' "; printf "'%s' " "$@"; printf '\n%s\n' "$end"; } >"$name.sh"
  printf 'add_test(%s bash %s/%s.sh)\nset_tests_properties(%s PROPERTIES TIMEOUT %s SKIP_RETURN_CODE 77)\n' "$name" "$work" "$name" "$name" \
    "$([[ $name == hangs ]] && echo 3 || echo 60)" >>CTestTestfile.cmake
}
long=$(printf 'text %.0s' {1..1000})  # longer than what CTest keeps of a test that passed, unless it is asked for more
three='[==========] Running 3 tests from 1 test suite.'
a_ok=('[ RUN      ] S.A' '[       OK ] S.A (0 ms)')
b='[ RUN      ] S.B'
c_ok=('[ RUN      ] S.C' '[       OK ] S.C (0 ms)')
ran='[==========] 3 tests from 1 test suite ran. (0 ms total)'
stand_in passes 'exit 0' "$three" "${a_ok[@]}" "$b" "$long" 'text without a new line[       OK ] S.B (0 ms)' "${c_ok[@]}" "$ran" '[  PASSED  ] 3 tests.'
stand_in fails 'exit 1' "$three" "${a_ok[@]}" "$b" '[  FAILED  ] S.B, where GetParam() = 1 (0 ms)' "${c_ok[@]}" "$ran" '[  FAILED  ] S.B, where GetParam() = 1'
stand_in skips 'exit 0' "$three" "${a_ok[@]}" "$b" '[  SKIPPED ] S.B (0 ms)' "${c_ok[@]}" "$ran" '[  SKIPPED ] S.B'
stand_in crashes 'kill -SEGV $$' "$three" "${a_ok[@]}" "$b"
stand_in hangs 'sleep 60' "$three" "${a_ok[@]}" "$b"
stand_in leaves_early 'exit 0' "$three" "${a_ok[@]}" "$b"
stand_in leaks 'exit 1' "$three" "${a_ok[@]}" "$b" '[       OK ] S.B (0 ms)' "${c_ok[@]}" "$ran" 'SUMMARY: 1 byte leaked'
stand_in has_no_case 'exit 0' '[==========] Running 0 tests from 0 test suites.' '[==========] 0 tests from 0 test suites ran. (0 ms total)'
stand_in script 'exit 0' 'all is well'
stand_in script_fails 'exit 1' 'nothing is well'
stand_in script_skips 'exit 77' 'no browser'

# As scripts/test calls it.
given=$(grep -o -- '--test-output-size-[a-z]* [^ ]*' "$source/scripts/test" | tr '\n' ' ' | sed "s/\\\$whole/100000000/g")
# shellcheck disable=SC2086
ctest --output-junit results.xml $given >ctest.txt 2>&1 || true
awk -f "$source/scripts/count-tests.awk" results.xml >counted.txt
cat >expected.txt <<'TEXT'
failed: fails S.B
skipped: skips S.B
failed: crashes S.B: the program ended there, and 2 of its 3 cases have no result
failed: hangs S.B: the program ended there, and 2 of its 3 cases have no result
failed: leaves_early S.B: the program ended there, and 2 of its 3 cases have no result
failed: leaks as a whole, after all its cases
failed: has_no_case has no case; the suite that its row in tests/ names is gone
failed: script_fails
skipped: script_skips
14 passed, 10 failed, 2 skipped
TEXT
diff expected.txt counted.txt
