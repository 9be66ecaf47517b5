// A bias in the numbers that the shader works with: the parts of technique/bias_parts.h that are not 0, and the
// reference of a tap.
//
//   Bias bias(settings.bias);
//   float depth = bias.at(probe, i);                        // what the shader subtracts at receiver i
//   glm::dvec3 p = bias.looked_up(frame, P, N);             // where the receiver is looked up, in double
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

// Amounts are floats because the shader's are. A part without a floor or a cap has one that no number reaches.
struct ActivePart {
  const BiasPart* part;
  float amount = 0, floor = std::numeric_limits<float>::lowest(), cap = std::numeric_limits<float>::max();

  // Of a part of the compared depth: amount * factor, held between floor and cap, as the shader computes it.
  float held(float factor) const { return std::min(std::max(amount * factor, floor), cap); }
};

// What no part is asked for does not act: a part whose amount and floor are 0 is not there.
class Bias {
 public:
  Bias() = default;  // none
  explicit Bias(const BiasSettings& settings);

  BiasUnit unit() const { return unit_; }
  const TapReference& reference() const { return *reference_; }
  float plane_cap() const { return plane_cap_; }  // in units of bias.unit

  // The parts that act there, in the order of the table.
  std::span<const ActivePart> compared() const { return compared_; }
  std::span<const ActivePart> moving() const { return moving_; }
  std::span<const ActivePart> casting() const { return casting_; }  // but for the polygon offset

  // What the shader subtracts from the reference depth at receiver i, in its own float arithmetic (the host is built
  // without contraction).
  float at(const LookupProbe& probe, size_t i) const;

  // Whether at() depends on tan_theta.
  bool reads_tan() const;

  // Whether the lookup falls elsewhere than without a bias: what it asks of the map, and of the truth, moves with it.
  bool moves_lookup() const { return !moving_.empty(); }
  // By how much, in double. position, normal: in the world.
  glm::dvec3 moved_m(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) const;
  // Where the receiver is looked up.
  glm::dvec3 looked_up(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) const {
    return position + moved_m(frame, position, normal);
  }

  // Whether the map is drawn of other vertices than the scene's (technique/casters.h).
  bool moves_casters() const { return !casting_.empty(); }

  // glPolygonOffset(factor, units) while the map is drawn; a fragment shader that writes its own depth, a point
  // light's, has none.
  struct PolygonOffset {
    float factor = 0, units = 0;
  };
  const std::optional<PolygonOffset>& polygon_offset() const { return polygon_offset_; }

 private:
  BiasUnit unit_ = BiasUnit::depth;
  const TapReference* reference_ = tap_references().data();
  float plane_cap_ = std::numeric_limits<float>::max();
  std::vector<ActivePart> compared_, moving_, casting_;
  std::optional<PolygonOffset> polygon_offset_;
};

// What the compared parts' formulas read of receiver i, as the shader has it.
inline in_float::Surface surface_of(const LookupProbe& probe, size_t i) {
  in_float::Surface surface{};
  surface.n_dot_l = probe.n_dot_l[i];
  surface.tan_theta = probe.tan_theta[i];
  return surface;
}

// What the moving parts' formulas read of the receiver at this place, in double.
in_double::Surface surface_at(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal);

// The part whose amount a bias curve runs through: the first that acts and has a curve, and constant where none acts.
// Null where parts act and none of them has a curve.
const BiasPart* curve_part(const BiasSettings& settings);

}  // namespace noonmark
