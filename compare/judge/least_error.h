// Which of several curves of error over cost has the least error at which cost: the lower envelope, and where the curves
// cross on it.
//
//   for (const CheapestStretch& one : least_errors(curves)) print("from", one.from, "on", curves[one.curve]);
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "compare/judge/answers.h"

namespace noonmark {

// A curve counts as better than another only if its error is somewhere less by this factor. Parts of a bias that act alike
// have errors that differ by a few percent, and their curves cross many times.
inline constexpr double error_that_differs = 1.05;
// On a logarithmic axis an error of 0 stands at the least positive error divided by this.
inline constexpr double below_the_least = 2.2;

// One curve has the least error from this cost on, up to the next stretch.
struct CheapestStretch {
  size_t curve = 0;
  double from = 0;
};

// curves: the measured points of each, in any order; points with a value that is not finite are left out. Between two of its
// points a curve is a straight line on logarithmic axes (on a linear axis of cost, if a cost is not above 0). It never rises,
// because its cheaper points can be taken as well; and so its last point holds for every higher cost. Before its first point it
// has no error. Where curves are equal, the one that had the least error before keeps it, at first that of the least index.
// Ascending in cost, the first at the cheapest point of all; empty if no curve has a point. No two neighbours are of one curve.
std::vector<CheapestStretch> least_errors(std::span<const std::vector<CostAndError>> curves);

}  // namespace noonmark
