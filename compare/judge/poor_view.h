// What a person must know of a picture in which next to nothing could be judged: a bound may hold there on a handful of
// pixels, or because all is dark; and where no receiver is counted every fraction is NaN ("not measured").
#pragma once
#include <span>
#include <string>

#include "compare/store/records.h"

namespace noonmark {

inline constexpr double few_receivers_share = 0.01;  // of the picture's pixels: fewer receivers are few

// "only 535 of 921600 pixels can be judged: ...", with the reason and what to do; also of a picture in which nothing is
// lit, or of which near or far cut off more than that share. Empty where there is nothing to say, and where the record
// does not say.
std::string why_poor_view(const PointRecord& point);

// The same over points: how many there are, and what is said of the first; empty where there is none.
std::string poor_view_note(std::span<const PointRecord> points);

}  // namespace noonmark
