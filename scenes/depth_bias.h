// The bias in the floats that the shader compares with: the one place where units become window depth.
#pragma once
#include <algorithm>

#include "scenes/light_frame.h"
#include "scenes/settings.h"

namespace noonmark {

struct DepthBias {
  BiasForm form = BiasForm::none;
  float constant = 0, slope = 0, floor = 0;  // window depth

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
    }
    return 0;
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
  return result;
}

}  // namespace noonmark
