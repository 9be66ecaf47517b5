// The bias in the floats that the shader works with.
#pragma once
#include <algorithm>

#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

// Values in units of bias.unit; LookupProbe::bias_unit says what one of them is in window depth at each receiver.
struct DepthBias {
  BiasForm form = BiasForm::none;
  BiasUnit unit = BiasUnit::depth;
  float constant = 0, slope = 0, floor = 0, tan_scale = 0, cap = 0;
  float factor = 0, units = 0;     // polygon offset, while the map is drawn
  float normal_offset_texels = 0;  // the receiver is looked up as if it lay this far along its normal

  // What the shader subtracts from the reference depth at receiver i, in its own float arithmetic (the host is built
  // without contraction).
  float at(const LookupProbe& probe, size_t i) const {
    switch (form) {
      case BiasForm::none:
      case BiasForm::polygon_offset:  // in the map already
      case BiasForm::normal_offset:   // the reference depth is that of the moved receiver already
        return 0;
      case BiasForm::constant:
      case BiasForm::receiver_plane:
      case BiasForm::tangent_plane:
        return constant * probe.bias_unit[i];
      case BiasForm::slope:
        return std::max(slope * (1.0f - probe.n_dot_l[i]), floor) * probe.bias_unit[i];
      case BiasForm::tan:
        return std::min(std::max(tan_scale * probe.tan_theta[i], floor), cap) * probe.bias_unit[i];
    }
    return 0;
  }

  TapReference tap_reference() const {
    if (form == BiasForm::receiver_plane) return TapReference::plane_at_tap;
    if (form == BiasForm::tangent_plane) return TapReference::plane_at_texel;
    return TapReference::own_depth;
  }

  // Whether the lookup falls elsewhere than without a bias: what it asks of the map, and of the truth, moves with it.
  bool moves_lookup() const { return normal_offset_texels != 0; }

  // Where the receiver is looked up, in double.
  glm::dvec3 looked_up(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) const {
    return position + normal_offset_m(frame, position) * normal;
  }
  double normal_offset_m(const LightFrame& frame, glm::dvec3 position) const {
    return moves_lookup() ? normal_offset_texels * frame.texel_m(frame.to_light(position)) : 0;
  }
};

// What a form does not use stays 0.
inline DepthBias depth_bias(const BiasSettings& s) {
  const auto rounded = [](double value) { return static_cast<float>(value); };
  DepthBias bias;
  bias.form = s.form;
  bias.unit = s.unit;
  switch (s.form) {
    case BiasForm::none:
      break;
    case BiasForm::constant:
    case BiasForm::receiver_plane:
    case BiasForm::tangent_plane:
      bias.constant = rounded(s.constant);
      break;
    case BiasForm::slope:
      bias.slope = rounded(s.slope);
      bias.floor = rounded(s.floor);
      break;
    case BiasForm::tan:
      bias.tan_scale = rounded(s.tan_scale);
      bias.floor = rounded(s.floor);
      bias.cap = rounded(s.cap);
      break;
    case BiasForm::polygon_offset:
      bias.factor = rounded(s.factor);
      bias.units = rounded(s.units);
      break;
    case BiasForm::normal_offset:
      bias.normal_offset_texels = rounded(s.normal_offset);
      break;
  }
  return bias;
}

}  // namespace noonmark
