// Compares the probe's numbers at a receiver with the light's frame in double. The errors are multiples of the largest
// error that the shader's float arithmetic can have. If a shader computes its inputs wrongly, the truth is traced for
// the same wrong texels and the ladder does not show it. This check shows it.
#pragma once
#include <glm/glm.hpp>

#include "compare/ladder/ladder.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

struct ProbeErrors {
  double excess = 0;          // the largest multiple
  double address_texels = 0;  // largest distance of an exact place from the texel that the probe names; 0 inside
  double reference_m = 0;     // largest error of the reference depth
};

// std::max that treats a NaN as an infinite error.
void raise_error(double& value, double candidate);

class ProbeCheck {
 public:
  // eye_m: the camera's position.
  ProbeCheck(const LookupEvidence& evidence, const ReceiverImage& receivers, const LightFrame& frame, glm::dvec3 eye_m);

  void compare(size_t i, ProbeErrors& found) const;

 private:
  struct Place;  // the place looked up of receiver i, and its largest float error
  Place looked_up(size_t i) const;
  double direction_error() const;  // relative error of the shader's direction to the light
  glm::dvec3 error_in_cube(glm::dvec3 error, glm::dvec3 vector) const;
  void allow_other_face(glm::dvec3 light, in_bounds::Surface& surface) const;
  in_bounds::Surface bounded_surface(glm::dvec3 position, glm::dvec3 normal) const;
  glm::dvec4 clip_of(const Place& place) const;
  glm::dvec4 row_errors(const Place& place) const;
  bool may_ask_nothing(const Place& place) const;
  void compare_flat(size_t i, const Place& place, ProbeErrors& found) const;
  void compare_cube(size_t i, const Place& place, ProbeErrors& found) const;
  void compare_shading(size_t i, const Place& place, ProbeErrors& found) const;
  void compare_gradient(size_t i, const Place& place, ProbeErrors& found) const;

  const LookupEvidence& e_;
  const ReceiverImage& receivers_;
  const LightFrame& frame_;
  glm::dvec3 eye_m_;
  // Of each tile of a flat map: clip space from the world; and from planes (normal, offset from the light's position in
  // float).
  std::vector<MapTile> tiles_;
  std::vector<glm::dmat4> clip_, planes_;
  glm::dvec3 light_position_;
};

}  // namespace noonmark
