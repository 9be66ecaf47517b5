// The sentences that say what an engine cannot express of the settings, or expresses otherwise, and what to do instead.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/advise/engines/engine.h"

namespace noonmark {

// Why there are no lines: no one and no two fields of the engine can replace these parts, or the reference.
std::string unexpressed_bias(const std::vector<AdvisedPart>& parts, const AdvicePlace& place);
// knob: the field that takes the part; null if the engine has no field of its form. replaced: other fields hold it then.
std::vector<std::string> unexpressed_part(const AdvisedPart& part, const EngineKnob* knob, bool replaced);
std::vector<std::string> unexpressed_reference(const AdvicePlace& place, bool replaced);
std::vector<std::string> unexpressed_filter(const AdvicePlace& place);
// expressed: further settings of the map that the engine expresses, beside resolution, format and volume.
std::vector<std::string> unexpressed_map(const AdvicePlace& place, const std::vector<std::string_view>& expressed);
std::vector<std::string> unexpressed_distance(const AdvicePlace& place);

}  // namespace noonmark
