// The curve's error against the light's true size, compared with renders at the same bias.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

class SoftCurve : public testing::TestWithParam<const char*> {};

TEST_P(SoftCurve, IsTheErrorOfTheRenderAtEachBias) {
  Workbench bench(gl::DebugMode::fatal);
  const CurveOptions options{{}, {0, 0.001, 0.01, 0.02, 0.1}};
  std::optional<BiasCurve> curve;
  for (size_t i = 0; i < options.bias_depth.size(); ++i) {
    Settings settings = with({{"filter.kind", GetParam()}, {"light.angular_diameter_deg", "6"}}, small("cube-room"));
    settings.bias["constant"] = options.bias_depth[i];
    const Measurement m = bench.measure(settings, options);
    if (!curve) curve = m.record.curve;
    ASSERT_TRUE(curve);
    // The metric is a sum of floats, and blended weights are rounded in the sampler.
    EXPECT_NEAR(curve->error_soft[i], metric(m, "error_soft"), rounding_of_steps) << options.bias_depth[i];
    EXPECT_GT(std::abs(metric(m, "error_soft") - metric(m, "error")), 1e-4) << "the light's size must matter";
  }
}
INSTANTIATE_TEST_SUITE_P(Filters, SoftCurve, testing::Values("none", "box", "hardware", "poisson", "castano"),
                         [](const auto& test) { return std::string(test.param); });

// Without a size the two errors are the same number.
TEST(SoftCurveOfAPoint, IsTheHardErrorOfALightWithoutSize) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(small("cube-room"), CurveOptions{});
  ASSERT_TRUE(m.record.curve);
  EXPECT_EQ(m.record.curve->error_soft, m.record.curve->error);
}

}  // namespace
}  // namespace noonmark::acceptance
