#include "compare/ladder/lasting_steps.h"

#include <cmath>
#include <stdexcept>

namespace noonmark {
namespace {

// std::min and std::max drop a NaN on one side.
double least_of(double a, double b) { return std::isnan(a) || b > a ? a : b; }
double not_below_zero(double a) { return a < 0 ? 0 : a; }

}  // namespace

void lasting_steps(std::span<const double> rungs, std::span<double> parts) {
  if (rungs.size() != parts.size() + 1) throw std::logic_error("a chain of rungs has one step fewer than rungs");
  const double first = rungs.front(), sign = rungs.back() < first ? -1 : 1;
  // Downwards: parts[k - 1] holds m_k, how much of the change is there from rung k on, at the least.
  double least = sign * (rungs.back() - first);
  for (size_t k = parts.size(); k > 0; --k) {
    least = not_below_zero(least_of(sign * (rungs[k] - first), least));
    parts[k - 1] = least;
  }
  double before = 0;
  for (double& part : parts) {
    const double lasts = part;
    part = sign * (lasts - before);
    before = lasts;
  }
}

}  // namespace noonmark
