// Warns of a picture in which almost nothing could be judged. A bound can hold there on very few pixels, or because
// everything is dark. If no receiver is counted, every fraction is NaN ("not measured").
#pragma once
#include <span>
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

inline constexpr double few_receivers_share = 0.01;  // of the picture's pixels; fewer receivers than this are few

// "only 535 of 921600 pixels can be judged: ...", with the reason and what to do. It also reports a picture in which
// nothing is lit (which a test of leaks means to be so), of which near or far cut off more than that share, or in which the
// truth of many receivers is ambiguous (ambiguous_note()). Empty if the picture is good, and if the record
// lacks the numbers.
std::string why_poor_view(const PointRecord& point);

// The same for several points: how many are poor, and the text of the first. Empty if there is none.
std::string poor_view_note(std::span<const PointRecord> points);

// All that makes the points' numbers say little, a sentence each: the poor picture, no flicker, undecided taps.
std::vector<std::string> doubts_of(std::span<const PointRecord> points);

}  // namespace noonmark
