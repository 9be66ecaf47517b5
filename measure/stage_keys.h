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
// What the lookup pass does: the picture, the map, the filter, and the parts of the bias. The amounts of parts that only
// change the depth that is compared are not in it, because they change no step of the shader and no texel it reads. So
// points with the same map_key_of() and the same text here ask the same of the machine.
std::string lookup_work_of(const Settings& settings);
// All of them, made once for a point.
struct StageKeys {
  explicit StageKeys(const Settings& settings);
  std::string scene, view, truth, map, lookup;
};

std::string curve_key_of(const Settings& settings, const BiasPart& varied, const CurveOptions& options);

}  // namespace noonmark
