// "What to set": the recommendation as the first words of the report.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// What to set, or what is known instead, as sentences. `subject` opens its point where that can be.
struct AnswerWords {
  std::string before, subject = "", after = "";
  const PointRecord* point = nullptr;
  std::string text() const { return before + subject + after; }
};
AnswerWords answer_words(const Findings& found);

// For the first screen: the law's own sentence if one has it, what is broken, and otherwise what to set.
Markup answer_sentence(const Findings& found);

Markup recommendation_box(const ShownPoints& shown);

// The three largest causes of error over the points, with their colours: "Acne (60 %), Aliasing (30 %)".
// bias: the bias, in bias.unit, at which the causes are read off the curves; without it, the causes as rendered.
Markup cause_sentence(std::span<const PointRecord* const> points, std::optional<double> bias = {});

}  // namespace noonmark::report
