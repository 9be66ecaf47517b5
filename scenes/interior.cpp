#include "scenes/interior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scenes/camera_frame.h"
#include "scenes/image.h"

namespace noonmark {
namespace {

constexpr int side_rays = 64;         // along each edge of a side
constexpr double backs_share = 0.75;  // of what is met: windows and doors leave the rest
constexpr double box_share = 0.95;    // of the rays
constexpr double hull_depth = 0.05;   // of the box: as thick as a hull is taken to be
constexpr double room_fov_deg = 75;   // of the camera inside
constexpr int sample_rays = 32;       // along each edge of the pictures that places are judged by
constexpr float nothing = std::numeric_limits<float>::infinity();

struct Hits {
  Image<float> depth;  // along the view; infinite where nothing is met
  Image<uint8_t> back, single_sided;
};

// What the rays of a small picture meet first: a z-buffer in which every triangle is asked at each pixel of its bounds.
Hits first_hits(const Scene& scene, const CameraFrame& frame, int rays, bool through_single_sided_backs) {
  const bool perspective = frame.camera.projection == Projection::perspective;
  Hits hits{Image<float>(rays, rays, nothing), Image<uint8_t>(rays, rays), Image<uint8_t>(rays, rays)};
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::uvec3& t = scene.triangles[i];
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const bool back = glm::dot(normal, perspective ? a - frame.eye_m : frame.forward) > 0;
    const bool single_sided = !scene.single_sided.empty() && scene.single_sided[i];
    if (back && single_sided && through_single_sided_backs) continue;
    glm::dvec2 low(rays), high(-1);
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const glm::dvec3& corner : {a, b, c}) {
      const glm::dvec3 way = corner - frame.eye_m;
      const double z = glm::dot(way, frame.forward), w = perspective ? z : 1;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
      const glm::dvec2 pixel = 0.5 * rays *
                               glm::dvec2(1 + glm::dot(way, frame.right) / (w * frame.half_width),
                                          1 - glm::dot(way, frame.up) / (w * frame.half_height));
      low = glm::min(low, pixel);
      high = glm::max(high, pixel);
    }
    if (!(farthest > 0)) continue;
    if (perspective && !(nearest > 1e-6 * farthest)) {  // it crosses the eye's plane: its bounds may be anywhere
      low = glm::dvec2(0);
      high = glm::dvec2(rays);
    }
    const glm::ivec2 from = glm::clamp(glm::floor(low), 0.0, static_cast<double>(rays));
    const glm::ivec2 to = glm::clamp(glm::ceil(high), 0.0, static_cast<double>(rays));
    for (int y = from.y; y < to.y; ++y) {
      for (int x = from.x; x < to.x; ++x) {
        const Ray ray = frame.pixel_ray(x, y, rays, rays);
        const double slope = glm::dot(normal, ray.direction);
        const double along = glm::dot(normal, a - ray.origin) / slope;  // the direction's part along the view is 1
        if (!(along > 0) || !(along < static_cast<double>(hits.depth.at(x, y)))) continue;
        const glm::dvec3 p = ray.origin + along * ray.direction;
        const auto left_of = [&](const glm::dvec3& q, const glm::dvec3& r) {
          return glm::dot(glm::cross(r - q, p - q), normal) >= 0;
        };
        if (!left_of(a, b) || !left_of(b, c) || !left_of(c, a)) continue;
        hits.depth.at(x, y) = static_cast<float>(along);
        hits.back.at(x, y) = back;
        hits.single_sided.at(x, y) = single_sided;
      }
    }
  }
  return hits;
}

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  glm::dvec3 half() const { return 0.5 * (high - low); }
};

// The hull as seen from one side of the box, whose face is the eye's plane.
struct Side {
  CameraFrame frame;
  double extent_m = 0;  // of the box along the view
  Hits hits;

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
  side.hits = first_hits(scene, side.frame, side_rays, false);
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
      if (side.hits.depth[i] == nothing) continue;
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
  Hits hits = first_hits(scene, make_camera_frame(camera, sample_rays, sample_rays), sample_rays, true);
  std::vector<float>& depths = hits.depth.pixels;
  std::replace(depths.begin(), depths.end(), nothing, 0.0f);
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
