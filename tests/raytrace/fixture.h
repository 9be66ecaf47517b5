// Shared by the ray-tracing tests: random receivers on a scene's surfaces, and a second computation of every hit that
// has nothing in common with Embree: triangles are projected into the light's plane, in double, and kept in square
// bins.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "raytrace/tracer.h"
#include "scenes/library.h"
#include "scenes/receivers.h"
#include "scenes/shapes.h"
#include "technique/light_frame.h"
#include "tests/support/source_dir.h"

namespace noonmark::test {

// Whether float error can change neither the receiver's truth nor that of any of its taps.
inline bool is_sure(const ReceiverTruth& truth, const TapTruth& taps, size_t i) {
  const auto first = taps.taps.begin() + static_cast<std::ptrdiff_t>(i) * taps.taps_per_receiver;
  return !truth.ambiguous[i] &&
         std::none_of(first, first + taps.taps_per_receiver, [](uint8_t bits) { return (bits & tap_unsure) != 0; });
}

// Two depths that differ by less than this (as a fraction of the scene's size) count as equal: some hundred roundings
// of 2^-53, for the planes of triangles that are steep but not edge-on.
inline constexpr double double_rounding = 1e-13;

class LightBins {
 public:
  struct Hit {
    uint32_t triangle = no_primitive;
    double z = std::numeric_limits<double>::infinity();  // metres along the light
  };

  LightBins(const Scene& scene, const LightFrame& frame, int bins = 256) : frame_(frame), bins_(bins) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::uvec3 t : scene.triangles) {
      Corners c;
      for (int i = 0; i < 3; ++i) {
        c[i] = frame.to_light(scene.positions[t[i]]);
        low = glm::min(low, c[i]);
        high = glm::max(high, c[i]);
      }
      corners_.push_back(c);
    }
    low_ = low;
    size_m_ = glm::length(high - low);
    cell_ = std::max(high.x - low.x, high.y - low.y) * 1.001 / bins;
    lists_.resize(static_cast<size_t>(bins) * static_cast<size_t>(bins));
    for (uint32_t t = 0; t < corners_.size(); ++t) {
      const Corners& c = corners_[t];
      const glm::ivec2 first = cell(glm::min(glm::min(c[0], c[1]), c[2])),
                       last = cell(glm::max(glm::max(c[0], c[1]), c[2]));
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) lists_[static_cast<size_t>(y * bins_ + x)].push_back(t);
    }
  }

  // Calls visit(triangle, z) for every triangle that covers x, its outline included. Edge-on triangles cover nothing.
  void each_at(glm::dvec2 x, const std::function<void(uint32_t, double)>& visit) const {
    const glm::dvec2 at = (x - glm::dvec2(low_)) / cell_;
    if (!(at.x >= 0 && at.y >= 0 && at.x < bins_ && at.y < bins_)) return;
    for (uint32_t t : lists_[static_cast<size_t>(static_cast<int>(at.y) * bins_ + static_cast<int>(at.x))]) {
      double area[3], sum = 0;
      const Corners& c = corners_[t];
      for (int i = 0; i < 3; ++i)
        sum += area[i] = cross(glm::dvec2(c[(i + 1) % 3]) - x, glm::dvec2(c[(i + 2) % 3]) - x);
      if (sum == 0) continue;
      if (sum < 0 ? area[0] > 0 || area[1] > 0 || area[2] > 0 : area[0] < 0 || area[1] < 0 || area[2] < 0) continue;
      visit(t, plane(t, x));
    }
  }

  // The hit at x that is nearest to the light, from depth z_from on, among the triangles for which `kept` is true.
  Hit first_hit(glm::dvec2 x, double z_from = -std::numeric_limits<double>::infinity(),
                const std::function<bool(uint32_t)>& kept = nullptr) const {
    Hit hit;
    each_at(x, [&](uint32_t t, double z) {
      if (z >= z_from && z < hit.z && (!kept || kept(t))) hit = {t, z};
    });
    return hit;
  }

  // Depth of the triangle's plane at x, also beyond the triangle.
  double plane(uint32_t t, glm::dvec2 x) const {
    const Corners& c = corners_[t];
    const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    return c[0].z - (n.x * (x.x - c[0].x) + n.y * (x.y - c[0].y)) / n.z;
  }

  // Whether there is another triangle between the light and the plane of `own` at p. within_m: a face whose plane
  // passes p within this distance does not count, because the rounding of its vertices may have separated it from p's
  // own plane.
  bool occluded(glm::dvec3 p, uint32_t own, double within_m = 0) const {
    const glm::dvec2 x = glm::dvec2(frame_.to_light(p));
    const double z_own = plane(own, x);
    bool dark = false;
    each_at(x, [&](uint32_t t, double z) {
      const glm::dvec3 n = glm::cross(corners_[t][1] - corners_[t][0], corners_[t][2] - corners_[t][0]);
      const double near = within_m * glm::length(n) / std::abs(n.z);
      dark |= t != own && z < z_own - rounding(t) - rounding(own) - near;
    });
    return dark;
  }

  // How far the depth of t's plane may be off: double's rounding, grown by the plane's slope against the light.
  double rounding(uint32_t t) const {
    const glm::dvec3 n = glm::cross(corners_[t][1] - corners_[t][0], corners_[t][2] - corners_[t][0]);
    return double_rounding * (size_m_ + glm::length(corners_[t][0])) * glm::length(n) / std::abs(n.z);
  }

  double size_m() const { return size_m_; }
  // > 0: the counter-clockwise side is towards the light.
  bool front(uint32_t t) const {
    const glm::dvec2 a(corners_[t][0]), b(corners_[t][1]), c(corners_[t][2]);
    return cross(b - a, c - a) > 0;
  }

 private:
  using Corners = std::array<glm::dvec3, 3>;
  static double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }
  glm::ivec2 cell(glm::dvec3 p) const {
    return glm::clamp(glm::ivec2(glm::floor((glm::dvec2(p) - glm::dvec2(low_)) / cell_)), glm::ivec2(0),
                      glm::ivec2(bins_ - 1));
  }

  LightFrame frame_;
  std::vector<Corners> corners_;
  std::vector<std::vector<uint32_t>> lists_;
  glm::dvec3 low_{0};
  double cell_ = 1, size_m_ = 0;
  int bins_;
};

struct Placed {
  glm::dvec3 p;
  uint32_t primitive;
};

// A receiver image one pixel high. facing_light: normals are turned to the light's side, as a viewer there sees them;
// otherwise they are those of the counter-clockwise side.
inline ReceiverImage receivers_at(const Scene& scene, const std::vector<Placed>& points, glm::dvec3 to_light,
                                  bool facing_light) {
  const int n = static_cast<int>(points.size());
  ReceiverImage out{Image<glm::vec3>(n, 1, glm::vec3(0)), Image<glm::vec3>(n, 1, glm::vec3(0)),
                    Image<uint32_t>(n, 1, no_primitive)};
  for (size_t i = 0; i < points.size(); ++i) {
    const glm::uvec3 t = scene.triangles[points[i].primitive];
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    out.position[i] = glm::vec3(points[i].p);
    out.normal[i] = glm::vec3(facing_light && glm::dot(normal, to_light) < 0 ? -normal : normal);
    out.primitive[i] = points[i].primitive;
  }
  return out;
}

// Random points, spread evenly over the area of the surfaces. facing_light: on all triangles that are not edge-on to
// the light; otherwise only on those whose counter-clockwise side faces it.
inline std::vector<Placed> points_on(const Scene& scene, glm::dvec3 to_light, bool facing_light, int count,
                                     uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<double> area_until;
  double sum = 0;
  for (const glm::uvec3 t : scene.triangles) {
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    if (facing_light ? glm::dot(cross, to_light) != 0 : glm::dot(cross, to_light) > 0) sum += glm::length(cross);
    area_until.push_back(sum);
  }
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Placed> points;
  while (static_cast<int>(points.size()) < count) {
    const auto found = std::upper_bound(area_until.begin(), area_until.end(), uniform(random) * sum);
    if (found == area_until.end()) continue;
    const uint32_t primitive = static_cast<uint32_t>(found - area_until.begin());
    const glm::uvec3 t = scene.triangles[primitive];
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back({a + u * (b - a) + v * (c - a), primitive});
  }
  return points;
}

inline ReceiverImage random_receivers(const Scene& scene, glm::dvec3 to_light, bool facing_light, int count,
                                      uint32_t seed) {
  return receivers_at(scene, points_on(scene, to_light, facing_light, count, seed), to_light, facing_light);
}

// The probe that the lookup shader would give, computed in double.
inline LookupProbe probe_of(const ReceiverImage& receivers, const LightFrame& frame,
                            const FilterSettings& filter = {}) {
  const int width = receivers.width(), height = receivers.height();
  LookupProbe probe;
  probe.reference = Image<float>(width, height);
  probe.map_texels = Image<glm::vec2>(width, height, glm::vec2(0));
  probe.n_dot_l = Image<float>(width, height);
  probe.bias_unit = Image<float>(width, height, 1);
  probe.pattern = tap_pattern(filter);
  const size_t taps = static_cast<size_t>(probe.taps());
  if (frame.kind == LightKind::point) {
    probe.cube_resolution = frame.resolution;
    probe.cube_texel.resize(receivers.primitive.size() * taps);
  }
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    const glm::dvec3 p = frame.to_light(receivers.position[i]);
    probe.reference[i] = static_cast<float>(frame.window_depth(p));
    probe.n_dot_l[i] =
        static_cast<float>(glm::dot(glm::dvec3(receivers.normal[i]), frame.direction_to_light(receivers.position[i])));
    if (frame.kind != LightKind::point) {
      // The float is kept in the same texel as the exact place, so that this rounding affects no test.
      const glm::dvec2 at = frame.map_texels(frame.place(p));
      for (int axis = 0; axis < 2; ++axis) {
        float& rounded = probe.map_texels[i][axis] = static_cast<float>(at[axis]);
        const float lowest = static_cast<float>(std::floor(at[axis]));
        rounded = std::clamp(rounded, lowest, std::nextafter(lowest + 1, lowest));
      }
      continue;
    }
    for (size_t t = 0; t < taps; ++t) {
      const glm::ivec2 at(glm::floor(frame.map_texels(frame.tap_place(p, probe.offset(i, static_cast<int>(t))))));
      probe.cube_texel[i * taps + t] = static_cast<uint32_t>(at.y * frame.resolution + at.x);
    }
  }
  return probe;
}

// A sun with a size, for R0.
inline raytrace::SoftTruth sun(double diameter_deg, double standard_error = 0.01) {
  raytrace::SoftTruth soft;
  soft.light.angular_diameter_deg = diameter_deg;
  soft.standard_error = standard_error;
  return soft;
}

// A box of size x size nearest taps.
inline FilterSettings box(int size) {
  FilterSettings filter;
  filter.kind = "box";
  filter["size"] = size;
  return filter;
}

inline Scene builtin(const std::string& name) {
  SceneSettings settings;
  settings.name = name;
  return make_scene(settings);
}

inline LightFrame frame_of(const Scene& scene, int resolution = 64) {
  Settings settings;
  settings.map.resolution = resolution;
  return make_light_frame(scene, settings);
}

// The scene moved; its new positions are rounded to float.
inline Scene moved(Scene scene, glm::dvec3 by) {
  for (glm::vec3& p : scene.positions) p = glm::vec3(glm::dvec3(p) + by);
  scene.light.position_m += by;
  scene.light.target_m += by;
  return scene;
}

inline std::string shared_model(const std::string& name) {
  return noonmark::test::source_dir() + "/../shared/scenes/" + name + "/" + name + ".gltf";
}

// A light straight above, 10 m up: u and v are x and -z (or its turn), depth is 10 - y.
inline void light_from_above(Scene& scene) { scene.light = {.position_m = {0, 10, 0}, .target_m = {0, 0, 0}}; }

}  // namespace noonmark::test
