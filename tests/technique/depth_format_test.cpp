#include "technique/depth_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace noonmark {
namespace {

// As a map of n bits is read: k / (2^n - 1), or the next float.
std::vector<float> depths_of(DepthFormat format, double least, double most) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(least, most);
  std::vector<float> depths{0, 1};
  const double steps = 1 / depth_step(format, 0.5f);
  for (int i = 0; i < 1000; ++i) {
    double depth = anywhere(random);
    if (format != DepthFormat::d32f) depth = std::round(depth * steps) / steps;
    const float stored = static_cast<float>(depth);
    depths.push_back(i % 3 || stored == 0 ? stored : std::nextafter(stored, i % 2 ? 0.0f : 1.0f));
  }
  return depths;
}

TEST(ToldFormat, IsThatOfTheDepths) {
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f}) {
    const std::vector<float> depths = depths_of(format, 0.01, 1);
    EXPECT_EQ(told_format(depths), format);
    EXPECT_TRUE(are_held_by(format, depths));
    EXPECT_TRUE(are_held_by(DepthFormat::d32f, depths));
  }
  EXPECT_FALSE(are_held_by(DepthFormat::d16, depths_of(DepthFormat::d24, 0.01, 1)));
  EXPECT_FALSE(are_held_by(DepthFormat::d24, depths_of(DepthFormat::d16, 0.01, 1)));
}

TEST(ToldFormat, IsNotSaidWhereEveryFloatIsADepthOf24Bits) {
  for (const DepthFormat format : {DepthFormat::d24, DepthFormat::d32f}) {
    const std::vector<float> depths = depths_of(format, 0.25, 1);
    EXPECT_EQ(told_format(depths), std::nullopt);
    EXPECT_TRUE(are_held_by(DepthFormat::d24, depths));
  }
}

}  // namespace
}  // namespace noonmark
