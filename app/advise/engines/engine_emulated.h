// What an engine does with the lines that are typed into it, as settings that Noonmark can measure.
#pragma once
#include <vector>

#include "app/advise/engines/engine.h"

namespace noonmark {

SeenFrustum seen_frustum(const Settings& settings, const Scene& scene);

// The metres that each knob gives in each map with the number that is typed: [knob][map], as AdvisedPart::amount.
using ActingMetres = std::vector<std::vector<double>>;

// Sets advice.emulated, or why_not_emulated. place.filter and place.map: of the engine.
void emulate(const Engine& engine, const AdvicePlace& place, const std::vector<EngineKnob>& knobs,
             const ActingMetres& metres, EngineAdvice& advice);

// The same of cascades.
void emulate_cascades(const Engine& engine, const AdvisedCascades& cascades, const std::vector<EngineKnob>& knobs,
                      const ActingMetres& metres, EngineAdvice& advice);

}  // namespace noonmark
