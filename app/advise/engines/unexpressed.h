// The sentences that say what an engine cannot express of the settings, or expresses otherwise, and what to do instead.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/advise/engines/engine.h"

namespace noonmark {

// knob: the field that takes the part; null if the engine has no field of its form.
std::vector<std::string> unexpressed_part(const AdvisedPart& part, const EngineKnob* knob,
                                          const std::vector<EngineKnob>& knobs, const AdvicePlace& place);
std::vector<std::string> unexpressed_reference(const std::vector<EngineKnob>& knobs, const AdvicePlace& place);
std::vector<std::string> unexpressed_filter(const AdvicePlace& place);
// expressed: further settings of the map that the engine expresses, beside resolution, format and volume.
std::vector<std::string> unexpressed_map(const AdvicePlace& place, const std::vector<std::string_view>& expressed);
std::vector<std::string> unexpressed_distance(const AdvicePlace& place);

}  // namespace noonmark
