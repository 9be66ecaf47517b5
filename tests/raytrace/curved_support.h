// Shared by the tests of curved and creased receivers: shapes, a whole lookup judged tap by tap without OpenGL, and
// true shadow edges found from the triangles' outlines alone.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compare/ladder/receiver_taps.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::curved {

using test::LightBins;

inline constexpr double pi = std::numbers::pi;

inline glm::dvec3 ring(double radius, double turn, double y) {
  return {radius * std::sin(2 * pi * turn), y, radius * std::cos(2 * pi * turn)};
}

// A torus that lies flat: its axis is Y, and radius_m is the distance to the tube's middle. t wraps too: the last row
// repeats the positions of the first one exactly, so that the seam is welded.
inline void add_torus(Scene& scene, int columns, int rows, double radius_m, double tube_m) {
  add_surface(scene, "torus", columns, rows, true, [=](double s, double t) {
    const double turn = t == 1 ? 0 : t;
    return ring(radius_m + tube_m * std::cos(2 * pi * turn), s, tube_m * std::sin(2 * pi * turn));
  });
}

inline void add_sphere(Scene& scene, int columns, int rows, double radius_m, double centre_y) {
  add_surface(scene, "sphere", columns, rows, true, [=](double s, double t) {
    return ring(t == 0 || t == 1 ? 0 : radius_m * std::sin(pi * t), s, centre_y - radius_m * std::cos(pi * t));
  });
}

// y = height(x, z) over [-1, 1]^2: seen from above it hides nothing of itself, whatever its slopes.
inline void add_height_field(Scene& scene, int cells, const std::function<double(double, double)>& height) {
  add_surface(scene, "height field", cells, cells, false, [&](double s, double t) {
    const double x = 2 * t - 1, z = 2 * s - 1;
    return glm::dvec3(x, height(x, z), z);
  });
}

inline void add_floor(Scene& scene, double half_m) {
  add_quad(scene, "floor", {-half_m, 0, -half_m}, {0, 0, 2 * half_m}, {2 * half_m, 0, 0});
}

// Turns the scene and its light about the origin; the new positions are rounded to float.
inline void turn(Scene& scene, const glm::dmat3& by) {
  for (glm::vec3& p : scene.positions) p = glm::vec3(by * glm::dvec3(p));
  scene.light.position_m = by * scene.light.position_m;
  scene.light.target_m = by * scene.light.target_m;
}

// The light's frame with its grid shifted by a part of a texel and turned about the axis, wide enough to hold the
// scene.
inline LightFrame aligned(const Scene& scene, int resolution, std::mt19937& random) {
  LightFrame frame = test::frame_of(scene, resolution);
  std::uniform_real_distribution<double> unit(0, 1);
  const double angle = unit(random) * pi / 2;
  const glm::dvec3 right = frame.right, up = frame.up;
  frame.right = std::cos(angle) * right + std::sin(angle) * up;
  frame.up = std::cos(angle) * up - std::sin(angle) * right;
  frame.extent_m *= 1.6;  // sqrt(2) for the turn, and three texels of a kernel's reach
  frame.origin_m += frame.texel_m(glm::dvec3(0)) * (unit(random) * frame.right + unit(random) * frame.up);
  return frame;
}

// The taps of a lookup at some receivers, and the causes of their errors.
struct Judged {
  LightFrame frame;
  ReceiverImage receivers;
  ReceiverTruth truth;
  LookupProbe probe;
  raytrace::LookupTruth lookup;
  int kernel = 1;

  bool counted(size_t i) const { return truth.facing[i] && test::is_sure(truth, lookup.taps, i); }
  glm::dvec2 place(size_t i, int tap) const {  // the exact place of the tap
    const int r = kernel / 2;
    return glm::dvec2(frame.to_light(receivers.position[i])) +
           glm::dvec2(tap % kernel - r, tap / kernel - r) * frame.texel_m(glm::dvec3(0));
  }
  glm::dvec2 texel_centre(size_t i, int tap) const {  // of the texel that the tap snaps to
    return frame.texel_centre(probe.texel(i, tap));
  }
  // How far from a receiver its taps' texel centres may lie.
  double reach() const { return frame.texel_m(glm::dvec3(0)) * std::sqrt(2.0) * (kernel / 2 + 0.5); }
  Tap tap(size_t i, int number) const {
    ReceiverTaps taps;
    taps.read(probe, lookup.taps, MapSettings{}, lookup.exact_map, i);
    return taps[static_cast<size_t>(number)];
  }

  using Causes = std::array<uint64_t, compared_cause_count>;
  // Counts the taps of the chosen counted receivers by their cause at this bias.
  Causes causes(double bias_m, const std::function<bool(size_t)>& chosen = nullptr) const {
    Causes sum{};
    const float bias = static_cast<float>(bias_m / (frame.far_m - frame.near_m));
    for (size_t i = 0; i < truth.facing.size(); ++i) {
      if (!counted(i) || (chosen && !chosen(i))) continue;
      for (int t = 0; t < kernel * kernel; ++t) {
        const Tap found = tap(i, t);
        ++sum[static_cast<size_t>(tap_cause(found, !(probe.reference[i] - bias > found.depth)))];
      }
    }
    return sum;
  }
};

inline Judged judge(const raytrace::Tracer& tracer, const ReceiverImage& receivers, const LightFrame& frame,
                    int kernel) {
  Judged j{frame,
           receivers,
           tracer.receiver_truth(receivers, frame, {}),
           test::probe_of(receivers, frame, test::box(kernel)),
           {},
           kernel};
  MapSettings map;
  map.resolution = frame.resolution;
  j.lookup = tracer.lookup_truth(receivers, j.truth, j.probe, frame, map);
  return j;
}

// The edges at which the depth that the light sees may jump: those whose triangles all lie on one side of them, as the
// light sees it. Whether it jumps is found from the nearest triangle on each side of the edge.
class TrueEdges {
 public:
  TrueEdges(const Scene& scene, const LightFrame& frame) : bins_(scene, frame) {
    using Key = std::tuple<float, float, float, float, float, float>;
    struct Edge {
      glm::dvec2 a, b;
      bool left = false, right = false;
    };
    std::map<Key, Edge> edges;
    for (const glm::uvec3 t : scene.triangles) {
      for (int e = 0; e < 3; ++e) {
        glm::vec3 p = scene.positions[t[e]], q = scene.positions[t[(e + 1) % 3]];
        if (std::tie(q.x, q.y, q.z) < std::tie(p.x, p.y, p.z)) std::swap(p, q);
        Edge& edge = edges[{p.x, p.y, p.z, q.x, q.y, q.z}];
        edge.a = glm::dvec2(frame.to_light(p));
        edge.b = glm::dvec2(frame.to_light(q));
        const glm::dvec2 way = edge.b - edge.a,
                         apex = glm::dvec2(frame.to_light(scene.positions[t[(e + 2) % 3]])) - edge.a;
        const double side = way.x * apex.y - way.y * apex.x;
        edge.left |= side > 0;
        edge.right |= side < 0;
      }
    }
    for (const auto& [key, edge] : edges)
      if (!(edge.left && edge.right) && glm::length(edge.b - edge.a) > 0) outline_.push_back({edge.a, edge.b});
  }

  // Whether there is a place within `radius` of x where the depth that the light sees first jumps.
  bool jump_within(glm::dvec2 x, double radius) const {
    return any_within(x, radius, [&](glm::dvec2 a, glm::dvec2 way, double from, double to) {
      for (int k = 0; k <= samples; ++k)
        if (jumps(a + (from + (to - from) * k / samples) * way, glm::dvec2(-way.y, way.x) / glm::length(way)))
          return true;
      return false;
    });
  }

  // Whether there is a fold or a boundary of some surface, hidden from the light or not.
  bool outline_within(glm::dvec2 x, double radius) const {
    return any_within(x, radius, [](glm::dvec2, glm::dvec2, double, double) { return true; });
  }

 private:
  // Whether `holds` is true for some outline edge that the circle cuts. It gets the part of the edge inside the circle,
  // from a + from * way to a + to * way.
  template <class Holds>
  bool any_within(glm::dvec2 x, double radius, const Holds& holds) const {
    for (const auto& [a, b] : outline_) {
      const glm::dvec2 way = b - a;
      const double length = glm::length(way);
      const double nearest = glm::dot(x - a, way) / (length * length);
      const double off = glm::length(a + nearest * way - x);
      if (off > radius) continue;
      const double half = std::sqrt(radius * radius - off * off) / length;
      const double from = std::max(0.0, nearest - half), to = std::min(1.0, nearest + half);
      if (from <= to && holds(a, way, from, to)) return true;
    }
    return false;
  }

  static constexpr int samples = 32;  // along the part of an edge inside the circle, some of which may be hidden

  bool jumps(glm::dvec2 at, glm::dvec2 across) const {
    const glm::dvec2 aside = 1e-9 * bins_.size_m() * across;  // far above double's rounding, far below any feature
    const LightBins::Hit one = bins_.first_hit(at - aside), other = bins_.first_hit(at + aside);
    if (one.triangle == no_primitive || other.triangle == no_primitive) return one.triangle != other.triangle;
    return std::abs(one.z - other.z) > 1e-6 * bins_.size_m();  // 1e-9 times any slope that these meshes have
  }

  LightBins bins_;
  std::vector<std::pair<glm::dvec2, glm::dvec2>> outline_;
};

inline constexpr int resolutions[] = {19, 64, 200};

inline size_t at(Cause cause) { return static_cast<size_t>(cause); }

struct Tally {
  uint64_t taps = 0, differ = 0, dark = 0, ambiguous = 0, facing = 0;
};

inline Tally tally(const Judged& j, const std::function<bool(size_t)>& chosen = nullptr) {
  Tally sum;
  for (size_t i = 0; i < j.truth.facing.size(); ++i) {
    sum.facing += j.truth.facing[i];
    sum.ambiguous += j.truth.facing[i] && j.truth.ambiguous[i];
    if (!j.counted(i) || (chosen && !chosen(i))) continue;
    for (int t = 0; t < j.kernel * j.kernel; ++t) {
      const Tap tap = j.tap(i, t);
      ++sum.taps;
      sum.differ += tap.exact_lit != tap.texel_lit;
      sum.dark += !tap.exact_lit;
    }
  }
  return sum;
}

// Calls visit(judged) for grids of several sizes, each shifted and turned at random, without a filter and with 3x3.
inline void on_many_grids(const Scene& scene, uint32_t seed, int count, const std::function<void(const Judged&)>& visit,
                          bool facing_light = false) {
  std::mt19937 random(seed);
  const raytrace::Tracer tracer(scene);
  for (int resolution : resolutions) {
    for (int kernel : {1, 3}) {
      const LightFrame frame = aligned(scene, resolution, random);
      const ReceiverImage receivers =
          test::random_receivers(scene, frame.direction_to_light(), facing_light, count, seed + resolution);
      SCOPED_TRACE(testing::Message() << "resolution " << resolution << " kernel " << kernel);
      visit(judge(tracer, receivers, frame, kernel));
    }
  }
}

// Law 4: a tap whose truth changes between its place and the texel's centre lies within half a texel's diagonal of an
// edge at which the depth that the light sees jumps, whatever the receiver's shape. The edges are those of the
// triangles' outlines, found without rays. For lit receivers without a filter there is no exception. A tap further off,
// or of a dark receiver, may ask for P's surface at a place that the surface does not reach. If P lies at its own fold
// (a terminator), the surface is continued at the fold's depth, and V changes where this depth crosses what the light
// sees there. docs/reference/limits.md lists this ("dark receivers at a concave terminator"). It is rare.
struct Explained {
  uint64_t taps = 0, at_jumps = 0, at_own_folds = 0, unexplained = 0;
};

inline Explained explain_aliasing(const Judged& j, const TrueEdges& edges,
                                  const std::function<bool(size_t)>& chosen = nullptr) {
  Explained sum;
  const double half_diagonal = j.frame.texel_m(glm::dvec3(0)) * (std::sqrt(0.5) + 1e-6);
  for (size_t i = 0; i < j.truth.facing.size(); ++i) {
    if (!j.counted(i) || (chosen && !chosen(i))) continue;
    for (int t = 0; t < j.kernel * j.kernel; ++t) {
      ++sum.taps;
      const Tap tap = j.tap(i, t);
      if (tap.exact_lit == tap.texel_lit) continue;
      const glm::dvec2 p = glm::dvec2(j.frame.to_light(j.receivers.position[i]));
      if (edges.jump_within(j.place(i, t), half_diagonal))
        ++sum.at_jumps;
      else if ((j.kernel > 1 || !j.truth.lit[i]) && edges.outline_within(p, j.reach()))
        ++sum.at_own_folds;
      else
        ++sum.unexplained;
    }
  }
  return sum;
}

inline void expect_aliasing_at_true_edges(const Judged& j, const TrueEdges& edges,
                                          const std::function<bool(size_t)>& chosen = nullptr) {
  const Explained sum = explain_aliasing(j, edges, chosen);
  EXPECT_EQ(sum.unexplained, 0u);
  // 3x3 taps of the coarsest grid reach over a fifth of these shapes.
  EXPECT_LE(sum.at_own_folds, sum.taps / (j.kernel == 1 ? 200 : 20)) << "of " << sum.at_jumps << " at true edges";
}

}  // namespace noonmark::curved
