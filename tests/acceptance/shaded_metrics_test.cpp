// A measurement without the metrics of the shaded frame: nothing else changes.
#include <gtest/gtest.h>

#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

TEST(ShadedMetrics, AreLeftOutAlone) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = with({{"map.placements", "2"}}, small("cube-room", 120, 68));
  auto all = bench.measure(settings, CurveOptions{}).record.metrics;
  const auto few = bench.measure(settings, CurveOptions{}, ShadedMetrics::no).record.metrics;
  for (const char* metric : {"shaded_rmse", "flip"}) {
    EXPECT_GT(all[metric], 0) << metric;
    EXPECT_EQ(shaded_metrics_for(metric), ShadedMetrics::yes) << metric;
    all.erase(metric);
  }
  EXPECT_EQ(few, all);
  for (const auto& [metric, value] : few) EXPECT_EQ(shaded_metrics_for(metric), ShadedMetrics::no) << metric;
}

}  // namespace
}  // namespace noonmark::acceptance
