// "What to set": the recommendation as the first words of the report.
#pragma once
#include <optional>
#include <span>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The answer for the first screen: first what is broken, then what to set.
Markup answer_sentence(const Results& results, const ShownPoints& shown);

Markup recommendation_box(const Results& results, const ShownPoints& shown);

// The three largest causes of error over the points, with their colours: "Acne (60 %), Aliasing (30 %)".
// bias: the bias, in bias.unit, at which the causes are read off the curves; without it, the causes as rendered.
Markup cause_sentence(std::span<const PointRecord* const> points, std::optional<double> bias = {});

}  // namespace noonmark::report
