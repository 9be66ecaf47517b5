// Warns of taps whose truth float error can change. They are booked as undecided, so a cause may be larger by their
// weight.
#pragma once
#include <span>
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// The undecided weight is reported if it is at least this share of the error, because the shares of the causes may be
// off by as much.
inline constexpr double much_undecided = 0.1;

// "undecided is 0.02% where the error is 0.1% ...", for the point at which it is the largest share of the error. Empty
// if there is nothing to report, and if the records lack the numbers.
std::string undecided_note(std::span<const PointRecord> points);

// For a bound on the filter or a cause that held at `point`, its worst point. Says that the bound would be broken if
// everything undecided there had that cause. Otherwise empty.
std::string undecided_note(const BoundResult& bound, const PointRecord& point);

}  // namespace noonmark
