// The taps of a lookup that is moved along the receiver's normal: D = V(P, P' + o), compared with F = V(P, P + o).
#include <gtest/gtest.h>

#include "technique/bias.h"
#include "tests/raytrace/fixture.h"
#include "tests/support/bias_of.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

Bias offset_by(const LightFrame& frame, double metres) {
  return bias_of({{"normal_offset", metres / frame.texel_m(glm::dvec3(0))}});
}

Bias constant_of(float depth) { return bias_of({{"constant", depth}}); }

struct OffsetLooked {
  ReceiverTruth truth;
  LookupTruth lookup;
  uint8_t bits(size_t i, int tap = 0) const {
    const size_t taps = static_cast<size_t>(lookup.taps.taps_per_receiver);
    return lookup.taps.taps[i * taps + static_cast<size_t>(tap)];
  }
  bool exact_lit(size_t i, int tap = 0) const { return bits(i, tap) & tap_exact_lit; }
  bool displaced(size_t i, int tap = 0) const { return bits(i, tap) & tap_displaced; }
  bool ambiguous(size_t i, int tap = 0) const { return bits(i, tap) & tap_unsure; }
};

OffsetLooked look_up(const Scene& scene, const LightFrame& frame, const ReceiverImage& receivers, int kernel,
                     const Bias& bias, bool use_cells = true) {
  const Tracer tracer(scene, use_cells ? TruthMethod::automatic : TruthMethod::rays);
  ReceiverImage moved = receivers;
  for (size_t i = 0; i < moved.position.size(); ++i)
    moved.position[i] = glm::vec3(bias.looked_up(frame, receivers.position[i], receivers.normal[i]));
  OffsetLooked looked{tracer.receiver_truth(receivers, frame, {}), {}};
  looked.lookup = tracer.lookup_truth(receivers, looked.truth, probe_of(moved, frame, box(kernel)), frame, {}, bias);
  return looked;
}

// Law 8: where there is no shadow, none can be displaced, however far the lookup is moved: past folds, boundaries and
// the map.
TEST(MovedTaps, AreLitWhereNothingShades) {
  for (const char* name : {"plane", "sphere", "bowl"}) {
    const Scene scene = builtin(name);
    const LightFrame frame = frame_of(scene, 64);
    const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), false, 3000, 7);
    for (double offset_m : {0.003, 0.1, 1.0, 30.0}) {
      for (int kernel : {1, 3}) {
        const OffsetLooked looked = look_up(scene, frame, receivers, kernel, offset_by(frame, offset_m));
        int sure = 0, wrong = 0;
        for (size_t i = 0; i < receivers.position.size(); ++i) {
          if (!looked.truth.facing[i] || looked.truth.ambiguous[i]) continue;
          ++sure;
          for (int tap = 0; tap < kernel * kernel; ++tap)
            wrong += !looked.exact_lit(i, tap) || looked.displaced(i, tap);
        }
        EXPECT_GT(sure, 2900);
        EXPECT_EQ(wrong, 0) << name << " moved by " << offset_m << " m, kernel " << kernel;
      }
    }
  }
}

TEST(MovedTaps, CostARayEachAndOnlyWhereTheyAreMoved) {
  const Scene scene = builtin("wall");
  const LightFrame frame = frame_of(scene, 256);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), false, 5000, 3);
  for (int kernel : {1, 3}) {
    const OffsetLooked none = look_up(scene, frame, receivers, kernel, {}, false);
    const OffsetLooked constant = look_up(scene, frame, receivers, kernel, constant_of(0.1f), false);
    const OffsetLooked moved = look_up(scene, frame, receivers, kernel, offset_by(frame, 0.1), false);
    EXPECT_EQ(none.lookup.tap_stage.rays, constant.lookup.tap_stage.rays);
    EXPECT_EQ(none.lookup.taps.taps, constant.lookup.taps.taps);
    EXPECT_GE(moved.lookup.tap_stage.rays, none.lookup.tap_stage.rays + 5000u * static_cast<unsigned>(kernel * kernel));
    // Most of them are answered without a ray, and all as the rays do.
    const OffsetLooked by_cells = look_up(scene, frame, receivers, kernel, offset_by(frame, 0.1));
    EXPECT_LT(by_cells.lookup.tap_stage.rays, moved.lookup.tap_stage.rays / 20);
    EXPECT_EQ(by_cells.lookup.taps.taps, moved.lookup.taps.taps);
    EXPECT_EQ(by_cells.lookup.edge_distance_texels.pixels, moved.lookup.edge_distance_texels.pixels);
    int displaced = 0, different_f = 0;
    for (size_t i = 0; i < receivers.position.size(); ++i)
      for (int tap = 0; tap < kernel * kernel; ++tap) {
        EXPECT_FALSE(none.displaced(i, tap));
        displaced += moved.displaced(i, tap);
        different_f += moved.exact_lit(i, tap) != none.exact_lit(i, tap);
      }
    EXPECT_GT(displaced, 10);
    EXPECT_EQ(different_f, 0) << "F belongs to the place of the receiver itself";
  }
}

// The floor under the built-in plate; its shadow in closed form, by slabs.
class PlateOnFloor : public testing::Test {
 protected:
  // Whether the plate is between the point and the light. `margin_m` grows the plate on all sides.
  bool dark(glm::dvec3 p, double margin_m) const {
    const glm::dvec3 low(-0.8, 0.4, -0.6), high(0.8, 0.5, 0.6), way = frame.direction_to_light();
    double from = 0, to = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      double a = (low[axis] - margin_m - p[axis]) / way[axis], b = (high[axis] + margin_m - p[axis]) / way[axis];
      if (a > b) std::swap(a, b);
      from = std::max(from, a);
      to = std::min(to, b);
    }
    return from < to;
  }
  // Where the light ray through a place in the light's plane meets the floor.
  glm::dvec3 on_floor(glm::dvec2 x) const {
    const glm::dvec3 start = frame.to_world({x.x, x.y, 0});
    return start - start.y / frame.forward.y * frame.forward;
  }
  ReceiverImage on_floor(const std::vector<glm::dvec3>& points) const {
    std::vector<Placed> placed;
    for (glm::dvec3 p : points) {
      const glm::uvec3 t = scene.triangles[0];
      const auto side = [&](uint32_t i, uint32_t j) {
        const glm::dvec3 a = scene.positions[i], b = scene.positions[j];
        return (b.x - a.x) * (p.z - a.z) - (b.z - a.z) * (p.x - a.x);
      };
      const double a = side(t.x, t.y), b = side(t.y, t.z), c = side(t.z, t.x);
      placed.push_back({p, (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0) ? 0u : 1u});
    }
    return receivers_at(scene, placed, frame.direction_to_light(), true);
  }
  const Scene scene = builtin("plate");
  const LightFrame frame = frame_of(scene, 100);
};

TEST_F(PlateOnFloor, MovedTapsAreThoseOfTheClosedForm) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(-0.8, 1.6), z(-0.8, 1.2);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 4000; ++i) points.push_back({x(random), 0, z(random)});
  const ReceiverImage receivers = on_floor(points);
  for (double offset_m : {0.05, 0.3}) {
    const Bias bias = offset_by(frame, offset_m);
    const OffsetLooked looked = look_up(scene, frame, receivers, 3, bias);
    int checked = 0, displaced = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 p = receivers.position[i], moved = bias.looked_up(frame, p, {0, 1, 0});
      for (int tap = 0; tap < 9; ++tap) {
        const glm::dvec2 o = glm::dvec2(tap % 3 - 1, tap / 3 - 1) * frame.texel_m(glm::dvec3(0));
        const glm::dvec3 exact = on_floor(glm::dvec2(frame.to_light(p)) + o),
                         elsewhere = on_floor(glm::dvec2(frame.to_light(moved)) + o);
        if (looked.truth.ambiguous[i] || looked.ambiguous(i, tap)) continue;
        // Within 10 micrometres of an edge the closed form is no more certain than the rays.
        if (dark(exact, 1e-5) != dark(exact, -1e-5) || dark(elsewhere, 1e-5) != dark(elsewhere, -1e-5)) continue;
        ++checked;
        displaced += looked.displaced(i, tap);
        ASSERT_EQ(looked.exact_lit(i, tap), !dark(exact, 0)) << i << " tap " << tap;
        ASSERT_EQ(looked.exact_lit(i, tap) != looked.displaced(i, tap), !dark(elsewhere, 0)) << i << " tap " << tap;
      }
    }
    EXPECT_GT(checked, 35000);
    EXPECT_GT(displaced, 500);
  }
}

// Near a shadow's edge the verdict of the moved place must be that of double precision: P' = P + d N from the float P.
TEST_F(PlateOnFloor, MovedTapsOnAnEdgeAreDecidedInDouble) {
  const double offset_m = 0.1;
  // The shadow's edge is at x = 0.8 + 0.5 * 3 / 4. It is cast by the upper edge of the plate's side x = 0.8, under a
  // light in the direction (-3, 4, -1.5). P' is on this edge if P is d * 3 / 4 before it, in shadow.
  const double edge = 0.8 + 0.5 * 0.75, before = edge - offset_m * 0.75;
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 600; ++i) points.push_back({before + (i % 3 - 1) * 1e-3, 0, -0.3 + 0.001 * i});
  const OffsetLooked looked = look_up(scene, frame, on_floor(points), 1, offset_by(frame, offset_m));
  const OffsetLooked unmoved = look_up(scene, frame, on_floor(points), 1, {});
  // The edge as the light sees it, computed from the plate's vertices as floats.
  const glm::dvec2 a(frame.to_light({0.8f, 0.5f, -0.6f})), b(frame.to_light({0.8f, 0.5f, 0.6f}));
  const auto side = [&](glm::dvec3 world) {
    const glm::dvec2 x(frame.to_light(world));
    return (b.x - a.x) * (x.y - a.y) - (b.y - a.y) * (x.x - a.x);
  };
  const double shadow = side({0, 0.5, 0});  // on the plate
  int displaced[3] = {};
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_FALSE(looked.truth.ambiguous[i] || looked.exact_lit(i) || unmoved.ambiguous(i));
    const glm::dvec3 moved = glm::dvec3(glm::vec3(points[i])) + glm::dvec3(0, offset_m, 0);
    if (!looked.ambiguous(i)) {
      EXPECT_EQ(looked.displaced(i), side(moved) * shadow < 0) << i;
    }
    displaced[i % 3] += looked.displaced(i);
  }
  EXPECT_EQ(displaced[0], 0) << "a millimetre before the edge";
  EXPECT_EQ(displaced[2], 200) << "a millimetre behind it";
}

}  // namespace
}  // namespace noonmark::raytrace
