// The largest patch of wrong pixels: what people see first.
#pragma once
#include "compare/ladder/ladder.h"

namespace noonmark {

// The number of receivers in the largest set of counted ones that are connected over the sides and corners of pixels and
// are all wrong. A receiver is wrong if the judged picture and R1 are on different sides of one half; one half itself is
// on the lit side. So the soft rim that a filter makes is wrong only up to where it crosses one half. NaN if the
// visibility of a counted receiver is NaN.
double largest_wrong_patch(const Ladder& ladder);

}  // namespace noonmark
