#include "raytrace/light_view.h"

#include <algorithm>

namespace noonmark {

LightView::LightView(const Scene& scene, const LightFrame& frame)
    : scene_(&scene), frame_(frame), parallel_(frame.parallel()) {
  vertices_.reserve(scene.positions.size());
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  if (!parallel_) low = high = glm::dvec3(0);  // the light is part of what its rays' rounding spans
  for (const glm::vec3& position : scene.positions) {
    const glm::dvec3 p = frame.to_light(position);
    vertices_.push_back(p);
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double size = glm::length(high - low);
  ray_error_m_ = 0x1p-24 * (std::sqrt(3.0) * largest_coordinate(scene) + 4 * size);
  start_m_ =
      low.z - 0.01 * size - 4 * ray_error_m_;  // a margin for the rounding of the start, so that nothing is behind it

  ranges_.reserve(scene.triangles.size());
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const double depths[3] = {frame.depth_m(a), frame.depth_m(b), frame.depth_m(c)};
    Range range{*std::min_element(depths, depths + 3), *std::max_element(depths, depths + 3)};
    if (frame.kind == LightKind::point) {  // no nearer than its plane, nor than a corner less the longest side
      const glm::dvec3 n = glm::cross(b - a, c - a);
      const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
      const double length = glm::length(n);
      range.low = std::max(range.low - longest, length > 0 ? std::abs(glm::dot(n, a)) / length : 0.0);
    }
    ranges_.push_back(range);
    in_a_face_ |= !parallel_ && edge_on(t);
  }
}

glm::dvec3 LightView::normal_place(glm::dvec3 place) const {
  switch (frame_.kind) {
    case LightKind::directional:
      return place;
    case LightKind::spot:
      return {place.x / place.z, place.y / place.z, 1};
    case LightKind::point:
      return glm::normalize(place);
  }
  return place;
}

glm::dvec3 LightView::normal_away(uint32_t triangle) const {
  const glm::dvec3 a = corner(triangle, 0);
  const glm::dvec3 n = glm::cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  return (parallel_ ? n.z : glm::dot(n, a)) < 0 ? -n : n;
}

double LightView::slope(uint32_t triangle, glm::dvec3 x) const {
  const glm::dvec3 n = normal_away(triangle);
  if (parallel_) return glm::length(glm::dvec2(n)) / std::abs(n.z);
  return glm::length(glm::cross(n, x)) / std::abs(glm::dot(n, x));
}

double LightView::width(uint32_t triangle) const {
  const glm::dvec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  return glm::length(glm::cross(b - a, c - a)) / longest;
}

double LightView::plane_depth(uint32_t triangle, glm::dvec3 x) const {
  const glm::dvec3 a = corner(triangle, 0), e = corner(triangle, 1) - a, f = corner(triangle, 2) - a;
  if (parallel_) {
    const glm::dvec2 gradient = glm::dvec2(e.z * f.y - f.z * e.y, f.z * e.x - e.z * f.x) / (e.x * f.y - e.y * f.x);
    return a.z + glm::dot(gradient, glm::dvec2(x) - glm::dvec2(a));
  }
  const glm::dvec3 n = glm::cross(e, f);
  const double along = glm::dot(n, a) / glm::dot(n, x);  // x is normal: its own depth is 1
  return along < 0 ? std::numeric_limits<double>::infinity() : along;
}

double LightView::hit_depth(uint32_t triangle, glm::dvec3 x) const {
  const Range& range = ranges_[triangle];
  const double depth = plane_depth(triangle, x);
  return std::isnan(depth) ? range.low : std::clamp(depth, range.low, range.high);
}

glm::dvec3 LightView::at_depth(glm::dvec3 x, double depth) const {
  return parallel_ ? glm::dvec3(x.x, x.y, depth) : x * depth;
}

LightRay LightView::ray_from(glm::dvec3 x, double depth) const {
  const glm::vec3 origin(frame_.to_world(at_depth(x, depth)));
  if (parallel_) return {origin, frame_.ray_direction};
  return {origin, glm::vec3(glm::normalize(frame_.to_world(x) - frame_.origin_m))};
}

LightRay LightView::ray(glm::dvec3 x) const { return ray_from(x, parallel_ ? start_m_ : 0); }

void LightView::first_hits(const EmbreeScene& embree, int count, const glm::dvec3* x, uint32_t* hits) const {
  LightRay rays[packet_size];
  for (int i = 0; i < count; ++i) rays[i] = ray(x[i]);
  embree.first_hits(count, rays, hits);
  if (!in_a_face_) return;
  std::vector<uint32_t> met;
  for (int i = 0; i < count; ++i) {
    if (hits[i] == no_primitive || !edge_on(hits[i])) continue;
    met.clear();
    embree.all_hits(rays[i], met);
    hits[i] = no_primitive;
    for (uint32_t t : met)
      if (!edge_on(t) && (hits[i] == no_primitive || hit_depth(t, x[i]) < hit_depth(hits[i], x[i]))) hits[i] = t;
  }
}

double LightView::near_depth(glm::dvec3 x) const {
  if (frame_.kind != LightKind::point) return frame_.near_m;
  const glm::dvec3 a = glm::abs(x);
  return frame_.near_m / std::max({a.x, a.y, a.z});
}

}  // namespace noonmark
