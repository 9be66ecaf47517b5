#include "technique/tap_pattern.h"

#include <algorithm>
#include <cmath>

#include "technique/filters.h"

namespace noonmark {

double TapPattern::weight(int tap, glm::dvec2 fraction) const {
  if (!bilinear()) return 1.0 / taps;
  if (axis_weight) {
    const int size = blended_side - 1;
    return axis_weight(tap % blended_side, fraction.x, size) * axis_weight(tap / blended_side, fraction.y, size);
  }
  const int fetches = static_cast<int>(kernel.size()), side = fetches + 1;
  const auto along = [&](const std::vector<double>& weights, int i, double f) {
    return (i < fetches ? weights[static_cast<size_t>(i)] * (1 - f) : 0) +
           (i > 0 ? weights[static_cast<size_t>(i) - 1] * f : 0);
  };
  return along(kernel, tap % side, fraction.x) * along(along_v(), tap / side, fraction.y);
}

int TapPattern::fetches() const {
  if (!bilinear()) return taps;
  const int along = axis_weight ? blended_side / 2 : static_cast<int>(kernel.size());
  return along * along;
}

double TapPattern::reach_texels() const {
  float reach = 0;
  for (const glm::vec3& o : offsets) reach = std::max({reach, std::abs(o.x), std::abs(o.y)});
  return static_cast<double>(reach) + 0.5;
}

namespace {
using uint = uint32_t;
namespace shared {
#include "technique/pixel_hash.glsl"
}
}  // namespace

uint32_t hash_pixel(uint32_t pixel) { return shared::hash_pixel(pixel); }

TapPattern tap_pattern(const FilterSettings& settings) { return find_filter(settings.kind).taps(settings); }

}  // namespace noonmark
