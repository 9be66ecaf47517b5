// Law 1: from which bias on a map is free of acne. g: a face's depth gradient in the light's plane, |g|_1 = |g.u| +
// |g.v| = A tan(theta) with A = |cos phi| + |sin phi| for its azimuth phi against the texels; w: one texel; k = r + 1/2
// for nearest taps of a box of radius r.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/store/quantities.h"
#include "tests/laws_support.h"

namespace noonmark::acceptance {
namespace {

// The reference and the exact map's depth are floats in [0,1] from products of rounded numbers: three roundings of
// 2^-24 of the range at most.
double float_rounding_m(const Measurement& m) { return 3 * 0x1p-24 * metric(m, "map_range_m"); }

double quantity_of(const Measurement& m, const char* name) {
  const std::optional<double> value = quantity(m.record, name);
  EXPECT_TRUE(value.has_value()) << name;
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

// A tap reads the plane's depth at its texel's centre c, which lies below that at P by g.(P - c). Per axis P - c is the
// tap's offset of up to r texels plus up to half a texel: at most k w in each, so the supremum of g.(P - c) is k w
// |g|_1 (kernel reach after Isidoro 2006). The stored depth is rounded to the nearest step: another q/2. The law is a
// supremum over alignments; a picture of a hundred thousand receivers meets the worst corner of a texel within 5%.
TEST(Law1, GivesTheAcneFreeBiasOfAPlane) {
  Workbench bench(gl::DebugMode::fatal);
  for (int theta = 10; theta <= 80; theta += 10) {
    for (double phi : {0.0, 20.0, 45.0}) {
      for (int size : {1, 3, 5}) {
        for (const std::string format : {"16", "24", "32f"}) {
          // Every format with every kernel, theta and phi, but not with all three at once: with a kernel, each of the
          // 24 slopes has one format.
          const int turn = (theta / 10 + static_cast<int>(phi / 20) + size / 2) % 3;
          if (size > 1 && format != (turn == 0 ? "16" : turn == 1 ? "24" : "32f")) continue;
          const Measurement m = bench.measure(with({{"scene.theta_deg", std::to_string(theta)},
                                                    {"scene.phi_deg", text(phi)},
                                                    {"filter.kind", "box"},
                                                    {"filter.size", std::to_string(size)},
                                                    {"map.format", format},
                                                    {"map.resolution", "96"}},
                                                   small("plane", 240, 136)),
                                              exact_window());
          SCOPED_TRACE(testing::Message() << "theta " << theta << " phi " << phi << " size " << size << " " << format);
          const double a = std::abs(std::cos(radians(phi))) + std::abs(std::sin(radians(phi)));
          const double w = m.frame.extent_m / 96, range = m.frame.far_m - m.frame.near_m;
          const double q = format == "16" ? range / 65535 : format == "24" ? range / 16777215 : range * 0x1p-24;
          const double exact = (size / 2 + 0.5) * w * a * std::tan(radians(theta));
          // The metric is the law, but for the float normal, whose last place its slope magnifies by 1/cos^2 < 34.
          EXPECT_NEAR(metric(m, "acne_free_bias_law_m"), exact + q / 2, 34 * 0x1p-22 * size * w);
          // On an exact map there is no quantum but the float's.
          const double measured = quantity_of(m, "acne_free_bias_m");
          EXPECT_LE(measured, exact + float_rounding_m(m));
          EXPECT_GE(measured, 0.95 * exact);
          EXPECT_EQ(*m.record.curve->window_min_depth, *m.record.curve->acne_free_bias_depth);
          // On the GPU's own the rasteriser's interpolation may be two more steps off.
          const double stored = quantity_of(m, "acne_free_bias_stored_m");
          EXPECT_LE(stored, exact + q / 2 + 2 * q + float_rounding_m(m));
          EXPECT_GE(stored, 0.95 * exact - 2 * q);
        }
      }
    }
  }
}

// At theta = 0 only the quantum is left, and it is exact: every receiver has the one depth d, the map has it rounded to
// the nearest step, and the plane needs max(0, d - rounded) <= q/2. So q/2 is the supremum over depths, not over
// alignments. A 32-bit map rounds as the reference does and needs nothing; so does a 24-bit map where d >= 1/2, where
// the float that the sampler returns is no finer than the step.
TEST(Law1, NeedsUpToHalfAQuantumOfAPlaneAcrossTheLight) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* format : {"16", "24", "32f"}) {
    double largest = 0;
    for (int i = 0; i < 40; ++i) {
      // Light at a height of 10 m over the plane: d from 0.75 down to 0.05.
      const double near = 1 + 0.2171 * i, far = 13 + 0.3713 * i;
      const Measurement m = bench.measure(with({{"scene.theta_deg", "0"},
                                                {"map.near_m", text(near)},
                                                {"map.far_m", text(far)},
                                                {"map.format", format},
                                                {"map.resolution", "32"}},
                                               small("plane", 60, 34)),
                                          exact_window());
      const double d = m.frame.window_depth(10), range = metric(m, "map_range_m"), q = metric(m, "depth_quantum_m");
      const double steps = range / q;
      const double rounded =
          std::string(format) == "32f" ? d : static_cast<double>(static_cast<float>(std::round(d * steps) / steps));
      const double needed = quantity_of(m, "acne_free_bias_stored_m");
      EXPECT_NEAR(needed, std::max(0.0, d - rounded) * range, float_rounding_m(m)) << format << " at depth " << d;
      EXPECT_LE(needed, q / 2 + float_rounding_m(m));
      EXPECT_LE(quantity_of(m, "acne_free_bias_m"), float_rounding_m(m));
      largest = std::max(largest, needed / q);
    }
    if (std::string(format) == "16") {
      EXPECT_GT(largest, 0.45);  // of 40 depths some fall just short of the middle between two steps
    }
    if (std::string(format) == "24") {
      EXPECT_GT(largest, 0.2);  // where d < 1/2
    }
  }
}

// A receiver's depth is more than its texel's by at most the integral of |g| along the way from c to P, over whatever
// lit faces lie on it: no scene needs more than k w max|g|_1 over its faces turned to the light. The faces that the
// camera sees are not enough: a pixel at the foot of a pillar may have its texel's centre on a lit side that is hidden.
TEST(Law1, BoundsWhatAWholeSceneNeeds) {
  Workbench bench(gl::DebugMode::fatal);
  bool hidden_face_needed = false;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.make({}).light.kind != LightKind::directional) continue;  // metres along the light's one axis
    for (int size : {1, 3}) {
      for (int resolution : {128, 512}) {
        const Measurement m = bench.measure(with({{"filter.kind", "box"},
                                                  {"filter.size", std::to_string(size)},
                                                  {"map.resolution", std::to_string(resolution)},
                                                  {"map.format", "32f"}},
                                                 small(std::string(builtin.name))),
                                            exact_window());
        const double needed = quantity_of(m, "acne_free_bias_m"), seen = metric(m, "acne_free_bias_law_m");
        SCOPED_TRACE(testing::Message() << builtin.name << " size " << size << " resolution " << resolution);
        EXPECT_LE(needed, metric(m, "acne_free_bias_scene_law_m") + float_rounding_m(m));
        EXPECT_GT(needed, 0);
        hidden_face_needed |= needed > 1.05 * seen;
        // Where the steepest lit face is large and in view, the bound is reached.
        if (builtin.name == "plane" || builtin.name == "plate" || builtin.name == "wall") {
          EXPECT_LE(needed, seen + float_rounding_m(m));
          EXPECT_GE(needed, 0.95 * seen);
        }
      }
    }
  }
  EXPECT_TRUE(hidden_face_needed) << "pillars at 128 texels";
}

// As N.L goes to 0 the bias that a plane needs has no bound, but a sphere's does: a receiver and its texel's centre are
// at most delta = sqrt(2) k w apart in the light's plane, and the sphere's depth changes most between its outline and a
// place delta inside it, by sqrt(R^2 - (R - delta)^2) = sqrt(2 R delta - delta^2).
TEST(Law1, LeavesABandAtTheTerminatorOfASphere) {
  Workbench bench(gl::DebugMode::fatal);
  // The mesh has 192 facets around. It lies inside the sphere of radius 1 by up to 1 - cos(pi / 192), and its outline
  // so much nearer to delta's other end; and a facet that still faces the light reaches past the terminator by half of
  // itself, sin(pi / 192) further down the light.
  const double inside = 1 - std::cos(std::numbers::pi / 192), beyond = std::sin(std::numbers::pi / 192);
  const auto band = [](double delta) { return std::sqrt(2 * delta - delta * delta); };
  for (int size : {1, 3}) {
    for (int resolution : {64, 256}) {
      double needed = 0, delta = 0;
      for (double shift : {0.0, 0.5}) {  // the worst pair is one diagonal of one texel on the outline
        const Measurement m = bench.measure(with({{"filter.kind", "box"},
                                                  {"filter.size", std::to_string(size)},
                                                  {"map.resolution", std::to_string(resolution)},
                                                  {"map.shift_u_texels", text(shift)},
                                                  {"map.format", "32f"}},
                                                 small("sphere", 400, 300)),
                                            exact_window());
        needed = std::max(needed, quantity_of(m, "acne_free_bias_m"));
        delta = std::numbers::sqrt2 * size / 2 * m.frame.texel_m();
      }
      SCOPED_TRACE(testing::Message() << "size " << size << " resolution " << resolution);
      EXPECT_LE(needed, band(delta + inside) + beyond);
      // The camera sees half of the outline, in pixels: nine tenths of the distance are met.
      EXPECT_GE(needed, 0.9 * band(delta));
    }
  }
}

// Taps outside the map. The border is lit: no bias is needed. Clamped to the edge, a receiver outside compares with the
// depth at the edge: with D the distance outside along the slope, D tan(theta) more than the law, without a bound as D
// grows; a receiver inside needs no more than the law, since clamping brings a tap nearer. Repeated, even a receiver
// inside reads the far side: the whole extent's depth.
TEST(Law1, HoldsOutsideTheMapOnlyWithALitBorder) {
  Workbench bench(gl::DebugMode::fatal);
  const double extent = 3, tangent = 1;
  struct Dark {
    uint64_t inside = 0, outside = 0;
  };
  const auto dark = [&](const char* wrap, double extra_bias_m) {
    const Settings base = with({{"scene.theta_deg", "45"},
                                {"map.extent_m", text(extent)},
                                {"map.wrap", wrap},
                                {"map.resolution", "64"},
                                {"map.format", "32f"},
                                {"filter.kind", "box"},
                                {"bias.unit", "m"}},
                               small("plane", 300, 170));
    const double law = 1.5 * extent / 64 * tangent;
    const Measurement m =
        bench.measure(with({{"bias.constant", text(1.001 * law + extra_bias_m)}}, base), std::nullopt);
    Dark count;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      if (!(m.ladder.flags[i] & flag_facing) || m.ladder[Rung::on_exact_map][i] == 1) continue;
      EXPECT_NE(m.ladder[Cause::coverage_dark][i], 0) << "only coverage darkens a plane";
      ++(m.ladder.flags[i] & flag_outside ? count.outside : count.inside);
    }
    return count;
  };
  const Dark border = dark("clamp_to_border", 0);
  EXPECT_EQ(border.inside + border.outside, 0u);
  // The plane is 6 m long: in the light's plane it ends 3 cos(45) - 1.5 m outside the map.
  const double farthest = 3 / std::numbers::sqrt2 - extent / 2;
  const Dark clamped = dark("clamp_to_edge", 0);
  EXPECT_EQ(clamped.inside, 0u);
  EXPECT_GT(clamped.outside, 1000u);
  EXPECT_GT(dark("clamp_to_edge", 0.9 * farthest * tangent).outside, 0u);
  EXPECT_EQ(dark("clamp_to_edge", farthest * tangent).outside, 0u);
  EXPECT_GT(dark("repeat", 0).inside, 100u);
  EXPECT_GT(dark("repeat", 0.9 * extent * tangent).inside, 0u);
  EXPECT_GT(dark("repeat", farthest * tangent).outside, 1000u);
}

}  // namespace
}  // namespace noonmark::acceptance
