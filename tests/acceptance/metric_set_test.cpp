// A measurement without the metrics that a search does not read: nothing else changes.
#include <gtest/gtest.h>

#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

TEST(MetricSet, AreLeftOutAlone) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = with({{"map.placements", "2"}}, small("cube-room", 120, 68));
  auto all = bench.measure(settings, CurveOptions{}).record.metrics;
  const auto few = bench.measure(settings, CurveOptions{}, MetricSet::searched).record.metrics;
  for (const char* metric :
       {"shaded_rmse", "flip", "map_used", "undersampled", "perspective_aliasing", "perspective_aliasing_p95"}) {
    EXPECT_GT(all[metric], 0) << metric;
    EXPECT_EQ(metric_set_for(metric), MetricSet::all) << metric;
    all.erase(metric);
  }
  EXPECT_EQ(few, all);
  for (const auto& [metric, value] : few) EXPECT_EQ(metric_set_for(metric), MetricSet::searched) << metric;
}

}  // namespace
}  // namespace noonmark::acceptance
