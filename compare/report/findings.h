// Computes the report's conclusions from the results: pure functions over records, without HTML.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/store/records.h"

namespace noonmark {

// The value of a curve's series at a bias in window depth. The series is named by its metric ("error", "acne",
// "aliasing" = dark + light ...). It is linear between the curve's entries and constant beyond the last. Empty if the
// curve has no such series.
std::optional<double> curve_value(const BiasCurve& curve, const std::string& metric, double bias_depth);

// The amount, in window depth, with which the point was rendered, of the parameter that its curve varies. Empty if the
// settings do not give it.
std::optional<double> bias_as_set(const PointRecord& point);

// A bias that could be set for the curve's parameter. The curve's two factors convert it to metres and texels.
struct BiasChoice {
  double depth = 0;
  double error = 0;  // mean |R5 - R1| at this bias
};

struct Recommendation {
  enum class Outcome {
    found,
    none_holds,    // there are criteria, and no point meets them
    no_criterion,  // neither a bound nor a curve: no criterion for good enough
  } outcome = Outcome::no_criterion;
  const PointRecord* point = nullptr;  // found
  double cost_ms = 0, error = 0;       // found; the error at `bias`, or as rendered if there is no bias
  std::optional<BiasChoice> bias;      // found, and the point has a curve
};

// Times within this fraction of the cheapest count as equal, because a second run could order them differently.
inline constexpr double cost_tolerance = 0.1;

// The cheapest point that is good enough: it has the lowest shadow_ms, and the least error among points of equal cost.
// A point is good enough if every bound that applies to it holds and, if it has a curve, its usable window is not
// empty. Bounds on values of the curve are checked at the bias that would be set (the least error within the window),
// other bounds at the point as it was rendered. A value that is not finite, also a cost or an error, is never good
// enough. Among equal points the lowest id is taken.
Recommendation recommend(const Results& results);
// The same for the point with the least error, and among those the lowest cost.
Recommendation recommend_accurate(const Results& results);

// Whether one point meets a bound's limits. Metrics of the curve are read at `bias`, if it is given.
bool meets(const PointRecord& point, const BoundResult& bound, std::optional<double> bias_depth = std::nullopt);

// Indices of the points of the Pareto front, ascending in the first coordinate. No other point is lower or equal in
// both coordinates and lower in one. Equal points are all kept. Points with a value that is not finite are never on the
// front.
std::vector<size_t> pareto_front(std::span<const std::pair<double, double>> points);

struct CauseShare {
  std::string name;  // metric
  double mean = 0;   // over the points at which it is finite
  double share = 0;  // its part of the sum over all causes
};
// The causes of the error, the largest first, also those that rungs brought. Causes that are 0 everywhere are left out.
std::vector<CauseShare> cause_shares(std::span<const PointRecord* const> points);

}  // namespace noonmark
