// What a person must know of taps whose truth float error can change: they are booked as undecided, and a cause may be
// larger by as much as that.
#pragma once
#include <span>
#include <string>

#include "compare/store/records.h"

namespace noonmark {

// Undecided weight is worth a word where it is at least this share of the error: then the shares of the causes may be
// off by as much.
inline constexpr double much_undecided = 0.1;

// "0.02% of the light is wrong at taps whose truth is undecided ...", of the point where it is the largest share of the
// error; empty where there is nothing to say, and where the records do not say.
std::string undecided_note(std::span<const PointRecord> points);

// Of a bound on the filter or a cause that held at `point`, its worst: empty, or that it would not hold if all that is
// undecided there had that cause.
std::string undecided_note(const BoundResult& bound, const PointRecord& point);

}  // namespace noonmark
