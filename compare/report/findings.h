// What the report concludes from the results: pure functions over records, no HTML.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/store/records.h"

namespace noonmark {

// A series of the curve by its metric's name ("error", "acne", "aliasing" = dark + light ...) at a bias in window
// depth, linear between the curve's entries and constant beyond its last. Empty when the curve has no such series.
std::optional<double> curve_value(const BiasCurve& curve, const std::string& metric, double bias_depth);

// The value in window depth that the point itself was rendered with, of the parameter that its curve varies.
// Empty when the settings do not say.
std::optional<double> bias_as_set(const PointRecord& point);

// A bias of the curve's parameter that could be set. Metres and texels: multiply with the curve's two factors.
struct BiasChoice {
  double depth = 0;
  double error = 0;  // mean |R5 - R1| there
};

struct Recommendation {
  enum class Outcome {
    found,
    none_holds,    // there are criteria, and no point meets them
    no_criterion,  // neither a bound nor a curve: nothing says what is good enough
  } outcome = Outcome::no_criterion;
  const PointRecord* point = nullptr;  // found
  double cost_ms = 0, error = 0;       // found; the error at `bias`, or as rendered without one
  std::optional<BiasChoice> bias;      // found, and the point has a curve
};

// Times within this fraction of the cheapest are taken for equal, because a second run would order them otherwise.
inline constexpr double cost_tolerance = 0.1;

// The cheapest point (lowest shadow_ms; among those alike in cost, the least error) that holds: every bound that speaks
// of it is met, and where it has a curve its usable window is not empty. Bounds on what the curve knows are asked at
// the bias that would be set (the least error within the window), the others at the point as it was rendered. A value
// that is not finite (cost and error included) never holds. Among equals the lowest id.
Recommendation recommend(const Results& results);
// The same, but the point with the least error, then the lowest cost.
Recommendation recommend_accurate(const Results& results);

// Whether one point meets a bound's limits; metrics that the curve knows are read at `bias`, when given.
bool meets(const PointRecord& point, const BoundResult& bound, std::optional<double> bias_depth = std::nullopt);

// Indices of the points that no other beats (lower or equal in both, lower in one), ascending in the first coordinate.
// Equal points are all kept. Points with a value that is not finite are never on the front.
std::vector<size_t> pareto_front(std::span<const std::pair<double, double>> points);

struct CauseShare {
  std::string name;  // metric
  double mean = 0;   // over the points where it is finite
  double share = 0;  // of the sum over all causes
};
// The causes that make up R5 - R1, largest first; those that are 0 everywhere are left out.
std::vector<CauseShare> cause_shares(std::span<const PointRecord* const> points);

}  // namespace noonmark
