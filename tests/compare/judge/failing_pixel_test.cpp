// What a broken bound shows: the worst pixel of its own metric, and the value that broke it.
#include <gtest/gtest.h>

#include <string>

#include "compare/judge/bounds.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

BoundResult broken(const std::string& metric, std::optional<double> max, std::optional<double> min = {}) {
  BoundResult bound;
  bound.metric = metric;
  bound.join = "worst";
  bound.max = max;
  bound.min = min;
  bound.found = max ? *max + 1 : *min - 1;
  return bound;
}

// What fails by one cause is not shown where another one is worse, and what no pixel has is not shown at all.
TEST(FailingPixel, IsOfTheBoundsOwnMetric) {
  PointRecord point = sample_point(1);
  point.settings["map.placements"] = "4";
  const auto pixel = [&](const std::string& metric) { return failing_pixel(broken(metric, 0.1), point); };
  ASSERT_TRUE(pixel("acne"));
  EXPECT_EQ(pixel("acne")->x, 56);
  EXPECT_EQ(pixel("acne_worst")->x, 56) << "of the placement as set";
  EXPECT_EQ(pixel("error")->x, 12);
  EXPECT_EQ(pixel("wrong")->y, 34);
  EXPECT_EQ(pixel("peter_panning_gap_m")->y, 10);
  EXPECT_FALSE(pixel("peter_panning")) << "no pixel has any";
  for (const char* none : {"map_ms", "texel_work", "window_width_m", "lit", "best_error"})
    EXPECT_FALSE(pixel(none)) << none;
  EXPECT_FALSE(failing_pixel(broken("acne", {}, 0.1), point)) << "too little acne is at no pixel";
  BoundResult held = broken("acne", 0.1);
  held.held = true;
  EXPECT_FALSE(failing_pixel(held, point));
}

TEST(FoundText, DoesNotReadAsTheLimitThatItBreaks) {
  BoundResult bound = broken("acne", 0.005);
  bound.found = 0.0050000001;
  EXPECT_EQ(bound_text(bound), "acne <= 0.5%");
  EXPECT_NE(found_text(bound, {}), "0.5%");
  bound.found = 1.0 / 3;
  EXPECT_EQ(found_text(bound, {}), "33.33%");
  bound = broken("peter_panning_gap_m", 0.0012345);
  EXPECT_EQ(bound_text(bound), "peter_panning_gap_m <= 0.0012345 m") << "a limit is as it was typed";
}

}  // namespace
}  // namespace noonmark
