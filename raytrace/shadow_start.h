// Where the shadow rays of a receiver image start: exactly at the float P, which the shader has too. The distance of
// the receiver's own plane along the ray is known in double.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "raytrace/embree_scene.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/light_frame.h"

namespace noonmark {

class ShadowStart {
 public:
  ShadowStart(const Scene& scene, const ReceiverImage& receivers, const LightFrame& frame)
      : scene_(scene), receivers_(receivers), frame_(frame) {}

  ShadowRay at(size_t pixel) const { return towards(pixel, way_from(receivers_.position[pixel])); }

  ShadowRay towards(size_t pixel, const WayToLight& way) const {
    return from(receivers_.position[pixel], receivers_.primitive[pixel], way);
  }

  // The same for R1. If the rounding of P has put it in front of its own plane, as a grazing ray sees it, the ray
  // starts behind the plane.
  ShadowRay whole(size_t pixel) const {
    const ShadowRay ray = at(pixel);
    return ray.own_distance < 0 ? beside(pixel, glm::dvec3(0)) : ray;
  }

  // Two axes across the ray of a receiver.
  struct Across {
    glm::dvec3 right, up;
  };
  Across across(size_t pixel) const {
    Across axes;
    frame_.light().axes_across(frame_, receivers_.position[pixel], axes.right, axes.up);
    return axes;
  }

  // The ray starts at P, moved by offset (metres, across the ray) and then moved along the ray to behind
  // its own plane, as far as the rounding of P reaches along a grazing ray. So the ray meets everything in front of the
  // plane.
  ShadowRay beside(size_t pixel, glm::dvec3 offset) const {
    const uint32_t own = receivers_.primitive[pixel];
    const glm::dvec3 moved = glm::dvec3(receivers_.position[pixel]) + offset;
    const WayToLight way = way_from(moved);
    const double to_plane = own_distance(moved, own, way.direction);
    const double cosine = std::abs(glm::dot(glm::dvec3(receivers_.normal[pixel]), glm::dvec3(way.direction)));
    const double behind = 0x1p-23 * (glm::length(moved) + std::abs(to_plane)) / std::max(cosine, 0x1p-23);
    const double carried = to_plane - behind;  // towards the light, which is as much nearer
    return from(glm::vec3(moved + carried * glm::dvec3(way.direction)), own,
                {way.direction, static_cast<float>(way.reach - carried), way.end});
  }

 private:
  WayToLight way_from(glm::dvec3 p) const { return frame_.light().way_to_centre(frame_, p); }

  ShadowRay from(glm::vec3 origin, uint32_t own, const WayToLight& way) const {
    return {origin, way.direction, way.reach, way.end, own, own_distance(origin, own, way.direction)};
  }

  double own_distance(glm::dvec3 origin, uint32_t own, glm::dvec3 direction) const {
    const glm::uvec3 t = scene_.triangles[own];
    const glm::dvec3 a = scene_.positions[t.x], b = scene_.positions[t.y], c = scene_.positions[t.z];
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double distance = glm::dot(cross, a - origin) / glm::dot(cross, direction);
    return std::isfinite(distance) ? distance : 0;  // edge-on: the ray does not meet the plane
  }

  const Scene& scene_;
  const ReceiverImage& receivers_;
  const LightFrame& frame_;
};

}  // namespace noonmark
