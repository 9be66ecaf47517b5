// Bounds: what an experiment promises, asked of the finished points.
//
//   auto results = evaluate_bounds(points, bounds, [&](const PointRecord& p) { return command_for(p); });
//   for (const BoundResult& r : results) if (!r.held) print(describe(r, find_point(points, r.point)));
//
// What breaks a bound: a joined value beyond max or min; a value that is not finite or missing at any point asked; no
// point to ask.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/judge/conditions.h"
#include "compare/store/records.h"

namespace noonmark {

struct Bound {
  std::string metric;              // a metric or a quantity of the curve (quantities.h)
  std::optional<double> max, min;  // inclusive; at least one
  Conditions where;                // empty: every point
  // worst: the largest value for a max, the smallest for a min (with both: the one that breaks, else the largest).
  // mean, median: of all points asked; the median of an even number is the mean of the two in the middle.
  std::string join = "worst";
};

// Throws Error(usage) for an unknown metric, setting or join (suggesting the nearest name), a value the setting cannot
// take, and limits that are absent, not finite or crossed.
void check_bound(const Bound& bound);

// One result per bound, in order. reproduce gives the command that renders one point. Throws as check_bound does.
std::vector<BoundResult> evaluate_bounds(std::span<const PointRecord> points, std::span<const Bound> bounds,
                                         const std::function<std::string(const PointRecord&)>& reproduce);

// "acne <= 0.01 where map.resolution = 512 | 1024 (mean)"
std::string bound_text(const BoundResult& bound);

// Every digit of what was found, or "not measured".
std::string found_text(const BoundResult& bound);

// One line when held; when broken also the point, found and allowed, its worst pixel and the command that reproduces
// it. point: the worst point, or null. swept: settings to name the point by; empty: its id alone.
std::string describe(const BoundResult& bound, const PointRecord* point, std::span<const std::string> swept = {});

// Null when there is none.
const PointRecord* find_point(std::span<const PointRecord> points, int64_t id);

}  // namespace noonmark
