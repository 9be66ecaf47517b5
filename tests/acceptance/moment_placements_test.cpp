// All placements of the grid of a map of moments: every number equals that of measuring each placement by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "technique/placements.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

struct PlacedMoments {
  std::string name;
  std::vector<Assignment> set;
};
void PrintTo(const PlacedMoments& c, std::ostream* out) { *out << c.name; }

const std::vector<PlacedMoments> placed_moments = {
    {"vsm", {}},
    {"vsm_reduced", {{"lookup.reduction", "0.2"}}},
    {"vsm_wrapped", {{"map.wrap", "repeat"}, {"map.extent_m", "5"}}},
    {"esm", {{"lookup.kind", "esm"}, {"filter.kind", "gaussian"}}},
    {"evsm4", {{"lookup.kind", "evsm4"}, {"lookup.floor", "1e-4"}, {"map.moments", "32f"}}},
    {"msm", {{"lookup.kind", "msm"}, {"bias.constant", "0.002"}}},
    {"three_vsm", {{"lookup.kind", "three_vsm"}, {"filter.kind", "none"}, {"lookup.reduction_span", "0.65"}}},
    {"spot", {{"scene.name", "spot-room"}, {"filter.size", "3"}}},
    {"halved", {{"lookup.level", "1"}, {"filter.size", "3"}}},
    {"halved_twice", {{"lookup.kind", "msm"}, {"lookup.level", "2"}, {"filter.kind", "none"}}},
    {"beyond_far", {{"map.far_m", "7"}}},
    {"strips", {{"filter.size", "9"}}},
};

class EveryMomentPlacement : public testing::TestWithParam<PlacedMoments> {};

// The ladder's causes are floats, each within 2^-24 of its double, and a sum over receivers is no worse.
constexpr double rounding_of_images = 0x1p-24;
TEST_P(EveryMomentPlacement, HasTheNumbersOfMeasuringItByItself) {
  Settings settings = with(GetParam().set, with_moments());
  const CurveOptions options{{0.004, 0.004}, {}};
  // Few taps are held at a time, so that there are several strips.
  const size_t kept_bytes = GetParam().name == "strips" ? size_t{1} << 22 : most_kept_tap_bytes;
  Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<Pipeline>(kept_bytes));
  Settings all = settings;
  all.map.placements = 2;
  const std::map<std::string, double> metrics = bench.measure(all, options).record.metrics;
  EXPECT_EQ(metrics.at("placement_disagreements"), 0);
  EXPECT_EQ(metrics.at("acne_worst"), 0);

  const Placements placements(2);
  std::map<std::string, std::vector<double>> of_each;
  double low = 0, high = 1, shown_at_worst = 0, worst = -1;
  for (int p = 0; p < placements.count(); ++p) {
    Settings one = settings;
    // Over one texel of the level that is read.
    const double block = std::exp2(settings.lookup["level"]);
    one.map.shift_u_texels += block * placements.shift_texels(p).x;
    one.map.shift_v_texels += block * placements.shift_texels(p).y;
    const Measurement m = bench.measure(one, options);
    for (const char* name : {"peter_panning", "aliasing", "aliasing_dark", "aliasing_light", "aliasing_rms", "coverage",
                             "coverage_dark", "coverage_light", "leak", "over_darkening", "reduction"})
      of_each[name].push_back(m.record.metrics.at(name));
    of_each["error"].push_back(error_on_exact_map(m.ladder));
    if (of_each["error"].back() > worst) worst = of_each["error"].back(), shown_at_worst = metric(m, "error");
    if (m.record.metrics.contains("reduction_min")) {
      low = std::max(low, metric(m, "reduction_min"));
      high = std::min(high, metric(m, "reduction_max"));
    } else {
      high = -1;
    }
  }
  for (const auto& [name, values] : of_each) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    EXPECT_NEAR(metrics.at(name + "_mean"), mean, rounding_of_images) << name;
    EXPECT_NEAR(metrics.at(name + "_worst"), *std::max_element(values.begin(), values.end()), rounding_of_images)
        << name;
    EXPECT_NEAR(metrics.at(name + "_best"), *std::min_element(values.begin(), values.end()), rounding_of_images)
        << name;
  }
  EXPECT_EQ(metrics.at("error_worst_shown"), shown_at_worst);
  EXPECT_EQ(metrics.contains("reduction_min_worst"), low <= high);
  if (low <= high && settings.lookup["reduction_span"] == 0) {
    EXPECT_EQ(metrics.at("reduction_min_worst"), low);
    EXPECT_EQ(metrics.at("reduction_max_worst"), high);
  }
}
INSTANTIATE_TEST_SUITE_P(Cases, EveryMomentPlacement, testing::ValuesIn(placed_moments),
                         [](const auto& test) { return test.param.name; });

// The maps of cascades lie independently of each other: the worst is the sum of what each has at its own. The mean is that
// of shifting all of them alike.
TEST(MomentPlacements, OfCascadesAddUp) {
  Workbench bench(gl::DebugMode::fatal);
  Settings settings = with({{"lookup.kind", "vsm"},
                            {"filter.kind", "box"},
                            {"filter.size", "3"},
                            {"cascades.count", "2"},
                            {"map.fit", "view"},
                            {"map.resolution", "128"}},
                           small("street", 160, 90));
  const Placements placements(2);
  double mean = 0, worst = 0;
  for (int p = 0; p < placements.count(); ++p) {
    Settings one = settings;
    one.map.shift_u_texels += placements.shift_texels(p).x;
    one.map.shift_v_texels += placements.shift_texels(p).y;
    const double error = error_on_exact_map(bench.measure(one, std::nullopt).ladder);
    mean += error / placements.count();
    worst = std::max(worst, error);
  }
  settings.map.placements = placements.side();
  const Measurement m = bench.measure(settings, CurveOptions{});
  EXPECT_EQ(metric(m, "placement_disagreements"), 0);
  EXPECT_NEAR(metric(m, "error_mean"), mean, rounding_of_images);
  EXPECT_GE(metric(m, "error_worst"), worst - rounding_of_images);
  EXPECT_GT(metric(m, "leak_worst"), metric(m, "leak_best"));
  EXPECT_FALSE(m.record.metrics.contains("reduction_min_worst"));
}

}  // namespace
}  // namespace noonmark::acceptance
