// Cascades, measured: each is a map of its own, and the whole is what they are over their receivers.
#include "technique/cascades.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "compare/ladder/measure.h"
#include "compare/report/cascade_rows.h"
#include "tests/acceptance/maps_apart.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

class CascadeCase : public testing::TestWithParam<SceneCase> {
 protected:
  Settings settings() const { return with(GetParam().settings, street({{"scene.name", GetParam().scene}})); }
};

// The point is what its maps give when each is measured by itself over all receivers, and the receivers of its cascade are
// taken from it: value for value.
TEST_P(CascadeCase, EqualsSeparateMapsOverTheSameReceivers) {
  const Settings s = settings();
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(s, std::nullopt);
  ASSERT_EQ(m.maps.size(), 4u);
  EXPECT_LE(metric(m, "cascade_choice_excess"), 1);
  EXPECT_LE(metric(m, "residual"), rounding_of_steps);
  EXPECT_EQ(metric(m, "contract"), 0);
  EXPECT_LE(metric(m, "rounding_excess"), 1);

  MapsApart apart(s);
  std::vector<Technique> techniques = techniques_of(apart.scene(), s);
  ASSERT_EQ(m.choice.of.pixels, apart.renderer.choose_maps(techniques[0]).of.pixels);
  std::array<uint64_t, 4> counted{};
  double error = 0;
  for (size_t k = 0; k < techniques.size(); ++k) {
    Technique alone = techniques[k];
    alone.cascade.reset();
    const Ladder ladder = apart.climb(alone, apart.truth_of(alone));
    double own_error = 0;
    for (size_t i = 0; i < ladder.flags.size(); ++i) {
      if (m.choice.of[i] != k) continue;
      ASSERT_EQ(m.ladder.flags[i], ladder.flags[i]) << k << " " << i;
      for (size_t n = 0; n < ladder.rungs.size(); ++n)
        ASSERT_EQ(m.ladder.rungs[n].lit[i], ladder.rungs[n].lit[i]) << k << " " << ladder.rungs[n].name << " " << i;
      for (size_t c = 0; c < ladder.causes.size(); ++c)
        ASSERT_EQ(m.ladder.causes[c].step[i], ladder.causes[c].step[i])
            << k << " " << ladder.causes[c].name << " " << i;
      EXPECT_EQ(m.ladder.cause[i], ladder.cause[i]);
      if (!is_counted(ladder, i)) continue;
      ++counted[k];
      own_error += std::abs(static_cast<double>(ladder.shown()[i]) - ladder.truth()[i]);
    }
    error += own_error;
    const PointRecord::Cascade& row = m.record.cascades[k];
    EXPECT_EQ(row.metrics.at("counted"), static_cast<double>(counted[k]));
    if (counted[k] > 0) {
      EXPECT_DOUBLE_EQ(row.metrics.at("error"), own_error / static_cast<double>(counted[k]));
    }
    EXPECT_EQ(row.metrics.at("texel_m"), techniques[k].frame.texel_m(glm::dvec3(0)));
  }
  uint64_t all = 0;
  for (const uint64_t one : counted) all += one;
  EXPECT_EQ(static_cast<double>(all), metric(m, "counted"));
  EXPECT_GT(std::count_if(counted.begin(), counted.end(), [](uint64_t n) { return n > 50; }), 2);
  EXPECT_DOUBLE_EQ(metric(m, "error"), error / static_cast<double>(all));
}

INSTANTIATE_TEST_SUITE_P(
    , CascadeCase,
    testing::Values(SceneCase{"Unfiltered", "pillars", {}},
                    SceneCase{"Box", "pillars", {{"filter.kind", "box"}, {"filter.size", "5"}}},
                    SceneCase{"Hardware", "facade", {{"filter.kind", "hardware"}, {"bias.slope", "1"}}},
                    SceneCase{"FitToTheView", "facade", {{"map.fit", "view"}, {"cascades.splits", "logarithmic"}}},
                    SceneCase{"Snapped", "pillars", {{"map.snap", "true"}, {"map.format", "16"}}},
                    SceneCase{"NormalOffset", "cube-room", {{"bias.normal_offset", "0.02"}, {"map.wrap", "repeat"}}}),
    [](const auto& test) { return test.param.name; });

// The curve over the bias is exact for cascades too.
TEST(CascadedPoint, CurveIsTheErrorAtEachBias) {
  const Settings s = street({{"map.resolution", "128"}});
  Workbench bench(gl::DebugMode::fatal);
  const double range = 1;
  CurveOptions options;
  for (const double bias : {0.0, 0.3, 1.0, 2.5, 6.0}) options.bias_depth.push_back(bias * range);
  const Measurement m = bench.measure(s, options);
  ASSERT_TRUE(m.record.curve);
  const BiasCurve curve = *m.record.curve;
  int wrong = 0;
  for (size_t n = 0; n < curve.bias_depth.size(); ++n) {
    // The axis is depth; the parameter is in texels.
    const double texels = curve.bias_depth[n] * curve.texels_per_depth;
    Settings at = s;
    at.bias["constant"] = texels;
    const Measurement rendered = bench.measure(at, std::nullopt);
    EXPECT_NEAR(curve.error[n], metric(rendered, "error"), 1e-9) << texels;
    EXPECT_NEAR(curve.acne[n], metric(rendered, "acne"), 1e-9) << texels;
    EXPECT_NEAR(curve.peter_panning[n], metric(rendered, "peter_panning"), 1e-9) << texels;
    wrong += curve.error[n] > 1e-4;
  }
  EXPECT_GT(wrong, 1) << "the curve says nothing";
  // What each cascade needs is the largest of all: acne ends there.
  double needed = 0;
  for (const PointRecord::Cascade& cascade : m.record.cascades) needed = std::max(needed, cascade.bias_needed.value());
  EXPECT_NEAR(needed, *curve.acne_free_bias_depth * curve.texels_per_depth, 1e-6 * needed);
}

// One bias in metres is right in one cascade only (law 31); the row of the cascade that needs more says so.
TEST(CascadedPoint, SaysWhichCascadeNeedsMoreBias) {
  const Settings s = street({{"bias.unit", "m"}, {"bias.constant", "0.02"}, {"map.resolution", "128"}});
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(s, CurveOptions{});
  const std::vector<CascadeRow> rows = cascade_rows_of(m.record);
  ASSERT_EQ(rows.size(), 4u);
  double before = 0;
  for (size_t k = 0; k < 4; ++k) {
    const double needed = m.record.cascades[k].bias_needed.value();
    EXPECT_GT(needed, before) << "texels grow";
    before = needed;
    EXPECT_EQ(cascade_bias_text(m.record, rows[k], rows[k].set), "0.02 m");
    EXPECT_EQ(cascade_bias_text(m.record, rows[k], rows[k].needed), fmt::format("{:.3g} m", needed));
  }
  EXPECT_GT(before, 0.02);
  const std::string worst = worst_cascade(m.record);
  EXPECT_NE(worst.find("Acne"), std::string::npos) << worst;
  EXPECT_NE(worst.find("Its bias.constant is 0.02 m where "), std::string::npos) << worst;
}

TEST(CascadedPoint, HasSectionsInTheCascadeOfEachPixel) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(street({}), std::nullopt);
  std::vector<glm::ivec2> pixels;
  std::vector<size_t> cascades;
  for (size_t k = 0; k < m.maps.size(); ++k)
    for (size_t i = 0; i < m.choice.of.size(); ++i)
      if (m.choice.of[i] == k && is_counted(m.ladder, i)) {
        pixels.emplace_back(static_cast<int>(i) % m.choice.of.width, static_cast<int>(i) / m.choice.of.width);
        cascades.push_back(k);
        break;
      }
  ASSERT_GT(pixels.size(), 2u);
  const std::vector<ReceiverSection> sections = bench.sections(m, pixels);
  for (size_t n = 0; n < pixels.size(); ++n) {
    EXPECT_EQ(sections[n].cascade, static_cast<int>(cascades[n]) + 1);
    EXPECT_EQ(sections[n].texel_m, m.maps[cascades[n]].technique.frame.texel_m(glm::dvec3(0)));
  }
  const auto empty = std::find(m.receivers.primitive.pixels.begin(), m.receivers.primitive.pixels.end(), no_primitive);
  ASSERT_NE(empty, m.receivers.primitive.pixels.end());
  const int at = static_cast<int>(empty - m.receivers.primitive.pixels.begin());
  const glm::ivec2 sky[] = {{at % m.choice.of.width, at / m.choice.of.width}};
  EXPECT_THROW(bench.sections(m, sky), Error);
}

// Timing the passes before or after changes no number.
TEST(CascadedPoint, IsTheSameWhenItsPassesAreTimed) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings s = street({{"cascades.blend", "0.2"}});
  const std::map<std::string, double> untimed = bench.measure(s, std::nullopt).record.metrics;
  Workbench other(gl::DebugMode::fatal);
  const PassTimes times = other.time_passes(s, true, true);
  EXPECT_GT(*times.lookup_ms, 0);
  EXPECT_EQ(other.measure(s, std::nullopt).record.metrics, untimed);
  EXPECT_GT(untimed.at("seam_points"), 0);
}

// Nothing that is remembered of a point with cascades enters one without, and the other way round.
TEST(CascadedPoint, IsForgottenByTheNext) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings four = street({}), one = street({{"cascades.count", "1"}}), two = street({{"cascades.count", "2"}});
  const auto numbers = [](const Measurement& m) {
    std::map<std::string, double> all;
    for (const auto& [name, value] : m.record.metrics)
      if (!name.ends_with("_ms") && !std::isnan(value)) all[name] = value;
    return all;
  };
  std::vector<std::map<std::string, double>> fresh;
  for (const Settings& s : {four, one, two}) {
    Workbench other(gl::DebugMode::fatal);
    fresh.push_back(numbers(other.measure(s, std::nullopt)));
  }
  EXPECT_EQ(numbers(bench.measure(four, std::nullopt)), fresh[0]);
  EXPECT_EQ(numbers(bench.measure(one, std::nullopt)), fresh[1]);
  EXPECT_EQ(numbers(bench.measure(two, std::nullopt)), fresh[2]);
  EXPECT_EQ(numbers(bench.measure(four, std::nullopt)), fresh[0]);
  EXPECT_NE(fresh[0], fresh[1]);
}

}  // namespace
}  // namespace noonmark::acceptance
