// What an engine does with the lines that are typed into it, as settings that Noonmark can measure.
#pragma once
#include <vector>

#include "app/advise/engines/engine.h"

namespace noonmark {

SeenFrustum seen_frustum(const Settings& settings, const Scene& scene);

// Sets advice.emulated, or why_not_emulated. metres: of each knob, as AdvisedPart::amount. place.filter and place.map: of the
// engine.
void emulate(const Engine& engine, const AdvicePlace& place, const std::vector<EngineKnob>& knobs,
             const std::vector<double>& metres, EngineAdvice& advice);

}  // namespace noonmark
