// Times are measured if they are asked for. They change no other number.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "compare/results/metrics.h"
#include "measure/pass_times.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

TEST(Times, AreIntervalsOfEachPassAndChangeNothingElse) {
  Settings settings = small("cube-room", 96, 54);
  settings.bias["constant"] = 0.01;
  Workbench bench(gl::DebugMode::fatal);
  const auto numbers = [&] {
    const Measurement m = bench.measure(settings, CurveOptions{});
    std::map<std::string, double> metrics = m.record.metrics;
    std::erase_if(metrics, [](const auto& metric) { return std::isnan(metric.second); });
    return std::tuple(metrics, m.ladder.shown().pixels, m.record.curve->error);
  };
  const auto before = numbers();
  const TimeMetrics times = time_passes(bench, settings);
  EXPECT_EQ(numbers(), before) << "the bench is as it was before";
  EXPECT_EQ(times.size(), 9u);
  for (const char* name : {"map", "lookup", "shadow"}) {
    const std::string stem(name);
    EXPECT_GT(times.at(stem + "_low_ms"), 0) << name;
    EXPECT_LE(times.at(stem + "_low_ms"), times.at(stem + "_ms")) << name;
    EXPECT_LE(times.at(stem + "_ms"), times.at(stem + "_high_ms")) << name;
  }
  for (const auto& [name, value] : times) EXPECT_EQ(std::get<0>(before).count(name), 0u) << name;
}

TEST(Times, OfEveryKindOfLightAndMap) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* scene : {"spot-room", "point-room"}) {
    Settings settings = small(scene, 48, 27);
    EXPECT_GT(time_passes(bench, settings).at("shadow_ms"), 0) << scene;
    settings.bias["caster_normal_offset"] = 0.01;  // draws moved vertices
    EXPECT_GT(time_passes(bench, settings).at("shadow_ms"), 0) << scene;
  }
}

}  // namespace
}  // namespace noonmark::acceptance
