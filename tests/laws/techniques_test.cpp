// Laws of filters whose taps a formula in experiments/laws.toml cannot list. Here the sums run over the taps of the
// pattern.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "tests/laws/support.h"

namespace noonmark::acceptance {
namespace {

struct Filter {
  const char* name;
  std::vector<Assignment> settings;
};

const std::vector<Filter>& filters() {
  static const std::vector<Filter> all = {
      {"box 3, 1.5 texels apart", {{"filter.kind", "box"}, {"filter.size", "3"}, {"filter.step_texels", "1.5"}}},
      {"hardware", {{"filter.kind", "hardware"}}},
      {"gaussian 3", {{"filter.kind", "gaussian"}, {"filter.size", "3"}, {"filter.sigma_texels", "1.2"}}},
      {"poisson", {{"filter.kind", "poisson"}, {"filter.radius_texels", "2.5"}}},
      {"poisson, rotated", {{"filter.kind", "poisson"}, {"filter.radius_texels", "2.5"}, {"filter.rotate", "true"}}},
  };
  return all;
}

Settings with_filter(const Filter& filter, Settings settings) {
  for (const auto& [name, value] : filter.settings) find_setting(name).set(settings, value);
  return settings;
}

// The weight of a tap, averaged over all places of P between texel centres. The weight is a product of two functions,
// each linear in one axis, so the average is its value in the middle.
double mean_weight(const TapPattern& pattern, int tap) { return pattern.weight(tap, {0.5, 0.5}); }

// Law 7 for any pattern: the area is the sum, over the taps, of the mean weight times the area of S xor (S - o). S is
// the shadow and o is the tap's offset. The weight of a bilinear tap depends on the place of P in its texel. The band
// along an edge crosses texels at every place, so the mean weight counts.
TEST(Law7Filters, BlurByTheSumOverTheirTaps) {
  Workbench bench(gl::DebugMode::fatal);
  for (const Filter& filter : filters()) {
    for (double phi : {0.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << filter.name << ", phi " << phi);
      const int resolution = 32;
      const Settings settings = with_filter(filter, plate_from_above(phi, resolution, 240, 135));
      const TapPattern pattern = tap_pattern(settings.filter);
      double exact = 0;
      for (int variant = 0; variant < pattern.variants; ++variant)
        for (int t = 0; t < pattern.taps; ++t)
          exact += mean_weight(pattern, t) / pattern.variants *
                   plate_moved_area(phi, 4.0 / resolution * glm::dvec2(pattern.offset(variant, t)));
      // Bilinear weights depend on the alignment, and an edge along the texels has only one alignment. The taps lie at
      // half texels, so two alignments, half a texel apart, cover each weight once.
      const int alignments = pattern.bilinear() ? 2 : 1;
      const double found = mean_over_alignments(bench, settings, "filter_area_m2", alignments);
      std::cout << filter.name << ", phi " << phi << ": measured / law " << found / exact << "\n";
      // Pixels sample the band. Some hundreds of pixels lie across all edges, so the tolerance is 1%.
      EXPECT_NEAR(found / exact, 1, 0.01);
    }
  }
}

// Law 1 for any pattern: the bias must cover the tap that lies furthest down the slope, and half a texel more. A disk
// of taps reaches less far along the texels' diagonals than a square of the same radius.
TEST(Law1Filters, AskForTheirFurthestTap) {
  Workbench bench(gl::DebugMode::fatal);
  for (const Filter& filter : filters()) {
    for (double phi : {0.0, 30.0, 45.0, 200.0}) {
      SCOPED_TRACE(testing::Message() << filter.name << ", phi " << phi);
      const Measurement m = bench.measure(with_filter(filter, with({{"scene.theta_deg", "60"},
                                                                    {"scene.phi_deg", text(phi)},
                                                                    {"map.resolution", "128"},
                                                                    {"map.format", "32f"}},
                                                                   small("plane", 240, 136))),
                                          exact_window());
      const TapPattern& pattern = m.map().probe.pattern;
      // The plane's normal leans towards (cos phi, sin phi) in texels. In that direction the plane descends, away from
      // the light.
      const glm::dvec2 g(std::cos(radians(phi)), std::sin(radians(phi)));
      double reach = 0;
      for (const glm::vec3& o : pattern.offsets) reach = std::max(reach, -glm::dot(glm::dvec2(o), g));
      const double grid = (std::abs(g.x) + std::abs(g.y)) / 2;
      const double per_texel = m.technique.frame.texel_m(glm::dvec3(0)) * std::tan(radians(60));
      ASSERT_TRUE(m.record.curve.has_value() && m.record.curve->acne_free_bias_depth.has_value());
      const double found = *m.record.curve->acne_free_bias_depth * m.record.curve->m_per_depth / per_texel;
      const double metric_law = metric(m, "acne_free_bias_law_m") / per_texel;
      std::cout << filter.name << ", phi " << phi << ": " << found << " texels tan(theta), law " << reach + grid
                << ", metric " << metric_law << "\n";
      // The law is a supremum over alignments and, for a rotated disk, over its rotations. The picture has about 30,000
      // of them.
      EXPECT_LE(found, (reach + grid) * (1 + 1e-4));
      EXPECT_GE(found, (reach + grid) * 0.93);
      EXPECT_NEAR(metric_law, reach + grid, 1e-4);
    }
  }
}

}  // namespace
}  // namespace noonmark::acceptance
