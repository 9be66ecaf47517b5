// A scene as its light sees it: every vertex in the light's frame, in double, and the plane of every triangle as a
// function of the place (technique/light_frame.h) that a light-side ray goes to. Depths are LightFrame::depth_m: metres
// along the axis, or the distance from a point light.
//
// Places in this folder are normalised: (u, v, 1) for a directional light, (x / z, y / z, 1) for a spot light, a unit
// vector for a point light. The straight way from one place to another is the line, or the arc, that the light sees
// between them.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "raytrace/embree_scene.h"
#include "scenes/scene.h"
#include "technique/light_frame.h"

namespace noonmark {

class LightView {
 public:
  LightView(const Scene& scene, const LightFrame& frame);

  // Another map of the same light: what was computed of the scene is shared.
  bool same_light(const LightFrame& frame) const;
  LightView with_map_of(const LightFrame& frame) const;

  glm::dvec3 corner(uint32_t triangle, int i) const { return vertices_[scene_->triangles[triangle][i]]; }

  // The distance by which rounding may have moved the corner.
  double corner_rounding_m(uint32_t triangle, int i) const;

  glm::dvec3 normal_place(glm::dvec3 place) const { return frame_.light().normal_place(place); }
  glm::dvec3 place_of(glm::dvec3 light) const { return normal_place(frame_.place(light)); }
  glm::dvec3 texel_place(glm::ivec2 texel) const {
    // The places of a flat map's texels are normalised already.
    return only_tile_ ? only_tile_->place_of(texel) : normal_place(frame_.texel_place(texel));
  }
  double orientation(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b) const { return rays_.orientation(p, a, b); }
  double orientation(uint32_t triangle) const {
    return orientation(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
  }

  // Whether the light sees the triangle from the side. Such a triangle covers nothing, and no surface continues over it.
  bool edge_on(uint32_t triangle) const { return rays_.edge_on(planes_[triangle].normal, corner(triangle, 0)); }

  // The triangle's normal in the light's frame, away from the light; not of unit length.
  glm::dvec3 normal_away(uint32_t triangle) const { return planes_[triangle].normal; }

  // How much deeper its plane becomes for a metre across the light's ray through x; not finite when it is edge-on.
  double slope(uint32_t triangle, glm::dvec3 x) const {
    return rays_.slope(planes_[triangle].normal, planes_[triangle].slope, x);
  }

  // How wide the triangle is at its narrowest, in metres.
  double width(uint32_t triangle) const;

  // Parallel rays: how much deeper its plane becomes for a metre along u and along v; not finite when it is edge-on.
  glm::dvec2 gradient(uint32_t triangle) const { return planes_[triangle].gradient; }

  // LightRays::nearness of its plane.
  glm::dvec3 nearness(uint32_t triangle) const {
    return rays_.nearness(planes_[triangle].normal, planes_[triangle].gradient, corner(triangle, 0));
  }

  // Depth of the triangle's plane at x, also beyond the triangle; infinity if the ray does not meet the plane.
  double plane_depth(uint32_t triangle, glm::dvec3 x) const {
    return rays_.plane_depth(planes_[triangle].normal, planes_[triangle].gradient, corner(triangle, 0), x);
  }

  // Depth at which the light ray through x meets the triangle. A ray that hits the triangle in Embree's float
  // arithmetic may miss it in double; the depth is clamped to the triangle's own range.
  double hit_depth(uint32_t triangle, glm::dvec3 x) const { return planes_[triangle].within(plane_depth(triangle, x)); }
  // The window depths of hit_depth() at the centres of `count` texels of a map with one tile, from `first` on along its row.
  // The same arithmetic for each, as one loop without branches.
  void window_depths(uint32_t triangle, glm::ivec2 first, int count, float* depths) const;

  // Metres across the light's rays for a step of 1 between normal places, at this depth.
  double metres_across(double depth_m) const { return rays_.metres_across(depth_m); }

  // Of a place on one side of all three edges: whether its ray meets the triangle before the light, not behind it.
  // left: the place lies to the left of the edges as the light sees them.
  bool ahead(uint32_t triangle, bool left) const { return rays_.ahead(left, orientation(triangle) > 0); }

  // Whether a point of the light's frame may lie in the triangle's plane, if rounding has moved it by up to moved_m.
  bool touches(uint32_t triangle, glm::dvec3 point, double moved_m) const;

  // The light-side ray through x. It starts before everything in the scene, or at the light itself.
  LightRay ray(glm::dvec3 x) const {
    if (rays_.start_at_light()) return ray_from(x, 0);
    return {glm::vec3(start_ + x.x * frame_.right + x.y * frame_.up), frame_.ray_direction};
  }
  LightRay ray_from(glm::dvec3 x, double depth) const;

  // The triangles that the rays through these places meet first, or no_primitive; count: 1 ... 16. A face whose plane
  // contains the light (the ceiling of a lamp) is edge-on: every ray starts in it, and none meets it.
  void first_hits(const EmbreeScene& embree, int count, const glm::dvec3* x, uint32_t* hits) const;

  // Depth at which the map's near plane cuts the ray through x.
  double near_depth(glm::dvec3 x) const {
    return only_tile_ ? only_tile_->near_depth(x) : frame_.tile_at(x).near_depth(x);
  }

  // MapTile::window_depth of the tile that a lookup at this place reads.
  double window_depth(double depth_m, glm::dvec3 x) const {
    return only_tile_ ? only_tile_->window_depth(depth_m) : frame_.tile_at(x).window_depth(depth_m);
  }
  // What a depth map holds of it.
  static float stored(double window_depth) { return static_cast<float>(std::clamp(window_depth, 0.0, 1.0)); }

  // Whether this first hit at x, or no_primitive, lies before the map's near plane.
  bool clipped(uint32_t hit, glm::dvec3 x) const {
    if (hit == no_primitive) return false;
    const double near = near_depth(x);
    return nearest_m(hit) < near && hit_depth(hit, x) < near;  // hit_depth is at least nearest_m
  }

  // No point of the triangle has less depth.
  double nearest_m(uint32_t triangle) const { return planes_[triangle].low; }

  // The float error of a light-side ray: how far it may pass beside its exact place, in metres. It comes from the
  // rounding of the ray's float origin and direction and of Embree's edge tests over the scene's size (4 roundings of
  // 2^-24).
  double ray_error_m() const { return ray_error_m_; }

  // How far the start of a receiver's ray is moved to find out whether R1 is sure: the float error, and the distance by
  // which the border of a cut mask may be off. The start is moved along two axes across the ray. A border at the distance
  // d in any direction crosses one of these axes within sqrt(2) d; hence the factor.
  double start_error_m() const { return ray_error_m_ + std::numbers::sqrt2 * scene_->mask_error_m; }

  const Scene& scene() const { return *scene_; }
  const LightFrame& frame() const { return frame_; }
  LightRays rays() const { return rays_; }

  glm::dvec3 at_depth(glm::dvec3 x, double depth) const;  // in the light's frame

 private:
  struct Plane {  // of each triangle
    glm::dvec3 normal{0};
    double low = 0, high = 0;  // the triangle's range of depths
    glm::dvec2 gradient{0};    // parallel rays: dz/d(u, v); not finite when it is edge-on
    double slope = 0;          // and its length
    double within(double depth) const { return std::isnan(depth) ? low : std::clamp(depth, low, high); }
  };
  struct Geometry {
    std::vector<glm::dvec3> vertices;
    std::vector<Plane> planes;
  };

  const Scene* scene_;
  LightFrame frame_;
  LightRays rays_;
  std::optional<MapTile> only_tile_;  // of a map with one tile
  std::shared_ptr<const Geometry> geometry_;
  const glm::dvec3* vertices_ = nullptr;  // of geometry_
  const Plane* planes_ = nullptr;
  bool in_a_face_ = false;  // the light stands in the plane of a triangle
  glm::dvec3 start_{0};     // directional: where the ray through (0, 0) starts, in the world
  double ray_error_m_ = 0;
};

}  // namespace noonmark
