#include "scenes/interior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scenes/camera_frame.h"
#include "scenes/first_hits.h"

namespace noonmark {
namespace {

constexpr int side_rays = 64;         // along each edge of a side
constexpr double backs_share = 0.75;  // of what is met: windows and doors leave the rest
constexpr double box_share = 0.95;    // of the rays
constexpr double hull_depth = 0.05;   // of the box: as thick as a hull is taken to be
constexpr double room_fov_deg = 75;   // of the camera inside
constexpr int sample_rays = 32;       // along each edge of the pictures that places are judged by

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  glm::dvec3 half() const { return 0.5 * (high - low); }
};

// The hull as seen from one side of the box, whose face is the eye's plane.
struct Side {
  CameraFrame frame;
  double extent_m = 0;  // of the box along the view
  FirstHits hits;

  // How deep p lies behind what is met first, as a share of the box.
  double depth_behind(const glm::dvec3& p) const {
    const glm::dvec3 way = p - frame.eye_m;
    const double u = 0.5 * (1 + glm::dot(way, frame.right) / frame.half_width),
                 v = 0.5 * (1 - glm::dot(way, frame.up) / frame.half_height);
    const auto pixel = [](double share) { return std::clamp(static_cast<int>(share * side_rays), 0, side_rays - 1); };
    return (glm::dot(way, frame.forward) - static_cast<double>(hits.depth.at(pixel(u), pixel(v)))) / extent_m;
  }
};
using Hull = std::array<Side, 6>;

Side look_from(const Scene& scene, const Box& box, int face) {
  Side side;
  const int axis = face / 2, other = (axis + 1) % 3, third = (axis + 2) % 3;
  const double sign = face % 2 == 0 ? 1 : -1;
  side.frame.camera.projection = Projection::orthographic;
  side.frame.eye_m = box.middle();
  side.frame.eye_m[axis] += sign * box.half()[axis];
  side.frame.forward = side.frame.right = side.frame.up = glm::dvec3(0);
  side.frame.forward[axis] = -sign;
  side.frame.up[third] = 1;
  side.frame.right[other] = sign;  // forward = cross(up, right)
  side.frame.half_width = box.half()[other];
  side.frame.half_height = box.half()[third];
  side.extent_m = 2 * box.half()[axis];
  // The eye's plane holds the hull's own face: from just before it.
  side.frame.eye_m[axis] += sign * 1e-3 * side.extent_m;
  side.hits = first_hits(scene, side.frame, side_rays, Backs::seen);
  return side;
}

bool inside(const Hull& hull, const glm::dvec3& p) {
  return std::all_of(hull.begin(), hull.end(), [&](const Side& side) { return side.depth_behind(p) > hull_depth; });
}

bool has_contents(const Scene& scene, const Hull& hull) {
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const glm::uvec3& t) {
    return inside(
        hull,
        (glm::dvec3(scene.positions[t.x]) + glm::dvec3(scene.positions[t.y]) + glm::dvec3(scene.positions[t.z])) / 3.0);
  });
}

// The six sides, where they make a closed room.
std::optional<Hull> hull_of_room(const Scene& scene, const Box& box) {
  Hull hull;
  bool backs = true, boxed = true, single_sided = true;
  for (int face = 0; face < 6; ++face) {
    Side& side = hull[static_cast<size_t>(face)];
    side = look_from(scene, box, face);
    int met = 0, met_back = 0, met_at_face = 0;
    for (size_t i = 0; i < side.hits.depth.size(); ++i) {
      if (side.hits.depth[i] == FirstHits::nothing) continue;
      ++met;
      met_back += side.hits.back[i];
      single_sided = single_sided && (!side.hits.back[i] || side.hits.single_sided[i]);
      met_at_face += static_cast<double>(side.hits.depth[i]) <= hull_depth * side.extent_m;
    }
    backs = backs && 2 * met >= side_rays * side_rays && met_back >= backs_share * met;
    boxed = boxed && met_at_face >= box_share * side_rays * side_rays;
    if (!backs && !boxed) return std::nullopt;
  }
  if (!(backs && single_sided) && !has_contents(scene, hull)) return std::nullopt;
  return hull;
}

// How far one sees from there: the median over the picture, where nothing is 0.
double view_depth(const Scene& scene, const Camera& camera) {
  FirstHits hits =
      first_hits(scene, make_camera_frame(camera, sample_rays, sample_rays), sample_rays, Backs::seen_of_double_sided);
  std::vector<float>& depths = hits.depth.pixels;
  std::replace(depths.begin(), depths.end(), FirstHits::nothing, 0.0f);
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

}  // namespace

std::optional<Camera> camera_inside(const Scene& scene) {
  Box box;
  for (const glm::vec3& p : scene.positions) {
    box.low = glm::min(box.low, glm::dvec3(p));
    box.high = glm::max(box.high, glm::dvec3(p));
  }
  const glm::dvec3 half = box.half(), middle = box.middle();
  const double least = std::min({half.x, half.y, half.z}), most = std::max({half.x, half.y, half.z});
  if (!(least > 1e-3 * most)) return std::nullopt;  // flat, or empty: nothing has room inside
  const std::optional<Hull> hull = hull_of_room(scene, box);
  if (!hull) return std::nullopt;

  // In each corner, at eye level, as far out as the hull allows.
  std::optional<Camera> best;
  double best_depth = 0;
  for (const glm::dvec2 corner : {glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(1, -1), glm::dvec2(-1, -1)}) {
    for (double out : {0.85, 0.7, 0.55, 0.4, 0.25}) {
      Camera camera;
      camera.eye_m = middle + half * glm::dvec3(out * corner.x, 0.2, out * corner.y);
      if (!inside(*hull, camera.eye_m)) continue;
      camera.target_m = middle - half * glm::dvec3(0, 0.1, 0);
      camera.fov_y_deg = room_fov_deg;
      if (const double depth = view_depth(scene, camera); depth > best_depth) {
        best = camera;
        best_depth = depth;
      }
      break;
    }
  }
  return best;
}

}  // namespace noonmark
