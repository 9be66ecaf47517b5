// A bias as the numbers that the shader computes with: the parts of technique/bias_parts.h that are not 0, and the
// reference of a tap.
//
//   Bias bias(settings.bias);
//   float depth = bias.at(probe, i);                        // what the shader subtracts at receiver i
//   glm::dvec3 p = bias.looked_up(frame, P, N);             // the place looked up of the receiver, in double
#pragma once
#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "technique/bias_parts.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

// A part with its amount. Amounts are floats because the shader's are floats. A part without a floor or a cap has a
// limit that no number reaches.
struct ActivePart {
  const BiasPart* part;
  float amount = 0, floor = std::numeric_limits<float>::lowest(), cap = std::numeric_limits<float>::max();

  // The value of a part that acts on the compared depth: amount * factor, limited to floor ... cap, with the shader's
  // arithmetic.
  float held(float factor) const { return std::min(std::max(amount * factor, floor), cap); }
};

// The unit of an amount of the bias that has the row's unit `unit` with these settings: "depth", "m", "texel" of bias.unit, "texels" or
// "m" of bias.offset_unit, otherwise itself.
std::string unit_of_amount(std::string_view unit, const BiasSettings& settings);

// All active parts of the bias. A part whose amount and floor are both 0 is not in the lists.
class Bias {
 public:
  Bias() = default;  // none
  explicit Bias(const BiasSettings& settings);

  BiasUnit unit() const { return unit_; }
  OffsetUnit offset_unit() const { return offset_unit_; }
  // The metres of 1 in offset_unit(), where a texel is texel_m wide.
  double offset_m(double texel_m) const { return offset_unit_ == OffsetUnit::m ? 1 : texel_m; }
  const TapReference& reference() const { return *reference_; }
  float plane_cap() const { return plane_cap_; }  // in units of bias.unit

  // The parts that act on each of the three places, in the order of the table.
  std::span<const ActivePart> compared() const { return compared_; }
  std::span<const ActivePart> moving() const { return moving_; }
  std::span<const ActivePart> casting() const { return casting_; }  // without the polygon offset

  // The depth that the shader subtracts from the reference at receiver i, in the shader's own float arithmetic. The
  // host is built without contraction.
  float at(const LookupProbe& probe, size_t i) const;

  // True if at() depends on tan_theta.
  bool reads_tan() const;

  // True if the normal that a renderer shades with changes at() or the place looked up.
  bool reads_normal() const;

  // True if the bias moves the place looked up. The probe and the truth of the taps then depend on the bias.
  bool moves_lookup() const { return !moving_.empty(); }
  // The vector by which the lookup is moved, in double. position and normal are in the world.
  glm::dvec3 moved_m(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) const;
  // The place looked up of the receiver.
  glm::dvec3 looked_up(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) const {
    return position + moved_m(frame, position, normal);
  }

  // True if the map is drawn from moved vertices (technique/casters.h).
  bool moves_casters() const { return !casting_.empty(); }

  // The arguments of glPolygonOffset(factor, units) while the map is drawn. It has no effect on a point light's map,
  // because that fragment shader writes its own depth.
  struct PolygonOffset {
    float factor = 0, units = 0;
  };
  const std::optional<PolygonOffset>& polygon_offset() const { return polygon_offset_; }

 private:
  BiasUnit unit_ = BiasUnit::depth;
  OffsetUnit offset_unit_ = OffsetUnit::texel;
  const TapReference* reference_ = tap_references().data();
  float plane_cap_ = std::numeric_limits<float>::max();
  // Whether a compared part has another factor at the second surface.
  bool compares_otherwise(const in_float::Surface& one, const in_float::Surface& other) const;
  std::vector<ActivePart> compared_, moving_, casting_;
  std::optional<PolygonOffset> polygon_offset_;
};

// The numbers of receiver i that the formulas of the compared parts read, as the shader computed them.
inline in_float::Surface surface_of(const LookupProbe& probe, size_t i) {
  in_float::Surface surface{};
  surface.n_dot_l = probe.n_dot_l[i];
  surface.tan_theta = probe.tan_theta[i];
  return surface;
}

// The numbers that the formulas of the moving parts read, in double, for the receiver at this position.
in_double::Surface surface_at(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal);

// The part whose amount a bias curve varies: the first active part that has a curve, or `constant` if no part is
// active. It is null if parts are active but none of them has a curve.
const BiasPart* curve_part(const BiasSettings& settings);

}  // namespace noonmark
