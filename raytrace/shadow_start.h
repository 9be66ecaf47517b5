// Where the shadow rays of a receiver image start: exactly at the float P that the shader has too, with the place of
// the receiver's own plane along the ray known in double.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "raytrace/embree_scene.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"

namespace noonmark {

class ShadowStart {
 public:
  // light_travel: the exact float direction of the light's rays (LightFrame::ray_direction).
  ShadowStart(const Scene& scene, const ReceiverImage& receivers, glm::vec3 light_travel)
      : scene_(scene), receivers_(receivers), to_light_(-light_travel) {}

  ShadowRay at(size_t pixel) const { return towards(pixel, to_light_); }

  ShadowRay towards(size_t pixel, glm::vec3 direction) const {
    return from(receivers_.position[pixel], receivers_.primitive[pixel], direction);
  }

  // The same for R1: where P's rounding put it beyond its own plane, as a grazing ray sees it, from behind the plane.
  ShadowRay whole(size_t pixel) const {
    const ShadowRay ray = at(pixel);
    return ray.own_distance < 0 ? beside(pixel, glm::dvec3(0)) : ray;
  }

  // From P moved by offset (metres, across the light) and carried along its own plane to as far behind the plane as P's
  // rounding reaches along a grazing ray, so that the ray meets all that is before the plane.
  ShadowRay beside(size_t pixel, glm::dvec3 offset) const {
    const uint32_t own = receivers_.primitive[pixel];
    const glm::dvec3 moved = glm::dvec3(receivers_.position[pixel]) + offset;
    const double to_plane = own_distance(moved, own, to_light_);
    const double cosine = std::abs(glm::dot(glm::dvec3(receivers_.normal[pixel]), glm::dvec3(to_light_)));
    const double behind = 0x1p-23 * (glm::length(moved) + std::abs(to_plane)) / std::max(cosine, 0x1p-23);
    return from(glm::vec3(moved + (to_plane - behind) * glm::dvec3(to_light_)), own, to_light_);
  }

 private:
  ShadowRay from(glm::vec3 origin, uint32_t own, glm::vec3 direction) const {
    return {origin, direction, own, own_distance(origin, own, direction)};
  }

  double own_distance(glm::dvec3 origin, uint32_t own, glm::dvec3 direction) const {
    const glm::uvec3 t = scene_.triangles[own];
    const glm::dvec3 a = scene_.positions[t.x], b = scene_.positions[t.y], c = scene_.positions[t.z];
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double distance = glm::dot(cross, a - origin) / glm::dot(cross, direction);
    return std::isfinite(distance) ? distance : 0;  // edge-on: the plane is no help
  }

  const Scene& scene_;
  const ReceiverImage& receivers_;
  glm::vec3 to_light_;
};

}  // namespace noonmark
