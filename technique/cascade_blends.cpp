#include "technique/cascade_blends.h"

#include <vector>

#include "base/find_row.h"
#include "technique/formulas.h"

#define precise
namespace noonmark::in_double {
namespace {
#include "blend_formulas.inc"
}
}  // namespace noonmark::in_double
namespace noonmark::in_bounds {
namespace {
#include "blend_formulas.inc"
}
}  // namespace noonmark::in_bounds
#undef precise

namespace noonmark {

std::span<const CascadeBlend> cascade_blends() {
  static const std::vector<CascadeBlend> all = {
      {"linear", "evenly, as in Babylon.js, Bevy and three.js's CSM", in_double::linear_blend, in_bounds::linear_blend},
      {"smooth", "by a smoothstep, as in three.js's SunLight", in_double::smooth_blend, in_bounds::smooth_blend},
  };
  return all;
}

const CascadeBlend& find_cascade_blend(std::string_view name) {
  return find_row(cascade_blends(), name, "shape of a blend band");
}

}  // namespace noonmark
