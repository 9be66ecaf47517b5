// A measurement without the metrics that a search does not read, one without checks of the renderer, and one whose checks are
// partly known from the point before: nothing else changes.
#include <gtest/gtest.h>

#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

TEST(MetricSet, AreLeftOutAlone) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = with({{"map.placements", "2"}}, small("cube-room", 120, 68));
  auto all = bench.measure(settings, CurveOptions{}).record.metrics;
  const auto leave_out = [&](MetricSet needed, const std::vector<const char*>& metrics) {
    for (const char* metric : metrics) {
      EXPECT_GT(all[metric], 0) << metric;
      EXPECT_EQ(metric_set_for(metric), needed) << metric;
      all.erase(metric);
    }
  };
  leave_out(MetricSet::all, {"map_used", "undersampled", "perspective_aliasing", "perspective_aliasing_p95"});
  EXPECT_EQ(bench.measure(settings, CurveOptions{}, MetricSet::shaded).record.metrics, all);
  leave_out(MetricSet::shaded, {"shaded_rmse", "flip"});
  const auto few = bench.measure(settings, CurveOptions{}, MetricSet::searched).record.metrics;
  EXPECT_EQ(few, all);
  for (const auto& [metric, value] : few) EXPECT_EQ(metric_set_for(metric), MetricSet::searched) << metric;
}

class WithoutChecks : public testing::TestWithParam<SceneCase> {};

// The metrics that are left out: those of soundness, but for the ladder's own residuals.
void leave_out_checks(std::map<std::string, double>& metrics) {
  for (const char* metric :
       {"contract", "rounding_excess", "address_error_texels", "reference_error_m", "map_error_quanta", "map_excess",
        "map_bits", "cascade_choice_excess", "contract_store", "contract_blur", "contract_fetch", "contract_lit",
        "contract_fetch_largest", "below_comparison", "placement_disagreements"})
    metrics.erase(metric);
}

std::vector<float> numbers_of(const Ladder& ladder) {
  std::vector<float> all = ladder.doubt.pixels;
  for (const Ladder::RungImage& rung : ladder.rungs)
    all.insert(all.end(), rung.lit.pixels.begin(), rung.lit.pixels.end());
  for (const Ladder::CauseImage& cause : ladder.causes)
    all.insert(all.end(), cause.step.pixels.begin(), cause.step.pixels.end());
  return all;
}

TEST_P(WithoutChecks, AllElseIsTheSame) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = with(GetParam().settings, small(GetParam().scene, 160, 90));
  const auto measured = [&](Checks checks) {
    return bench.measure(settings, CurveOptions{}, MetricSet::searched, checks);
  };
  const Measurement checked = measured(Checks::all);
  const Ladder ladder = checked.ladder;
  PointRecord wanted = checked.record;
  ASSERT_TRUE(wanted.metrics.contains("contract"));
  // Once with what the checked measurement left behind, and once anew.
  for (const bool anew : {false, true}) {
    if (anew) bench.measure(small("plane", 32, 18), std::nullopt);
    const Measurement bare = measured(Checks::none);
    auto metrics = wanted.metrics;
    EXPECT_FALSE(bare.record.metrics.contains("contract"));
    leave_out_checks(metrics);
    for (const auto& [name, value] : metrics) {
      const auto found = bare.record.metrics.find(name);
      ASSERT_NE(found, bare.record.metrics.end()) << name;
      if (name == "residual" || name == "tap_residual") {
        EXPECT_LE(found->second, value) << name;  // that of the worst placement is not computed
        continue;
      }
      EXPECT_TRUE(found->second == value || (std::isnan(value) && std::isnan(found->second)))
          << name << " is " << found->second << ", and with checks " << value;
    }
    EXPECT_EQ(bare.record.metrics.size(), metrics.size());
    EXPECT_EQ(numbers_of(bare.ladder), numbers_of(ladder));
    EXPECT_EQ(bare.ladder.cause.pixels, ladder.cause.pixels);
    EXPECT_EQ(bare.ladder.flags.pixels, ladder.flags.pixels);
    EXPECT_EQ(bare.record.cascades.size(), wanted.cascades.size());
    ASSERT_EQ(bare.record.curve.has_value(), wanted.curve.has_value());
    if (!wanted.curve) continue;
    EXPECT_EQ(bare.record.curve->bias_depth, wanted.curve->bias_depth);
    EXPECT_EQ(bare.record.curve->error, wanted.curve->error);
    EXPECT_EQ(bare.record.curve->acne, wanted.curve->acne);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Lookups, WithoutChecks,
    testing::Values(
        SceneCase{"none", "cube-room", {{"bias.constant", "0.01"}}},
        SceneCase{"box", "cube-room", {{"filter.kind", "box"}, {"filter.size", "5"}, {"map.placements", "2"}}},
        SceneCase{
            "hardware", "hills-walk", {{"filter.kind", "hardware"}, {"map.format", "16"}, {"map.placements", "2"}}},
        SceneCase{"plane", "cube-room", {{"filter.kind", "box"}, {"bias.reference", "receiver_plane"}}},
        SceneCase{"vsm", "cube-room", {{"lookup.kind", "vsm"}, {"filter.kind", "box"}, {"map.placements", "2"}}},
        SceneCase{"point", "cube-room", {{"light.kind", "point"}, {"map.resolution", "128"}, {"map.placements", "2"}}},
        SceneCase{"cascades",
                  "street",
                  {{"map.fit", "sphere"},
                   {"cascades.count", "3"},
                   {"cascades.blend", "0.2"},
                   {"map.resolution", "256"},
                   {"map.placements", "2"}}}),
    [](const auto& one) { return one.param.name; });

// A probe whose tangents are wrong.
struct WrongTangents : Pipeline {
  LookupStage prepare_lookup(gl::Renderer& renderer, const raytrace::Tracer& tracer, const ViewStage& view,
                             const TruthStage& truth, const Technique& technique) override {
    LookupStage lookup = Pipeline::prepare_lookup(renderer, tracer, view, truth, technique);
    for (float& tangent : lookup.probe.tan_theta.pixels) tangent *= 2;
    return lookup;
  }
};

// The probe is compared once for all amounts of the bias, and anew where the bias begins to read tan(theta).
TEST(Checks, OfTheProbeAreRemembered) {
  const Settings constant = with({{"bias.constant", "0.01"}}, small("hills-walk", 160, 90));
  const Settings larger = with({{"bias.constant", "0.02"}}, constant), tangent = with({{"bias.tan", "0.01"}}, constant);
  Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<WrongTangents>());
  const auto excess = [&](const Settings& settings) {
    return bench.measure(settings, std::nullopt).record.metrics.at("rounding_excess");
  };
  const double unread = excess(constant);
  EXPECT_GT(unread, 0);
  EXPECT_LT(unread, 1);
  EXPECT_EQ(excess(larger), unread);
  EXPECT_GT(excess(tangent), 1000);
  EXPECT_EQ(excess(larger), unread);
}

}  // namespace
}  // namespace noonmark::acceptance
