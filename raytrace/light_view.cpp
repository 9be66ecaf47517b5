#include "raytrace/light_view.h"

#include <algorithm>
#include <stdexcept>

#include "raytrace/vertex_rounding.h"

namespace noonmark {

namespace {

std::optional<MapTile> tile_of_flat(const LightFrame& frame) {
  return frame.tiles == 1 && frame.map_shape() == MapShape::flat ? std::optional(frame.tile(0)) : std::nullopt;
}

}  // namespace

LightView::LightView(const Scene& scene, const LightFrame& frame)
    : scene_(&scene), frame_(frame), rays_(frame.light().rays()), only_tile_(tile_of_flat(frame)) {
  const auto geometry = std::make_shared<Geometry>();
  geometry_ = geometry;
  std::vector<glm::dvec3>& vertices = geometry->vertices;
  vertices.reserve(scene.positions.size());
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  if (rays_.start_at_light()) low = high = glm::dvec3(0);  // the light is part of what its rays' rounding spans
  for (const glm::vec3& position : scene.positions) {
    const glm::dvec3 p = frame.to_light(position);
    vertices.push_back(p);
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double size = glm::length(high - low);
  ray_error_m_ = 0x1p-24 * (std::sqrt(3.0) * largest_coordinate(scene) + 4 * size);
  // A margin for the rounding of the start, so that nothing is behind it.
  start_ = frame.to_world({0, 0, low.z - 0.01 * size - 4 * ray_error_m_});

  vertices_ = vertices.data();
  geometry->planes.reserve(scene.triangles.size());
  planes_ = geometry->planes.data();
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2), e = b - a, f = c - a;
    const glm::dvec3 n = glm::cross(e, f);
    Plane& plane = geometry->planes.emplace_back();
    plane.normal = rays_.facing_away(n, a) < 0 ? -n : n;
    plane.gradient = glm::dvec2(e.z * f.y - f.z * e.y, f.z * e.x - e.z * f.x) / (e.x * f.y - e.y * f.x);
    plane.slope = glm::length(plane.gradient);
    const double depths[3] = {frame.depth_m(a), frame.depth_m(b), frame.depth_m(c)};
    plane.low = *std::min_element(depths, depths + 3);
    plane.high = *std::max_element(depths, depths + 3);
    in_a_face_ |= rays_.start_at_light() && edge_on(t);
    if (frame.tile_at(a).depth != TileDepth::distance) continue;
    // No nearer than its plane, nor than a corner less the longest side.
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    const double length = glm::length(n);
    plane.low = std::max(plane.low - longest, length > 0 ? std::abs(glm::dot(n, a)) / length : 0.0);
  }
}

void LightView::window_depths(uint32_t triangle, glm::ivec2 first, int count, float* depths) const {
  // Copies, which no write to depths can change: so the compiler takes the tile's and the light's kinds out of the loop.
  const MapTile tile = only_tile_.value();
  const Plane plane = planes_[triangle];
  const LightRays rays = rays_;
  const glm::dvec3 at_corner = corner(triangle, 0);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 place = tile.place_of({first.x + i, first.y});
    const double depth = plane.within(rays.plane_depth(plane.normal, plane.gradient, at_corner, place));
    depths[i] = stored(tile.window_depth(depth));
  }
}

bool LightView::same_light(const LightFrame& frame) const {
  return frame.kind == frame_.kind && frame.origin_m == frame_.origin_m && frame.right == frame_.right &&
         frame.up == frame_.up && frame.forward == frame_.forward && frame.ray_direction == frame_.ray_direction;
}

LightView LightView::with_map_of(const LightFrame& frame) const {
  if (!same_light(frame)) throw std::logic_error("a map of another light than the one that the scene was seen by");
  LightView view = *this;
  view.frame_ = frame;
  view.only_tile_ = tile_of_flat(frame);
  return view;
}

double LightView::width(uint32_t triangle) const {
  const glm::dvec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  return glm::length(glm::cross(b - a, c - a)) / longest;
}

double LightView::corner_rounding_m(uint32_t triangle, int i) const {
  return glm::length(vertex_rounding_m(scene_->positions[scene_->triangles[triangle][i]]));
}

bool LightView::touches(uint32_t triangle, glm::dvec3 point, double moved_m) const {
  const glm::dvec3 normal = planes_[triangle].normal;
  const double distance = std::abs(glm::dot(normal, point - corner(triangle, 0))) / glm::length(normal);
  return distance <= moved_m + plane_rounding_m(*scene_, triangle, frame_.to_world(point));
}

glm::dvec3 LightView::at_depth(glm::dvec3 x, double depth) const { return rays_.at_depth(x, depth); }

LightRay LightView::ray_from(glm::dvec3 x, double depth) const {
  const glm::vec3 origin(frame_.to_world(at_depth(x, depth)));
  if (rays_.have_one_direction()) return {origin, frame_.ray_direction};
  return {origin, glm::vec3(glm::normalize(frame_.to_world(x) - frame_.origin_m))};
}

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

}  // namespace noonmark
