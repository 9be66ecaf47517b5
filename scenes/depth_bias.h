// The bias in the floats that the shader works with: the one place where units become window depth and metres.
#pragma once
#include <algorithm>

#include "scenes/light_frame.h"
#include "scenes/settings.h"

namespace noonmark {

struct DepthBias {
  BiasForm form = BiasForm::none;
  float constant = 0, slope = 0, floor = 0;  // window depth
  float normal_offset_m = 0;                 // the receiver is looked up as if it lay this far along its normal

  // What the shader subtracts from the reference depth, in its own float arithmetic (the host is built without
  // contraction). n_dot_l: as the shader has it.
  float at(float n_dot_l) const {
    switch (form) {
      case BiasForm::none:
        return 0;
      case BiasForm::constant:
        return constant;
      case BiasForm::slope:
        return std::max(slope * (1.0f - n_dot_l), floor);
      case BiasForm::normal_offset:  // its reference depth is that of the moved receiver already
        return 0;
    }
    return 0;
  }

  // Whether the lookup falls elsewhere than without a bias: what it asks of the map, and of the truth, moves with it.
  bool moves_lookup() const { return normal_offset_m != 0; }

  // Where the receiver is looked up, in double.
  glm::dvec3 looked_up(glm::dvec3 position, glm::dvec3 normal) const {
    return position + static_cast<double>(normal_offset_m) * normal;
  }
};

inline DepthBias depth_bias(const LightFrame& frame, const BiasSettings& bias) {
  const double unit = frame.depth_per_bias_unit(bias.unit);
  const auto rounded = [&](double value) { return static_cast<float>(value * unit); };
  DepthBias result{.form = bias.form};  // what the form does not use stays 0
  if (bias.form == BiasForm::constant) result.constant = rounded(bias.constant);
  if (bias.form == BiasForm::slope) {
    result.slope = rounded(bias.slope);
    result.floor = rounded(bias.floor);
  }
  if (bias.form == BiasForm::normal_offset)
    result.normal_offset_m = static_cast<float>(bias.normal_offset * frame.texel_m());
  return result;
}

}  // namespace noonmark
