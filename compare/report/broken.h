// The broken bounds in words, each with its value, its limit, its point and the bias at which it was judged. The first
// screen, the index page and the card of a point say the same of them.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// "Acne is 0.83 % where at most 0.5 % is allowed, at resolution 2048 texels, with a bias of 2 texels as set.": of the first broken
// bound, and how many more there are. All empty if none is broken.
struct BrokenWords {
  const BoundResult* bound = nullptr;
  std::string before = "", subject = "", after = "";  // subject: the point
  std::string text() const { return before + subject + after; }
};
BrokenWords broken_words(const Results& results);
// The same with a link to the point.
Markup broken_sentence(const Results& results);

// A link to the card of the point that shows the failure: its worst pixel by the bound's metric, with the bias as set.
Markup failure_link(const BoundResult& bound, const Markup& content);

// For page/card.js, of the bounds that this point breaks most: [{"metric", "text", "x", "y", "size"}]; x, y and size, a
// text, only if a pixel of the metric is known.
nlohmann::json failures_of(const PointRecord& point, const Results& results);

// "a bias of 2 texels as set", where the point's curve says that other biases are possible; otherwise empty.
std::string set_bias_phrase(const PointRecord& point);

}  // namespace noonmark::report
