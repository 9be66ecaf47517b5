#include "technique/tap_pattern.h"

#include <algorithm>
#include <cmath>

#include "technique/filters.h"

namespace noonmark {

double TapPattern::along_axis(int axis, int texel, double fraction) const {
  if (axis_weight) return axis_weight(texel, fraction, blended_side - 1);
  const int fetches = fetches_along(), at = texel / block;
  const std::vector<double>& weights = axis == 0 ? kernel : along_v();
  return ((at < fetches ? weights[static_cast<size_t>(at)] * (1 - fraction) : 0) +
          (at > 0 ? weights[static_cast<size_t>(at) - 1] * fraction : 0)) /
         block;
}

int TapPattern::fetches() const {
  if (!bilinear()) return taps;
  const int along = axis_weight ? blended_side / 2 : static_cast<int>(kernel.size());
  return along * along;
}

double TapPattern::reach_texels() const {
  float reach = 0;
  for (const glm::vec3& o : offsets) reach = std::max({reach, std::abs(o.x), std::abs(o.y)});
  return static_cast<double>(reach) + block / 2.0;
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
