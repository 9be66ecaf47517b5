// Of which settings a stage's result is made, as text: while the text stays the same, the result does too. The workbench
// remembers results by these keys, and the estimate of a sweep's time counts by them what is computed anew.
#pragma once
#include <string>

#include "compare/ladder/bias_curves.h"
#include "technique/bias.h"
#include "technique/settings.h"

namespace noonmark {

std::string scene_key_of(const Settings& settings);
std::string view_key_of(const Settings& settings);
std::string truth_key_of(const Settings& settings);
// Only a map that is fitted to the view reads the camera.
std::string map_key_of(const Settings& settings);
// The probe and the truth of the taps. A polygon offset is in units of the map's format.
std::string lookup_key_of(const Settings& settings);
std::string curve_key_of(const Settings& settings, const BiasPart& varied, const CurveOptions& options);

}  // namespace noonmark
