// junit.xml: the verdict in the format that CI servers show.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark {

// One testcase per bound (results.bounds must be evaluated), with a failure if the bound is broken. If the sweep did
// not finish, one more testcase with an error, so that an incomplete sweep never passes. The file is valid against the
// JUnit schemas of Ant (windyroad) and Jenkins, and well-formed for any bytes in the names.
std::string to_junit(const Results& results);

// One testcase with an error that says why nothing was judged.
std::string to_junit(const Unjudged& unjudged);

}  // namespace noonmark
