// How the weight of the next cascade grows over a blend band. A shape is one row of this table and one formula in
// technique/blends/<name>.glsl, which shader and host compile; the choice of cascades.blend_shape is made from the rows.
//
//   const CascadeBlend& shape = find_cascade_blend("smooth");
//   shape.in_double(0.25);   // a quarter of the way through the band: 0.15625
#pragma once
#include <span>
#include <string_view>

#include "technique/bounded.h"

namespace noonmark {

struct CascadeBlend {
  std::string_view name;  // a choice of cascades.blend_shape; the formula is <name>_blend()
  std::string_view help;
  // The weight at a part of the way through the band, both 0 to 1: in double, and with the bound of the error that a shader's
  // float arithmetic makes.
  double (*in_double)(double way);
  Bounded (*in_bounds)(Bounded way);
};

std::span<const CascadeBlend> cascade_blends();

// Throws std::logic_error if no row has that name.
const CascadeBlend& find_cascade_blend(std::string_view name);

}  // namespace noonmark
