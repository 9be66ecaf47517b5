// compare/judge/: whether it is good enough: bounds, laws, baselines, soundness of the renderer, the cheapest choice. May
// include what compare/ladder may, and the ladder.
//
// Bounds: checks the limits that an experiment asserts against the finished points.
//
//   auto results = evaluate_bounds(points, bounds, [&](const PointRecord& p) { return command_for(p); });
//   for (const BoundResult& r : results) if (!r.held) print(describe(r, find_point(points, r.point)));
//
// A bound is broken by a joined value beyond max or min, by a value that is missing or not finite at any of its points,
// and if no point matches it. One that the ambiguous receivers, which are left out, could break is broken too, with nothing
// found: it is not known to hold (ambiguous_room() in compare/judge/undecided.h). A frame whose delivery was refused
// (PointRecord::Delivery) has no values, so it matches none.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/judge/conditions.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "compare/results/records.h"

namespace noonmark {

struct Bound {
  // A metric or a quantity of the curve (quantities.h), or a pattern of such names: * is any text, ? any character.
  std::string metric;
  std::optional<double> max, min;  // inclusive; at least one
  Conditions where;                // empty: every point
  // worst: the largest value for a max, the smallest for a min. With both limits it is the value that breaks one,
  // otherwise the largest. mean, median: over all points of the bound. The median of an even number is the mean of the
  // two middle values.
  std::string join = "worst";
  // Of a point with map.placements: "worst", the placement that is worst for each limit; or "first", the map as the
  // settings place it. A quantity that is measured once for all placements is the same with both.
  std::string placement = "worst";
  std::string level = "error";  // "warn": broken, it is a warning and does not break the verdict
  std::string location{};       // where the experiment gives it: "file:line:column"; empty: not known
};

// Throws Error(usage) for an unknown metric, setting or join (with the nearest name as a suggestion), for a value that
// the setting cannot have, and for limits that are absent, not finite or crossed. points: the causes that rungs brought
// there are metrics too.
void check_bound(const Bound& bound, std::span<const PointRecord> points = {});

// All that the name or the pattern names. points: their own causes are among them. Throws Error(usage) if it names
// nothing, with the nearest name.
std::vector<QuantityInfo> quantities_named(const std::string& name, std::span<const PointRecord> points = {});

// A bound for each metric that the pattern names and that was measured at a point that the bound matches; if none was,
// a bound for each metric that it names, which are then broken. A bound without a pattern stays as it is.
std::vector<Bound> expanded(const Bound& bound, std::span<const PointRecord> points);

// Whether the bound breaks the verdict. A broken bound of level "warn" does not.
inline bool breaks(const BoundResult& bound) { return !bound.held && !bound.warns; }
// "held", "warning", "broken"
std::string_view verdict_of(const BoundResult& bound);

// Returns one result for each bound, or for each metric of its pattern, in order. reproduce returns the command that renders one point. Throws as
// check_bound does.
std::vector<BoundResult> evaluate_bounds(std::span<const PointRecord> points, std::span<const Bound> bounds,
                                         const std::function<std::string(const PointRecord&)>& reproduce);

// "acne <= 1% where map.resolution = 512 | 1024 (mean)"
std::string bound_text(const BoundResult& bound);

// "worst placement", "placement 0"; empty if the points have one placement each.
std::string_view placement_text(const BoundResult& bound);

// The unit of the bound's metric (Metric::unit).
std::string_view bound_unit(const BoundResult& bound);

// The limit beyond which the found value is. Empty if the bound holds, or if the value is not finite.
std::optional<double> broken_limit(const BoundResult& bound);

// With so many digits the found value does not read as the limit that it breaks.
int found_digits(const BoundResult& bound, int least = people_digits);

// ambiguous_room() of the value at its worst point. points: those that it was judged on.
double room_of(const BoundResult& bound, std::span<const PointRecord> points);

// The value found, for people ("0.8347%", text_with_room()), or "not measured".
std::string found_text(const BoundResult& bound, std::span<const PointRecord> points);

// The worst pixel of the bound's own metric at the point, as rendered. Empty if the metric has no pixel (a time, a window),
// and if the bound is not broken by too much of it.
std::optional<PointRecord::WorstOf> failing_pixel(const BoundResult& bound, const PointRecord& point);
// "worst pixel by acne: x = 12, y = 34 (row 0 on top), acne 66.67%"; empty if there is none.
std::string failing_pixel_text(const BoundResult& bound, const PointRecord& point);

// One line for a bound that held. For a broken bound also the point, the value found, the value allowed, the worst
// pixel and the command that reproduces it. point: the worst point, or null. swept: the settings that name the point;
// if empty, its id names it. Of a bound on the first point's own view the line says "at the given view" in place of its numbers.
std::string describe(const BoundResult& bound, const PointRecord* point, std::span<const std::string> swept = {});

// Null if there is none.
const PointRecord* find_point(std::span<const PointRecord> points, int64_t id);

}  // namespace noonmark
