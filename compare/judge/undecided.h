// What float error can change: taps, which are booked as undecided, so a cause may be larger by their weight; and receivers
// whose truth is ambiguous, which no metric of errors includes, so a value may be larger or smaller by their share.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "compare/results/number_text.h"
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

// Where floats resolve the shapes, less than this share of the facing receivers is ambiguous: tests hold every built-in scene to it
// (tests/raytrace/truth_test.cpp). There are many of them if significantly more are: a light or a scene is so far away that rounding
// is as large as the shapes, or shapes touch and overlap in many places.
inline constexpr double much_ambiguous = 0.001;

// The share of the receivers that is ambiguous if they are many, and 0 otherwise, and where it is not a number. In a small picture a
// few at an edge are no sign: their number must be further above what is usual than three of its standard deviations.
double many_ambiguous(double ambiguous, double receivers);

// Whether many receivers are ambiguous: then it is not known which biases keep a bound, and which error is the least.
bool hides_bounds(const PointRecord& point);

// By how much the quantity of all facing receivers may differ from that of the counted ones: of a share the ambiguous share,
// and infinity of what has no such limit (Metric::unbounded) and of what a curve says; of flicker, and of its counts of points, the points
// that are ambiguous in this frame or in the next one. 0 where not many are ambiguous,
// where the record does not have their number, of a quantity that does not depend on the truth, and of any other name (a setting).
double ambiguous_room(const PointRecord& point, std::string_view quantity);

// "14.2%", with room "0% ± 14.2%": a quantity of this unit that ambiguous_room() lets be larger or smaller by that much. "not known"
// if that is infinite.
std::string text_with_room(double value, double room, std::string_view unit, int digits = people_digits);

// "the truth of 14.2% of the receivers that face the light is ambiguous: ...", with what to do. Empty if not many are.
std::string ambiguous_note(const PointRecord& point);

}  // namespace noonmark
