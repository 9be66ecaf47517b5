// The Pareto front, and the shares of the causes: pure functions over records, without HTML.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/judge/interval.h"
#include "compare/results/records.h"

namespace noonmark {

// Indices of the points of the Pareto front, ascending in cost: from the most accurate on, each that is certainly cheaper
// than all more accurate ones of the front. If costs are plain numbers: no other point is lower or equal in both and lower
// in one. Points that are equal, in cost as far as it is known, are all kept. Points with a value that is not finite are
// never on the front.
struct FrontPoint {
  MedianInterval cost;
  double error = 0;
};
std::vector<size_t> pareto_front(std::span<const FrontPoint> points);

struct CauseShare {
  std::string name;  // metric
  double mean = 0;   // over the points at which it is finite
  double share = 0;  // its part of the sum over all causes
};
// The causes of the error, the largest first, also those that rungs brought. Causes that are 0 everywhere are left out.
// bias: in bias.unit; what the points' curves give is read there, all else as rendered.
std::vector<CauseShare> cause_shares(std::span<const PointRecord* const> points, std::optional<double> bias = {});

}  // namespace noonmark
