// The offset that lies in the depths of a handed map, of maps that are made by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "measure/given_lookup.h"

namespace noonmark {
namespace {

// SwiftShader moves each surface by up to 1/32 of a texel. A line over four slopes has then a height at 0, and it is none of all
// surfaces.
TEST(MapOffset, AGridIsNoOffset) {
  constexpr int side = 80;
  const auto found = [](const std::vector<double>& moved_texels, double constant) {
    Image<float> exact(side, side), given(side, side);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const auto surface = static_cast<size_t>(x < 20 ? 3 : x < 30 ? 2 : x < 40 ? 1 : 0);
        const double slope = std::array{0.001, 0.0004, 0.002, 0.003}[surface], depth = 0.3 + slope * y;
        exact.at(x, y) = static_cast<float>(depth);
        given.at(x, y) = static_cast<float>(depth + moved_texels[surface] * slope + constant);
      }
    return map_offset(given, MapDepths(exact), DepthFormat::d24);
  };
  const MapOffset moved = found({0.017, -0.03, 0.02, -0.025}, 0);
  EXPECT_GT(std::abs(moved.constant), 0x1p-24 + 1e-6) << "or the test shows nothing: what rounding does";
  EXPECT_FALSE(moved.in_map());
  EXPECT_TRUE(found({0, 0, 0, 0}, 1e-5).in_map());
  EXPECT_TRUE(found({0.017, -0.03, 0.02, -0.025}, 1e-3).in_map());
  EXPECT_TRUE(found({0.5, 0.5, 0.5, 0.5}, 0).in_map());
}

}  // namespace
}  // namespace noonmark
