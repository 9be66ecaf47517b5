// "What to set": the recommendation as the first words of the report.
#pragma once
#include <span>
#include <string>

#include "compare/report/shown.h"
#include "compare/store/records.h"

namespace noonmark::report {

// The answer as one sentence of HTML, for the first screen.
std::string answer_sentence(const Results& results, const ShownPoints& shown);

std::string recommendation_box(const Results& results);

// The three largest causes of error over the points, with their colours: "Acne (60 %), Aliasing (30 %)".
std::string cause_sentence(std::span<const PointRecord* const> points);

}  // namespace noonmark::report
