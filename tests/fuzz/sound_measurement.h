// Measures settings as in a sweep, on benches that several targets share, and says what must hold of every measurement.
//
//   measure_soundly(settings, true, false);   // throws Broken, or the Error of settings that cannot be measured
#pragma once
#include <string>

#include "technique/settings.h"

namespace noonmark::fuzz {

// The limits of compare/judge/soundness.h are kept, sums add up, numbers that may not be NaN are not. curve: the bias curve
// agrees with the measurement at the point's own bias. compare: earlier measurements do not change the result.
void measure_soundly(const Settings& settings, bool curve, bool compare);

// Every setting that is not the default, and the whole scene file, so that a failure can be repeated by hand.
std::string described(const Settings& settings);

}  // namespace noonmark::fuzz
