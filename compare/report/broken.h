// The broken bounds in words, each with its value, its limit, its point and the bias at which it was judged. The first
// screen, the index page and the card of a point say the same of them.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// "Acne is 0.83 % where at most 0.5 % is allowed, at resolution 2048 texels with bias.constant 2 texels as set", with a link
// to the point: of the first broken bound, and how many more there are. Empty if none is broken.
Markup broken_sentence(const Results& results);

// The same as text: "Acne 0.83 % (at most 0.5 %) at resolution 2048 texels". Empty if none is broken.
std::string broken_words(const Results& results);

// A link to the card of the point that shows the failure: its worst pixel by the bound's metric, with the bias as set.
Markup failure_link(const BoundResult& bound, const Markup& content);

// For page/card.js, of the bounds that this point breaks most: [{"metric", "text", "x", "y", "size"}]; x, y and size, a
// text, only if a pixel of the metric is known.
nlohmann::json failures_of(const PointRecord& point, const Results& results);

// "bias.constant 2 texels as set", where the point's curve says that other biases are possible; otherwise empty.
std::string set_bias_phrase(const PointRecord& point);

}  // namespace noonmark::report
