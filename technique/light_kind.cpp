#include "technique/light_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/camera_frame.h"
#include "technique/light_frame.h"
#include "technique/placements.h"

namespace noonmark {

extern const KindOfLight& directional_light;  // defined in technique/lights/
extern const KindOfLight& spot_light;
extern const KindOfLight& point_light;

std::span<const KindOfLight* const> kinds_of_light() {
  static const KindOfLight* const kinds[] = {&directional_light, &spot_light, &point_light};
  return kinds;
}

const KindOfLight& kind_of_light(LightKind kind) { return *kinds_of_light()[static_cast<size_t>(kind)]; }

void KindOfLight::texel_axes(const LightFrame& frame, glm::dvec3, glm::dvec3& right, glm::dvec3& up) const {
  right = frame.right;
  up = frame.up;
}

void KindOfLight::place_grid(LightFrame& frame, const Placements& placements, int placement) const {
  shift_grid(frame, static_cast<double>(frame.texel_block) * placements.shift_texels(placement));
}

std::vector<PlacementFact> KindOfLight::placement_facts(const LightFrame& placed, const Placements& placements,
                                                        int placement) const {
  const glm::dvec2 shift = static_cast<double>(placed.texel_block) * placements.shift_texels(placement);
  return {{"shift_u_texels", shift.x}, {"shift_v_texels", shift.y}};
}

std::string KindOfLight::placement_text(std::span<const double> values) const {
  return fmt::format("{:+g}, {:+g} texels from this point", values[0], values[1]);
}

glm::dvec3 KindOfLight::direction_to_light(const LightFrame& frame, glm::dvec3 world) const {
  return glm::normalize(frame.origin_m - world);
}

WayToLight KindOfLight::way_to_centre(const LightFrame& frame, glm::dvec3 world) const {
  const glm::dvec3 way = frame.origin_m - world;
  return {glm::vec3(glm::normalize(way)), static_cast<float>(glm::length(way)), frame.origin_m};
}

void KindOfLight::axes_across(const LightFrame& frame, glm::dvec3 world, glm::dvec3& right, glm::dvec3& up) const {
  upright_axes(direction_to_light(frame, world), {0, 1, 0}, right, up);
}

glm::dvec3 KindOfLight::tap_place(const LightFrame& frame, glm::dvec3 light, glm::dvec3 offset) const {
  const double w = frame.texel_m(light);
  return place(light + glm::dvec3(offset.x * w, offset.y * w, 0));
}

// For a light that is a sphere or a disc around its centre.
WayToLight KindOfLight::way_to_disc(const LightFrame& frame, const LightDisc& disc, glm::dvec3 p, glm::dvec2 u) const {
  const double phi = 2 * std::numbers::pi * u.y;
  const glm::dvec3 centre = frame.origin_m - p;
  const double distance = glm::length(centre);
  const glm::dvec3 axis = centre / distance;
  glm::dvec3 right = frame.right, up = frame.up;
  if (!(disc.shape == LightShape::disc && has_axis())) upright_axes(axis, {0, 1, 0}, right, up);
  const glm::dvec3 around = std::cos(phi) * right + std::sin(phi) * up;
  if (disc.shape == LightShape::disc) {
    const glm::dvec3 way = centre + disc.radius * std::sqrt(u.x) * around;
    return {glm::vec3(glm::normalize(way)), static_cast<float>(glm::length(way)), p + way};
  }
  // The cone of directions to the sphere is sampled uniformly in solid angle, which is uniformly in the cosine. 1 - cos
  // is computed without cancellation, because it is small for small lights.
  const double sine = disc.radius / distance;
  const double rest = u.x * (sine * sine / (1 + std::sqrt(1 - sine * sine)));  // 1 - cosine
  const double off = std::sqrt(rest * (2 - rest)), along = distance * (1 - rest);
  const double to_surface =
      along - std::sqrt(std::max(0.0, disc.radius * disc.radius - distance * off * distance * off));
  const glm::dvec3 direction = (1 - rest) * axis + off * around;
  return {glm::vec3(direction), static_cast<float>(to_surface), p + to_surface * direction};
}

std::vector<LightFact> KindOfLight::facts(const LightFrame&, const Light& light) const {
  return {{"radius_m", light.radius_m}, {"shape", light.shape == LightShape::disc ? "disc" : "sphere"}};
}

bool KindOfLight::surrounds(const LightFrame& frame, const LightDisc& disc, glm::dvec3 p) const {
  return disc.shape == LightShape::sphere && glm::length(frame.origin_m - p) <= disc.radius;
}

}  // namespace noonmark
