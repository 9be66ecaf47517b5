#include "technique/map_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scenes/camera_fit.h"
#include "scenes/view_clip.h"
#include "technique/lights/shared.h"

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

std::array<glm::dvec4, 6> frustum_planes(const CameraFrame& frame) {
  const std::array<glm::dvec4, 4> sides = side_planes(frame, 0);
  return {sides[0],
          sides[1],
          sides[2],
          sides[3],
          glm::dvec4(0, 0, 1, -*frame.camera.near_m),
          glm::dvec4(0, 0, -1, *frame.camera.far_m)};
}

// The part in view, in the light's axes. A corner that clipping made is kept inside its triangle's box, which rounding
// could leave: so the fit is never larger than that of the whole scene.
Box part_in_view(const Scene& scene, const CameraFrame& camera, const LightFrame& axes) {
  const std::array<glm::dvec4, 6> planes = frustum_planes(camera);
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

// Of the scene inside a square of the light's plane.
Depths depths_inside(const Scene& scene, const LightFrame& axes, glm::dvec2 middle, double half) {
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

std::optional<FittedMap> fit_to_view(const Scene& scene, const ViewSettings& view, const LightFrame& axes) {
  const CameraFrame camera = make_camera_frame(effective_camera(scene, view), view.width_px, view.height_px);
  const Box part = part_in_view(scene, camera, axes);
  if (!(part.low.x <= part.high.x)) return std::nullopt;
  const glm::dvec3 size = part.high - part.low;
  const double reach = 0.5 * std::max(size.x, size.y);
  const double half = reach * (1 + lights::map_margin);
  const glm::dvec2 middle = 0.5 * (glm::dvec2(part.low) + glm::dvec2(part.high));
  const double near_m = std::min(depths_inside(scene, axes, middle, half).least, part.low.z);
  return FittedMap{lights::with_margin(reach, near_m, part.high.z), middle};
}

namespace {

double diagonal_of(const Scene& scene) {
  Box box;
  for (const glm::vec3& p : scene.positions) box.add(p);
  return scene.positions.empty() ? 1 : glm::length(box.high - box.low);
}

struct Sphere {
  double along = 0;  // of its middle, from the eye
  double radius = 0;
};

// The least sphere of the frustum from the eye to `reach`.
Sphere sphere_of_frustum(const CameraFrame& camera, double reach) {
  const double k2 = camera.half_width * camera.half_width + camera.half_height * camera.half_height;
  if (camera.camera.projection != Projection::perspective) return {reach / 2, std::sqrt(k2 + reach * reach / 4)};
  if (k2 >= 1) return {reach, std::sqrt(k2) * reach};
  const double along = reach * (1 + k2) / 2;
  return {along, along};  // through the eye and the four far corners
}

}  // namespace

FittedMap fit_to_sphere(const Scene& scene, const ViewSettings& view, const MapSettings& map, const LightFrame& axes) {
  const CameraFrame camera = make_camera_frame(effective_camera(scene, view), view.width_px, view.height_px);
  const Sphere sphere = sphere_of_frustum(camera, map.reach_m.value_or(diagonal_of(scene)));
  const double texels = map.resolution;
  const double reach = sphere.radius * texels / std::max(texels - 1, 1.0);
  const glm::dvec3 middle = axes.to_light(camera.eye_m + sphere.along * camera.forward);
  const double near_m =
      std::min(depths_inside(scene, axes, middle, reach * (1 + lights::map_margin)).least, middle.z - sphere.radius);
  return {lights::with_margin(reach, near_m, middle.z + sphere.radius), middle};
}

namespace {

// Proves that nothing of a scene lies behind a triangle, as the light sees it.
class Behind {
 public:
  Behind(const Scene& scene, glm::dvec3 forward) : scene_(scene), forward_(forward) {
    float largest = 0;
    for (const glm::vec3& p : scene.positions)
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // Each of the plane's points and the point itself is a float, so each is off by half a last place of its coordinates.
    rounding_m_ = 4 * 0x1p-24 * static_cast<double>(largest);
  }

  bool nothing(const glm::uvec3& triangle) {
    const glm::dvec3 a = scene_.positions[triangle.x];
    const glm::dvec3 across =
        glm::cross(glm::dvec3(scene_.positions[triangle.y]) - a, glm::dvec3(scene_.positions[triangle.z]) - a);
    const double length = glm::length(across);
    if (!(length > 0)) return true;  // without an area
    const double along = glm::dot(across, forward_);
    if (along == 0) return false;
    const Plane plane{across * ((along < 0 ? 1 : -1) / length), a};
    for (const Plane& known : proven_)
      if (holds(known, triangle)) return true;
    if (!in_front(plane)) return false;
    proven_.push_back(plane);
    return true;
  }

 private:
  struct Plane {
    glm::dvec3 to_light;  // unit normal on the light's side
    glm::dvec3 point;
    double height(glm::dvec3 p) const { return glm::dot(to_light, p - point); }
  };

  bool holds(const Plane& plane, const glm::uvec3& triangle) const {
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(plane.height(glm::dvec3(scene_.positions[triangle[i]]))) <= rounding_m_)) return false;
    return true;
  }

  // The vertex that lay behind the plane before is asked first: it decides most triangles.
  bool in_front(const Plane& plane) {
    const size_t count = scene_.positions.size();
    for (size_t i = 0; i < count; ++i) {
      const size_t vertex = (first_ + i) % count;
      if (questions_++ >= most_questions || plane.height(glm::dvec3(scene_.positions[vertex])) < -rounding_m_) {
        first_ = vertex;
        return false;
      }
    }
    return true;
  }

  // Some tenths of a second. A sheet that is hollow to the light asks every vertex for every triangle.
  static constexpr size_t most_questions = 100'000'000;
  const Scene& scene_;
  glm::dvec3 forward_;
  double rounding_m_ = 0;
  std::vector<Plane> proven_;
  size_t first_ = 0, questions_ = 0;
};

}  // namespace

std::optional<FittedMap> fit_to_casters(const Scene& scene, const LightFrame& axes) {
  Behind behind(scene, axes.forward);
  Box casters;
  for (const glm::uvec3& t : scene.triangles) {
    if (behind.nothing(t)) continue;
    for (const glm::dvec3& p : corners_of(scene, t, [&](glm::dvec3 q) { return axes.to_light(q); })) casters.add(p);
  }
  if (!(casters.low.x <= casters.high.x)) return std::nullopt;
  const glm::dvec2 size(casters.high - casters.low), middle = 0.5 * glm::dvec2(casters.low + casters.high);
  const double reach = 0.5 * std::max(size.x, size.y);
  const Depths depths = depths_inside(scene, axes, middle, reach * (1 + lights::map_margin));
  return FittedMap{lights::with_margin(reach, depths.least, depths.most), middle};
}

}  // namespace noonmark
