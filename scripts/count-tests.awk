# Counts the tests in CTest's JUnit file: prints what failed and what was skipped by name, and at last
# 'N passed, N failed, N skipped'.
#   ctest --output-junit FILE --test-output-size-passed BYTES --test-output-size-failed BYTES; awk -f scripts/count-tests.awk FILE
#
# A GoogleTest program is one test of CTest, but each of its cases counts: what it prints says how many it would run, and how
# each ended. A case without an end has failed too: it crashed or hung, or stands after one that did, or the process ended
# early with exit code 0, which CTest takes for a success. Where no case failed but CTest says that the program did (a leak
# that a sanitizer found at the end), the program counts as one more failure.
#
# Of other tests the file says run (passed), fail, notrun (skipped by itself, or its program could not start) or disabled. A
# notrun counts as skipped only when the test asked for it. Whatever is not known to have passed or to have been skipped
# has failed.
/<testcase / {
  match($0, / name="[^"]*"/)
  name = substr($0, RSTART + 7, RLENGTH - 8)
  run = /status="run"/
  skip = /status="disabled"/
  begun = ended = wanted = ok = skips = fails = 0
  current = ""
}
/<skipped message="(SKIP_RETURN_CODE|SKIP_REGULAR_EXPRESSION)/ { skip = 1 }

!begun && match($0, /\[==========\] Running [0-9]+ tests?/) {
  begun = 1
  wanted = substr($0, RSTART + 21) + 0
}
begun && !ended && /\[ RUN      \] / { current = $NF }
begun && !ended && /\[       OK \] / { ok++; current = "" }
begun && !ended && /\[  SKIPPED \] / { skips++; print "skipped: " name " " current; current = "" }
begun && !ended && /\[  FAILED  \] / { fails++; print "failed: " name " " current; current = "" }
begun && /\[==========\] [0-9]+ tests? from [0-9]+ test suites? ran\./ { ended = 1 }

/<\/testcase>/ {
  if (!begun) {
    passed += run
    skipped += skip
    if (!run && !skip) { failed++; print "failed: " name }
    if (skip) print "skipped: " name
    next
  }
  passed += ok
  skipped += skips
  failed += wanted - ok - skips
  lost = wanted - ok - skips - fails
  if (wanted == 0) {
    failed++
    print "failed: " name " has no case; the suite that its row in tests/ names is gone"
  } else if (lost > 0) {
    print "failed: " name (current == "" ? "" : " " current) ": the program ended there, and " lost " of its " wanted " cases have no result"
  } else if (!run && !skip && fails == 0) {
    failed++
    print "failed: " name " as a whole, after all its cases"
  }
}
END { printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped }
