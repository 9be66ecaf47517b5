// junit.xml: the verdict in the format that CI servers show.
#pragma once
#include <string>

#include "compare/judge/baseline.h"
#include "compare/store/records.h"

namespace noonmark {

// One testcase per bound (results.bounds must be evaluated), with a failure if the bound is broken. A broken bound that
// only warns is a skipped testcase with the message: CI servers list those in a colour of their own, and hardly any
// shows the output of a testcase that passed. If the sweep did
// not finish, one more testcase with an error, so that an incomplete sweep never passes. The file is valid against the
// JUnit schemas of Ant (windyroad) and Jenkins, and well-formed for any bytes in the names. baseline: one testcase
// more, with a failure if a value is worse; null: without it.
std::string to_junit(const Results& results, const BaselineComparison* baseline = nullptr);

// One testcase with an error that says why nothing was judged.
std::string to_junit(const Unjudged& unjudged);

}  // namespace noonmark
