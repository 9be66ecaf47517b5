// Distances to the nearest marked pixel, compared with trying every pixel.
#include "compare/ladder/shadow_edges.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

// Distances are squared whole numbers, or -1 if no pixel is marked.
void expect_distances(const Image<uint8_t>& mask) {
  std::vector<std::pair<int64_t, int64_t>> marked;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.at(x, y)) marked.emplace_back(x, y);
  const Image<float> found = distance_to(mask);
  ASSERT_EQ(found.width, mask.width);
  ASSERT_EQ(found.height, mask.height);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      int64_t nearest = -1;
      for (const auto& [mx, my] : marked) {
        const int64_t squared = (mx - x) * (mx - x) + (my - y) * (my - y);
        if (nearest < 0 || squared < nearest) nearest = squared;
      }
      const float expected = nearest < 0 ? infinity_f : std::sqrt(static_cast<float>(nearest));
      ASSERT_EQ(found.at(x, y), expected) << x << ", " << y << " of " << mask.width << " x " << mask.height;
    }
  }
}

RC_GTEST_PROP(DistanceTo, IsToTheNearestOfAll, ()) {
  Image<uint8_t> mask(*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40));
  const int one_in = *rc::gen::element(1, 2, 10, 100, 1000);
  for (uint8_t& pixel : mask.pixels) pixel = *rc::gen::inRange(0, one_in) == 0;
  expect_distances(mask);
  RC_ASSERT(!testing::Test::HasFatalFailure());
}

TEST(DistanceTo, HoldsAtTheEdgesOfItsRange) {
  expect_distances(Image<uint8_t>(0, 0));
  expect_distances(Image<uint8_t>(7, 5, 0));
  expect_distances(Image<uint8_t>(7, 5, 255));
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 3000), std::pair(3000, 1), std::pair(64, 64)}) {
    Image<uint8_t> mask(width, height, 0);
    expect_distances(mask);
    mask.pixels.back() = 1;
    expect_distances(mask);
    mask.pixels.front() = 7;
    expect_distances(mask);
  }
}

TEST(DistanceTo, IsExactAcrossLargePictures) {
  std::mt19937_64 random(12);
  for (int round = 0; round < 12; ++round) {
    Image<uint8_t> mask(4096, 24, 0);
    for (int i = 0; i < 6 + 20 * (round % 3); ++i)
      mask.at(static_cast<int>(random() % 4096), static_cast<int>(random() % 24)) = 1;
    mask.at(0, static_cast<int>(random() % 24)) = mask.at(4095, static_cast<int>(random() % 24)) = 1;
    expect_distances(mask);
  }
}

TEST(DistanceTo, TellsAHairsBreadthFarFromTheEdge) {
  // In row 0, the point with equal distance to both is 1/12400 of a pixel before column 4100. This is less than the
  // spacing of floats there.
  Image<uint8_t> mask(8192, 2, 0);
  mask.at(1000, 1) = mask.at(7200, 0) = 1;
  expect_distances(mask);
}

}  // namespace
}  // namespace noonmark
