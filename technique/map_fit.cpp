#include "technique/map_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scenes/camera_fit.h"
#include "scenes/view_clip.h"
#include "technique/corner_fits.h"
#include "technique/lights/shared.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Box {
  glm::dvec3 low{infinity}, high{-infinity};
  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

using Corners = std::array<glm::dvec3, 3>;

template <class Map>
Corners corners_of(const Scene& scene, const glm::uvec3& triangle, const Map& map) {
  Corners corners;
  for (int i = 0; i < 3; ++i) corners[static_cast<size_t>(i)] = map(glm::dvec3(scene.positions[triangle[i]]));
  return corners;
}

Box box_of(const Corners& corners) {
  Box box;
  for (const glm::dvec3& p : corners) box.add(p);
  return box;
}

std::array<glm::dvec4, 6> frustum_planes(const CameraFrame& frame, const ViewSlice* slice) {
  const std::array<glm::dvec4, 4> sides = side_planes(frame, 0);
  double near_m = *frame.camera.near_m, far_m = *frame.camera.far_m;
  if (slice) near_m = std::max(near_m, slice->begin_m), far_m = std::min(far_m, slice->end_m);
  return {sides[0], sides[1], sides[2], sides[3], glm::dvec4(0, 0, 1, -near_m), glm::dvec4(0, 0, -1, far_m)};
}

// The part in view, in the light's axes. A corner that clipping made is kept inside its triangle's box, which rounding
// could leave: so the fit is never larger than that of the whole scene.
Box part_in_view(const Scene& scene, const CameraFrame& camera, const LightFrame& axes, const ViewSlice* slice) {
  const std::array<glm::dvec4, 6> planes = frustum_planes(camera, slice);
  Box part;
  for (const glm::uvec3& t : scene.triangles) {
    const auto in_view = clipped(planes, corners_of(scene, t, [&](glm::dvec3 p) { return camera.in_axes(p); }));
    if (in_view.count == 0) continue;
    const Box whole = box_of(corners_of(scene, t, [&](glm::dvec3 p) { return axes.to_light(p); }));
    for (size_t i = 0; i < in_view.count; ++i)
      part.add(glm::clamp(axes.to_light(camera.to_world(in_view.corners[i])), whole.low, whole.high));
  }
  return part;
}

struct Depths {
  double least = infinity, most = -infinity;
};

// Of the scene inside a rectangle of the light's plane.
Depths depths_inside(const Scene& scene, const LightFrame& axes, glm::dvec2 middle, glm::dvec2 half) {
  const glm::dvec2 low = middle - half, high = middle + half;
  const std::array<glm::dvec4, 4> sides = {
      {{1, 0, 0, -low.x}, {-1, 0, 0, high.x}, {0, 1, 0, -low.y}, {0, -1, 0, high.y}}};
  Depths depths;
  for (const glm::uvec3& t : scene.triangles) {
    const Corners corners = corners_of(scene, t, [&](glm::dvec3 p) { return axes.to_light(p); });
    const Box box = box_of(corners);
    if (box.low.z >= depths.least && box.high.z <= depths.most) continue;
    const Clipped<4> inside = clipped(sides, corners);
    for (size_t i = 0; i < inside.count; ++i) {
      depths.least = std::min(depths.least, inside.corners[i].z);
      depths.most = std::max(depths.most, inside.corners[i].z);
    }
  }
  return depths;
}

}  // namespace

std::optional<FittedMap> fit_to_view(const Scene& scene, const ViewSettings& view, const MapSettings& map,
                                     const LightFrame& axes, const ViewSlice* slice) {
  const CameraFrame camera = make_camera_frame(effective_camera(scene, view), view.width_px, view.height_px);
  const Box part = part_in_view(scene, camera, axes, slice);
  if (!(part.low.x <= part.high.x)) return std::nullopt;
  const glm::dvec3 size = part.high - part.low;
  const glm::dvec2 area = lights::area_around(0.5 * glm::dvec2(size), 0, map);
  const glm::dvec2 half = area * (1 + lights::map_margin);
  const glm::dvec2 middle = 0.5 * (glm::dvec2(part.low) + glm::dvec2(part.high));
  const double near_m = std::min(depths_inside(scene, axes, middle, half).least, part.low.z);
  return FittedMap{lights::with_margin(area, near_m, part.high.z), middle};
}

namespace {

double diagonal_of(const Scene& scene) {
  Box box;
  for (const glm::vec3& p : scene.positions) box.add(p);
  return scene.positions.empty() ? 1 : glm::length(box.high - box.low);
}

// The camera whose frustum is fitted to, where that must not depend on its zoom.
CameraFrame camera_to_fit(const Scene& scene, const Settings& settings) {
  const ViewSettings& view = settings.view;
  Camera camera = effective_camera(scene, view);
  camera.fov_y_deg = std::max(camera.fov_y_deg, settings.map.fit_fov_deg.value_or(0));
  return make_camera_frame(camera, view.width_px, view.height_px);
}

struct Sphere {
  double along = 0;  // of its middle, from the eye
  double radius = 0;
};

// The least sphere of the frustum from the depth `begin` to `end`: its middle lies on the axis where the near and the far
// corners are equally far, but never beyond the far rectangle, whose corners alone then touch it.
Sphere sphere_of_frustum(const CameraFrame& camera, double begin, double end) {
  const double k2 = camera.half_width * camera.half_width + camera.half_height * camera.half_height;
  if (camera.camera.projection != Projection::perspective) {
    const double half = (end - begin) / 2;
    return {begin + half, std::sqrt(k2 + half * half)};
  }
  if (begin == 0 ? k2 >= 1 : k2 * (end + begin) >= end - begin) return {end, std::sqrt(k2) * end};
  const double along = (end + begin) * (1 + k2) / 2;
  if (begin == 0) return {along, along};  // through the eye and the four far corners
  return {along, std::sqrt((end - along) * (end - along) + k2 * end * end)};
}

}  // namespace

FittedSphere sphere_of_slice(const Scene& scene, const Settings& settings, const ViewSlice& slice) {
  const CameraFrame camera = camera_to_fit(scene, settings);
  Sphere sphere = sphere_of_frustum(camera, slice.begin_m, slice.end_m);
  if (const double step = settings.cascades.radius_round_m; step > 0)
    sphere.radius = step * std::ceil(sphere.radius / step);
  return {camera.eye_m + sphere.along * camera.forward, sphere.radius};
}

FittedMap fit_to_sphere(const Scene& scene, const Settings& settings, const LightFrame& axes, const ViewSlice* slice) {
  const MapSettings& map = settings.map;
  const ViewSlice whole{0, slice ? 0 : map.reach_m.value_or(diagonal_of(scene))};
  const FittedSphere sphere = sphere_of_slice(scene, settings, slice ? *slice : whole);
  const glm::dvec2 area = lights::area_around(glm::dvec2(sphere.radius_m), texel_block(settings), map);
  const glm::dvec3 middle = axes.to_light(sphere.middle_m);
  const double near_m =
      std::min(depths_inside(scene, axes, middle, area * (1 + lights::map_margin)).least, middle.z - sphere.radius_m);
  return {lights::with_margin(area, near_m, middle.z + sphere.radius_m), middle};
}

namespace {

// Of the corners of the scene's box along the world's axes, by which engines know what there is.
Depths depths_of_box(const Scene& scene, const LightFrame& axes) {
  Box box;
  for (const glm::vec3& p : scene.positions) box.add(p);
  Depths depths;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high(corner & 1, corner & 2, corner & 4);
    const double depth = axes.to_light(glm::mix(box.low, box.high, high)).z;
    depths.least = std::min(depths.least, depth);
    depths.most = std::max(depths.most, depth);
  }
  return depths;
}

}  // namespace

FittedMap fit_to_corners(const Scene& scene, const Settings& settings, const LightFrame& axes, const ViewSlice* slice) {
  const CameraFrame camera = camera_to_fit(scene, settings);
  const ViewSlice whole{*camera.camera.near_m, settings.map.reach_m.value_or(*camera.camera.far_m)};
  const CornerSquare square =
      find_corner_fit(settings.map.fit)
          ->around(corners_of_slice(camera, slice ? *slice : whole, axes), settings.cascades.radius_round_m);
  const double half_m = square.half_m + (slice ? slice->wider_m / 2 : 0);
  const glm::dvec2 half = lights::area_around(glm::dvec2(half_m), 0, settings.map);
  const Depths all = depths_of_box(scene, axes);
  const double before = settings.map.keeps_clipped()
                            ? std::max(square.low_m, all.least)
                            : std::min(square.low_m, depths_inside(scene, axes, square.middle_m, half).least);
  double near_m = before, far_m = std::min(square.high_m, all.most);
  // The whole scene lies before the slice or beyond it, so there is nothing to hold: the slice itself gives near and far.
  if (!(near_m < far_m)) near_m = square.low_m, far_m = square.high_m;
  const MapVolume depths = lights::with_margin(half, near_m, far_m);
  return {{.extent_m = 2 * half.x, .near_m = depths.near_m, .far_m = depths.far_m, .height_m = 2 * half.y},
          square.middle_m};
}

namespace {

struct Plane {
  glm::dvec3 to_light;  // unit normal on the light's side
  glm::dvec3 point;     // a corner of the triangle
  // How far the rounding of the triangle's corners moves the plane: there, and more for each metre from there, because the
  // corners are near each other.
  double rounding_m = 0, rounding_per_m = 0;
  double height(glm::dvec3 p) const { return glm::dot(to_light, p - point); }
  double rounding_at(glm::dvec3 p) const { return rounding_m + rounding_per_m * glm::distance(p, point); }
};

// The vertices that lie furthest along the 26 ways to the corners, edges and faces of a cube: one of them decides for most
// triangles that something lies behind their plane.
std::vector<glm::dvec3> outermost(const Scene& scene) {
  std::vector<glm::dvec3> found;
  for (int n = 0; n < 27; ++n) {
    const glm::dvec3 way(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    double most = -infinity;
    glm::dvec3 vertex(0);
    for (const glm::vec3& p : scene.positions)
      if (const double along = glm::dot(glm::dvec3(p), way); along > most) most = along, vertex = glm::dvec3(p);
    if (n != 13) found.push_back(vertex);
  }
  return found;
}

// Asks whether something of a scene lies behind a triangle, as the light sees it.
class Behind {
 public:
  Behind(const Scene& scene, glm::dvec3 forward) : scene_(scene), forward_(forward), outermost_(outermost(scene)) {
    float largest = 0;
    for (const glm::vec3& p : scene.positions)
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // Each of the plane's points and the point itself is a float, so each is off by half a last place of its coordinates.
    rounding_m_ = 4 * 0x1p-24 * static_cast<double>(largest);
  }

  // Of a triangle without an area nothing; of one along the light's rays there may be.
  std::optional<Plane> plane_of(const glm::uvec3& triangle) const {
    const glm::dvec3 a = scene_.positions[triangle.x];
    const glm::dvec3 u = glm::dvec3(scene_.positions[triangle.y]) - a, v = glm::dvec3(scene_.positions[triangle.z]) - a;
    const glm::dvec3 across = glm::cross(u, v);
    const double area = glm::length(across);
    if (!(area > 0)) return std::nullopt;
    const double height = area / std::max({glm::length(u), glm::length(v), glm::distance(u, v)});
    return Plane{across * ((glm::dot(across, forward_) < 0 ? 1 : -1) / area), a, rounding_m_, 2 * rounding_m_ / height};
  }

  bool surely_something(const Plane& plane) const {
    return glm::dot(plane.to_light, forward_) == 0 ||
           std::any_of(outermost_.begin(), outermost_.end(), [&](const glm::dvec3& p) { return is_behind(plane, p); });
  }

  bool nothing(const Plane& plane, const glm::uvec3& triangle) {
    for (const Plane& known : proven_)
      if (lies_in(known, triangle)) return true;
    for (const glm::vec3& p : scene_.positions)
      if (questions_++ >= most_questions || is_behind(plane, glm::dvec3(p))) return false;
    proven_.push_back(plane);
    return true;
  }

 private:
  bool is_behind(const Plane& plane, glm::dvec3 p) const { return plane.height(p) < -plane.rounding_at(p); }
  bool lies_in(const Plane& plane, const glm::uvec3& triangle) const {
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 p(scene_.positions[triangle[i]]);
      if (!(std::abs(plane.height(p)) <= plane.rounding_at(p))) return false;
    }
    return true;
  }

  // Less than a tenth of a second. A sheet that is hollow to the light asks every vertex for every triangle.
  static constexpr size_t most_questions = 20'000'000;
  const Scene& scene_;
  glm::dvec3 forward_;
  std::vector<glm::dvec3> outermost_;
  double rounding_m_ = 0;
  std::vector<Plane> proven_;
  size_t questions_ = 0;
};

}  // namespace

std::optional<FittedMap> fit_to_casters(const Scene& scene, const Settings& settings, const LightFrame& axes) {
  const MapSettings& map = settings.map;
  Behind behind(scene, axes.forward);
  Box casters;
  const auto in_light = [&](const glm::uvec3& t) {
    return box_of(corners_of(scene, t, [&](glm::dvec3 q) { return axes.to_light(q); }));
  };
  const auto add = [&](const Box& box) { casters.add(box.low), casters.add(box.high); };
  std::vector<std::pair<glm::uvec3, Plane>> open;
  for (const glm::uvec3& t : scene.triangles) {
    const std::optional<Plane> plane = behind.plane_of(t);
    if (!plane) continue;
    if (behind.surely_something(*plane))
      add(in_light(t));
    else
      open.emplace_back(t, *plane);
  }
  // What lies within the others' box need not be asked.
  for (const auto& [t, plane] : open) {
    const Box box = in_light(t);
    const bool within = glm::all(glm::greaterThanEqual(glm::dvec2(box.low), glm::dvec2(casters.low))) &&
                        glm::all(glm::lessThanEqual(glm::dvec2(box.high), glm::dvec2(casters.high)));
    if (!within && !behind.nothing(plane, t)) add(box);
  }
  if (!(casters.low.x <= casters.high.x)) return std::nullopt;
  const glm::dvec2 size(casters.high - casters.low), middle = 0.5 * glm::dvec2(casters.low + casters.high);
  // A texel (of the mip level) more on each side: the grid's placements, shifts and snapping move the map by up to one.
  const glm::dvec2 area = lights::area_around(0.5 * size, 2 * texel_block(settings), map);
  const Depths depths = depths_inside(scene, axes, middle, area * (1 + lights::map_margin));
  return FittedMap{lights::with_margin(area, depths.least, depths.most), middle};
}

}  // namespace noonmark
