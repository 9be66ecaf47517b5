// junit.xml: the verdict in the form that CI servers show.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark {

// One testcase per bound (results.bounds must be evaluated), a failure where it is broken; and one more, with an error,
// when the sweep did not finish, so that half a sweep is never green. Valid against the JUnit schemas of Ant
// (windyroad) and Jenkins, and well-formed whatever bytes the names hold.
std::string to_junit(const Results& results);

// One testcase with an error that says why nothing could be judged.
std::string to_junit(const Unjudged& unjudged);

}  // namespace noonmark
