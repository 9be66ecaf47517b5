// junit.xml: the verdict in the format that CI servers show.
#pragma once
#include <string>

#include "compare/judge/findings.h"

namespace noonmark {

// Of PointRecord::times: what the whole measurement of the point took, or the judging of the frame.
inline constexpr const char* point_time = "point_ms";

// One testcase per bound (results.bounds must be evaluated), with a failure if the bound is broken. If the bound only
// warns, its testcase is marked as skipped, and the message is the warning. The reason: CI servers show skipped
// testcases in a separate list, but most of them hide the output of a testcase that passed. If the sweep did not finish,
// there is one more testcase with an error, so that an incomplete sweep never passes. The file is valid against the
// JUnit schema of Jenkins, and well-formed for any bytes in the names. A comparison with a baseline is one testcase
// more, with a failure if a value is worse. The suite's time is what all points took to measure; that of a frame's testcase
// what the frame took. The others have no time of their own.
std::string to_junit(const Findings& found);

// One testcase with an error that says why nothing was judged.
std::string to_junit(const Unjudged& unjudged);

}  // namespace noonmark
