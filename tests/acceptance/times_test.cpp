// Times are measured if they are asked for. They change no other number.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/store/metrics.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

bool is_time(const std::string& name) { return find_metric(name).unit == "ms"; }

TEST(Times, AreThereIfAskedForAndChangeNothingElse) {
  const Settings settings = small("cube-room", 96, 54);
  // One bench: the map that it remembers without a time must not be taken for a timed one.
  Workbench bench(gl::DebugMode::fatal);
  const Measurement untimed = bench.measure(settings, CurveOptions{}),
                    timed = bench.measure(settings, CurveOptions{}, {}, true);
  size_t times = 0;
  for (const auto& [name, value] : timed.record.metrics) {
    const auto other = untimed.record.metrics.find(name);
    if (is_time(name)) {
      ++times;
      EXPECT_GT(value, 0) << name;
      EXPECT_EQ(other, untimed.record.metrics.end()) << name;
      continue;
    }
    ASSERT_NE(other, untimed.record.metrics.end()) << name;
    EXPECT_TRUE(value == other->second || (std::isnan(value) && std::isnan(other->second))) << name;
  }
  EXPECT_EQ(times, 3u);
  EXPECT_EQ(timed.record.metrics.size(), untimed.record.metrics.size() + times);
  EXPECT_EQ(timed.ladder.shown().pixels, untimed.ladder.shown().pixels);
  EXPECT_EQ(timed.record.curve->error, untimed.record.curve->error);
}

}  // namespace
}  // namespace noonmark::acceptance
