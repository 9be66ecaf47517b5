#include "compare/judge/map_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace noonmark {
namespace {

constexpr int side = 20;

LightFrame frame_of(int tiles = 1) {
  LightFrame frame;
  frame.resolution = frame.rows = side;
  frame.tiles = tiles;
  frame.near_m = 0, frame.far_m = 10;
  return frame;
}

// Over a slope of 0.02 m of depth for each texel along x, from 4 m on. depth: of the other map, of a texel and its exact depth.
double excess(const LightFrame& frame, DepthFormat format, auto depth, double slope_m = 0.02) {
  MapDistance apart(frame, format);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double exact = (4 + slope_m * x) / frame.far_m;
      apart.add({x, y}, static_cast<float>(exact), static_cast<float>(depth(x, y, exact)));
    }
  EXPECT_EQ(apart.texels(), size_t{side * side});
  return apart.excess();
}

TEST(MapDistance, ASoundMapIsTheScenes) {
  const LightFrame frame = frame_of();
  const auto same = [](int, int, double exact) { return exact; };
  EXPECT_LT(excess(frame, DepthFormat::d32f, same), 1e-4);
  // What a grid of 1/16 of a texel does to a slope along one axis; and a sixteenth of the texels beside a silhouette.
  EXPECT_LT(excess(frame, DepthFormat::d24, [](int, int, double exact) { return exact + 0.02 / 16 / 10; }), 0.3);
  EXPECT_LT(excess(frame, DepthFormat::d24, [](int x, int, double exact) { return x == 0 ? 1 : exact; }), 1e-4);
  // All depths alike: a step of the format is no other map.
  const auto rounded = [](int, int, double exact) { return exact + 0.7 / 65535; };
  EXPECT_LE(excess(frame, DepthFormat::d16, rounded, 0), 1);
  EXPECT_GT(excess(frame, DepthFormat::d24, rounded, 0), 1) << "which 24 bits do not round to";
}

TEST(MapDistance, AnotherMapIsNot) {
  const LightFrame frame = frame_of();
  EXPECT_GT(excess(frame, DepthFormat::d24,
                   [](int x, int y, double exact) { return 2 * x < side && 2 * y < side ? exact : 1.0; }),
            10);
  EXPECT_GT(excess(frame, DepthFormat::d24, [](int, int, double exact) { return exact + 0.002; }), 2) << "2 cm";
  EXPECT_EQ(excess(frame, DepthFormat::d24, [](int, int, double) { return std::numeric_limits<double>::quiet_NaN(); }),
            std::numeric_limits<double>::infinity());
}

TEST(MapDistance, SaysHowFarInMetres) {
  const LightFrame frame = frame_of();
  MapDistance apart(frame, DepthFormat::d24);
  EXPECT_TRUE(std::isnan(apart.excess()) && std::isnan(apart.off_m()) && std::isnan(apart.spread_m()));
  for (int x = 0; x < side; ++x)
    apart.add({x, 0}, 0.4f + 0.01f * static_cast<float>(x), 0.45f + 0.01f * static_cast<float>(x));
  EXPECT_NEAR(apart.off_m(), 0.5, 1e-5);
  EXPECT_NEAR(apart.spread_m(), 1.8, 1e-5) << "from the second of 20 depths to the last but two";
}

}  // namespace
}  // namespace noonmark
