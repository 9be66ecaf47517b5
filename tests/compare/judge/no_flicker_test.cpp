// The sentence about a motion of which no point of the world is left.
#include "compare/judge/no_flicker.h"

#include <gtest/gtest.h>

#include <array>

namespace noonmark {
namespace {

PointRecord frame_with(double points, double outside, double hidden, double unlit) {
  PointRecord point;
  point.metrics = {{"counted", 1000},
                   {"flicker_points", points},
                   {"flicker_outside", outside},
                   {"flicker_hidden", hidden},
                   {"flicker_unlit", unlit}};
  return point;
}

TEST(NoFlicker, NamesEachReasonAndAdvisesOnTheLargest) {
  const auto holds = [](const PointRecord& point, const std::string& text) {
    EXPECT_NE(why_no_flicker(point).find(text), std::string::npos) << why_no_flicker(point);
  };
  holds(frame_with(0, 900, 100, 0),
        "of 1000 that can be judged in this frame 900 are not in the next frame's picture, ");
  holds(frame_with(0, 900, 100, 0), "picture, 100 are hidden there, or seen from their back; make the camera's step");
  holds(frame_with(0, 0, 1000, 0), "this frame 1000 are hidden there");
  holds(frame_with(0, 100, 0, 900), "900 face away from the next frame's light");
  holds(frame_with(0, 100, 0, 900), "; make the light's step smaller");
  holds(frame_with(0, 100, 0, 0), "900 have another truth there; make the light's step smaller");
}

TEST(NoFlicker, IsSilentWhereFlickerIsMeasuredOrThePictureIsPoor) {
  EXPECT_EQ(why_no_flicker(frame_with(1, 999, 0, 0)), "");
  EXPECT_EQ(why_no_flicker(PointRecord()), "") << "a point without a motion";
  PointRecord poor = frame_with(0, 0, 0, 0);
  poor.metrics["counted"] = 0;
  EXPECT_EQ(why_no_flicker(poor), "");
}

TEST(NoFlicker, NotesHowManyPointsHaveNone) {
  std::array<PointRecord, 3> points{frame_with(10, 0, 0, 0), frame_with(0, 1000, 0, 0), frame_with(0, 1000, 0, 0)};
  for (size_t i = 0; i < points.size(); ++i) points[i].id = static_cast<int64_t>(i);
  EXPECT_EQ(no_flicker_note(points).find("2 of 3 points have no flicker; of point 1, flicker is not measured"), 0u)
      << no_flicker_note(points);
  EXPECT_EQ(no_flicker_note({points.data(), 2}).find("point 1: flicker is not measured"), 0u);
  EXPECT_EQ(no_flicker_note({points.data(), 1}), "");
}

}  // namespace
}  // namespace noonmark
