// The lookups of engines in a recommendation: three.js's VSMShadowMap and Babylon.js's exponential shadow maps (technique/lookups.h).
// What an engine has a field for is searched: the size of its map, its blur, its bias, and Babylon.js's depthScale. All else is as the
// engine computes it, so there is no lookup.reduction to choose: the settings hold the bounds as they are, or they do not.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/advise/recommend_space.h"
#include "compare/ladder/bias_curves.h"

namespace noonmark {

// Whether lookup.reduction is free. It is not in the forms of engines.
bool reduction_is_free(std::string_view lookup);

// The levels of a form of an engine, those without a bias first. searched: the bounds of the search; babylon_esm lights what is in
// the map by 1 - e^(-c b), so its bias b is the least whose darkness is within that on acne.
std::vector<BiasLevel> engine_form_levels(const std::string& lookup, const CurveOptions& searched);

// What was searched of it and what is fixed, a sentence.
std::string engine_form_text(std::string_view lookup);

// "VSMShadowMap of three.js with radius = 3 and blurSamples = 7"
std::string engine_form_name(const Settings& settings);

}  // namespace noonmark
