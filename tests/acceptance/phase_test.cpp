// The phase diagram against closed forms: acne of a plane, where acne ends, and texels of one size in maps of two sizes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "compare/ladder/law_bias.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

PhaseDiagram phase_of(const Settings& given, const PhaseOptions& options) {
  Workbench bench(gl::DebugMode::fatal);
  return bench.phase(phase_settings(given, bench.scene(given.scene)), options);
}

// A plane that nothing shadows, seen so that the whole picture shows it. The normal makes theta with the light.
Settings plane(double theta_deg, double phi_deg) {
  return with({{"scene.theta_deg", std::to_string(theta_deg)},
               {"scene.phi_deg", std::to_string(phi_deg)},
               {"map.extent_m", "8"},
               {"view.fov_deg", "18"},
               {"map.format", "32f"}},
              small("plane", 240, 135));
}

// Uniformly distributed a and b in (-1/2, 1/2): the share of a p + b q above c, by counting a fine grid of them. It is
// written without the program's formula.
double tail(double p, double q, double c) {
  constexpr int n = 400;
  int above = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) above += ((i + 0.5) / n - 0.5) * p + ((j + 0.5) / n - 0.5) * q > c;
  return static_cast<double>(above) / (n * n);
}

// Acne of a lit plane at bias b, over all placements: a function of b / w, the tail of g.d over the texel.
TEST(PhaseDiagram, AcneOfAPlaneIsTheTailOfItsSlopeOverTheTexel) {
  for (const auto& [theta, phi] : {std::pair(60.0, 0.0), std::pair(60.0, 45.0), std::pair(75.0, 20.0)}) {
    SCOPED_TRACE(std::to_string(theta) + " turned by " + std::to_string(phi));
    const Settings settings = plane(theta, phi);
    const PhaseDiagram d = phase_of(settings, {{}, 3, 64, 256, 8, 4});
    ASSERT_GT(d.receivers, 10000);
    // The slope in metres of depth for a metre along each axis of the texels.
    const double slope = std::tan(theta * std::numbers::pi / 180), turned = phi * std::numbers::pi / 180;
    const double p = slope * std::abs(std::cos(turned)), q = slope * std::abs(std::sin(turned));
    for (const PhaseRow& row : d.rows) {
      size_t tried = 0;
      for (size_t i = 0; i < d.bias_m.size(); ++i) {
        const double expected = tail(p, q, d.bias_m[i] / row.texel_m);
        // 64 placements of 30,000 receivers, and the 400 steps of the count.
        EXPECT_NEAR(row.acne[i], expected, 0.004) << "bias " << d.bias_m[i] << " at " << row.texel_m;
        tried += expected > 0.02 && expected < 0.48;
      }
      EXPECT_GT(tried, 5u);
      EXPECT_NEAR(row.last_acne_m / row.texel_m, (p + q) / 2, 0.01 * (p + q) / 2);
    }
    EXPECT_NEAR(d.law_steepest, (p + q) / 2, 1e-3 * (p + q));
    // One step of the count.
    EXPECT_NEAR(tail(p, q, d.law_at_bound), d.acne_bound, 1.0 / 400);
  }
}

// Where acne ends: at the steepest lit receiver's k w |g|_1. The camera sees little but the steepest faces, so that many
// of their receivers lie beside a texel's corner. experiments/laws.toml has 20 texel sizes.
TEST(PhaseDiagram, AcneOfCubeRoomEndsWhereLaw1Says) {
  const PhaseDiagram d = phase_of(
      with({{"map.format", "32f"}, {"view.target_m", "-1,0,2"}, {"view.fov_deg", "7"}}, small("cube-room", 240, 135)),
      {{}, 5, 256, 4096, 8, 2});
  ASSERT_EQ(d.rows.size(), 5u);
  for (const PhaseRow& row : d.rows) {
    EXPECT_LE(row.last_acne_m, d.law_steepest * row.texel_m * 1.0001) << row.resolution;
    EXPECT_GE(row.last_acne_m, d.law_steepest * row.texel_m * 0.995) << row.resolution;
  }
}

// Law 6: a map of twice the extent with twice the texels has the same texels, so every number of its row is the same.
TEST(PhaseDiagram, TexelsOfOneSizeGiveOneRow) {
  const auto row_of = [&](double extent_m, int resolution) {
    const PhaseDiagram d = phase_of(
        with({{"map.extent_m", std::to_string(extent_m)}, {"map.format", "32f"}}, small("cube-room", 240, 135)),
        {{}, 2, resolution, 2 * resolution, 4, 4});
    return d;
  };
  const PhaseDiagram narrow = row_of(80, 512), wide = row_of(160, 1024);  // all that the camera sees is in both
  for (size_t r = 0; r < narrow.rows.size(); ++r) {
    const PhaseRow &a = narrow.rows[r], &b = wide.rows[r];
    ASSERT_DOUBLE_EQ(a.texel_m, b.texel_m);
    double most = 0;
    for (size_t i = 0; i < narrow.bias_m.size(); ++i) {
      most = std::max(most, a.acne[i]);
      // Float rounds the two matrices differently, so a threshold on an edge may change sides: one tap of 32,400.
      EXPECT_NEAR(a.acne[i], b.acne[i], 1e-4) << narrow.bias_m[i];
      EXPECT_NEAR(a.peter_panning[i], b.peter_panning[i], 1e-4) << narrow.bias_m[i];
      EXPECT_NEAR(a.aliasing[i], b.aliasing[i], 1e-4) << narrow.bias_m[i];
    }
    EXPECT_GT(most, 0.2);
  }
}

TEST(PhaseDiagram, UsableRowsAloneAreTheFinestOfAll) {
  PhaseOptions options{{}, 5, 8, 2048, 4, 4};
  const Settings settings = small("cube-room", 120, 68);
  PhaseDiagram all = phase_of(settings, options);
  // The least Peter Panning of a row without acne. The coarsest row breaks the bound, the finest one does not.
  const auto least = [&](const PhaseRow& row) {
    double most = 1;
    for (size_t i = 0; i < all.bias_m.size(); ++i)
      if (row.acne_worst[i] <= all.acne_bound) most = std::min(most, row.peter_panning_worst[i]);
    return most;
  };
  ASSERT_GT(least(all.rows.front()), least(all.rows.back()));
  all.peter_panning_bound = options.peter_panning_bound = (least(all.rows.front()) + least(all.rows.back())) / 2;
  size_t first = all.rows.size() - 1;
  while (!all.usable(all.rows[first]).empty()) --first;
  options.usable_only = true;
  const PhaseDiagram few = phase_of(settings, options);
  EXPECT_EQ(few.bias_m, all.bias_m);
  EXPECT_EQ(few.receivers, all.receivers);
  ASSERT_EQ(few.rows.size(), all.rows.size() - first);
  for (size_t r = 0; r < few.rows.size(); ++r) {
    const PhaseRow &one = few.rows[r], &same = all.rows[first + r];
    EXPECT_EQ(one.resolution, same.resolution);
    EXPECT_EQ(one.acne_worst, same.acne_worst);
    EXPECT_EQ(one.peter_panning_worst, same.peter_panning_worst);
  }
}

TEST(PhaseDiagram, SaysWhatItCannotShow) {
  EXPECT_THROW(phase_of(small("point-room"), {}), Error);
  EXPECT_THROW(phase_of(with({{"bias.slope", "0.01"}}, small("cube-room")), {}), Error);
  EXPECT_NO_THROW(
      phase_of(with({{"bias.slope", "0.01"}, {"bias.unit", "m"}}, small("cube-room", 40, 24)), {{}, 2, 32, 64, 2}));
}

}  // namespace
}  // namespace noonmark::acceptance
