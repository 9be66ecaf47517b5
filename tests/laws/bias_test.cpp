// Law 1: the smallest bias at which a map shows no acne. In these comments g is the gradient of a face's depth in the
// light's plane: |g|_1 = |g.u| + |g.v| = A tan(theta) with A = |cos phi| + |sin phi|, where phi is its azimuth against
// the texels. w is the width of a texel. k = r + 1/2 for a box of radius r with nearest taps.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/results/quantities.h"
#include "tests/laws/support.h"

namespace noonmark::acceptance {
namespace {

// The reference and the exact map's depth are floats in [0, 1], computed from rounded numbers: at most three roundings,
// each 2^-24 of the range.
double float_rounding_m(const Measurement& m) { return 3 * 0x1p-24 * metric(m, "map_range_m"); }

double quantity_of(const Measurement& m, const char* name) {
  const std::optional<double> value = quantity(m.record, name);
  EXPECT_TRUE(value.has_value()) << name;
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

// At theta = 0 only the quantum is left in the law, and the law is exact. Every receiver has the same depth d, and the
// map stores d rounded to the nearest step. So the plane needs a bias of max(0, d - rounded), which is at most q/2. The
// value q/2 is the supremum over depths, not over alignments. A 32-bit map rounds as the reference does, so it needs no
// bias. A 24-bit map needs none where d >= 1/2, because there the float that the sampler returns is no finer than the
// step.
TEST(Law1, NeedsUpToHalfAQuantumOfAPlaneAcrossTheLight) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* format : {"16", "24", "32f"}) {
    double largest = 0;
    for (int i = 0; i < 40; ++i) {
      // The light is 10 m above the plane: d falls from 0.75 to 0.03.
      const double near = 1 + 0.2171 * i, far = 13 + 0.3713 * i;
      const Measurement m = bench.measure(with({{"scene.theta_deg", "0"},
                                                {"map.near_m", text(near)},
                                                {"map.far_m", text(far)},
                                                {"map.format", format},
                                                {"map.resolution", "32"}},
                                               small("plane", 60, 34)),
                                          exact_window());
      const double d = m.technique.frame.tile(0).window_depth(10), range = metric(m, "map_range_m"),
                   q = metric(m, "depth_quantum_m");
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
      EXPECT_GT(largest, 0.45);  // some of the 40 depths lie nearly halfway between two steps
    }
    if (std::string(format) == "24") {
      EXPECT_GT(largest, 0.2);  // from the depths d < 1/2
    }
  }
}

// Taps outside the map. With a lit border no bias is needed. With clamping to the edge, a receiver outside the map is
// compared with the depth at the edge. If D is its distance outside, along the slope, it needs D tan(theta) more than
// the law gives, and this grows with D without a bound. A receiver inside needs no more than the law, because clamping
// brings a tap nearer to it. With repetition even a receiver inside may read the far side of the map, where the depth
// differs by that of the whole extent.
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
      EXPECT_NE(m.ladder[Cause::coverage_dark][i], 0) << "only coverage can make a plane dark";
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
