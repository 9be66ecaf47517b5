#include "compare/judge/map_distance.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/numbers.h"
#include "technique/depth_format.h"

namespace noonmark {
namespace {

constexpr double most_of_spread = 0.02;
// From a vertex to its window depth: the four products of a row of the matrix and their sums, the division, the interpolation.
// Each is at most 2^-24 of the lengths in it.
constexpr double roundings = 8 * 0x1p-24;

// share: from 0 to 1.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return not_a_number;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

MapDistance::MapDistance(const LightFrame& frame, DepthFormat format)
    : frame_(frame), format_(format), rounding_m_(roundings * (2 * glm::length(frame.origin_m) + frame.far_m)) {}

void MapDistance::add(glm::ivec2 texel, float exact, float stored) {
  const MapTile tile = frame_.tile_of_texel(texel);
  const double depth_m = tile.depth_of_window(exact);
  const double off_m = std::abs(tile.depth_of_window(stored) - depth_m);
  exact_m_.push_back(depth_m);
  off_m_.push_back(std::isfinite(off_m) ? off_m : infinity);
  step_m_.push_back(std::abs(depth_m - tile.depth_of_window(exact - static_cast<double>(depth_step(format_, exact)))));
}

double MapDistance::off_m() const { return quantile(off_m_, 0.5); }

double MapDistance::spread_m() const { return quantile(exact_m_, 0.95) - quantile(exact_m_, 0.05); }

double MapDistance::excess() const {
  const double of_spread = most_of_spread * spread_m();
  std::vector<double> excess(off_m_.size());
  for (size_t i = 0; i < excess.size(); ++i) excess[i] = off_m_[i] / std::max(of_spread, rounding_m_ + step_m_[i]);
  return quantile(std::move(excess), 0.5);
}

}  // namespace noonmark
