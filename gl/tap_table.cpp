#include "gl/tap_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace noonmark::gl {
namespace {

constexpr double whole = 0x1p24;

// Rounds weights of sum 1 to multiples of 1 / whole and keeps the sum. Each weight changes by less than one multiple:
// all are rounded down, and then those that lost most are rounded up instead.
std::vector<double> quantised(const std::vector<double>& weights) {
  std::vector<double> units, cut;
  for (double w : weights) {
    units.push_back(std::floor(w * whole));
    cut.push_back(w * whole - units.back());
  }
  std::vector<size_t> order(weights.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return cut[a] > cut[b]; });
  double missing = whole - std::accumulate(units.begin(), units.end(), 0.0);
  for (size_t k = 0; missing > 0; ++k, --missing) units[order[k % order.size()]] += 1;
  for (double& u : units) u /= whole;
  return units;
}

}  // namespace

std::vector<glm::vec4> tap_table(const TapPattern& pattern) {
  std::vector<glm::vec4> table;
  if (!pattern.bilinear()) {
    for (const glm::vec3& offset : pattern.offsets) table.emplace_back(offset, 0);
    return table;
  }
  if (pattern.axis_weight) return table;  // the shader has a formula for the weights
  const size_t n = pattern.kernel.size();
  std::vector<double> weights;
  for (size_t y = 0; y < n; ++y)
    for (size_t x = 0; x < n; ++x) weights.push_back(pattern.kernel[x] * pattern.along_v()[y]);
  weights = quantised(weights);
  const double middle = static_cast<double>(n - 1) / 2;
  for (size_t i = 0; i < weights.size(); ++i)
    table.emplace_back(static_cast<double>(i % n) - middle, static_cast<double>(i / n) - middle, 0, weights[i]);
  return table;
}

}  // namespace noonmark::gl
