// Flicker is booked by class so that the classes are never negative and add up exactly.
#include "compare/ladder/flicker.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace noonmark {
namespace {

using Parts = std::array<double, flicker_steps>;

TEST(FlickerParts, AreBookedWhereTheChangeBeginsToLast) {
  EXPECT_EQ(flicker_parts({1, 0, 0, 0, 0}), (Parts{1, 0, 0, 0}));
  EXPECT_EQ(flicker_parts({1, 1, 0, 0, 0}), (Parts{0, 1, 0, 0}));
  EXPECT_EQ(flicker_parts({0, 0, 0, 1, 1}), (Parts{0, 0, 1, 0}));
  EXPECT_EQ(flicker_parts({1, 1, 1, 1, 0}), (Parts{0, 0, 0, 1}));
  EXPECT_EQ(flicker_parts({1, 1, 0, 1, 0}),
            (Parts{0, 0, 0, 1}));  // the depth undid what the grid did; the kernel lasts
  EXPECT_EQ(flicker_parts({1, 0, 1, 1, 1}), (Parts{0, 0, 0, 0}));  // undone: no flicker, so no part
  EXPECT_EQ(flicker_parts({0, 0.25, 0.5, 0.75, 1}), (Parts{0.25, 0.25, 0.25, 0.25}));
  EXPECT_EQ(flicker_parts({0.5, 0.5, 1, 0, 0.25}), (Parts{0, 0, 0.25, 0}));  // the grid's step is against the change
}

// Multiples of 1/64 add without rounding.
RC_GTEST_PROP(FlickerParts, AddUpAndAreNotNegative, ()) {
  std::array<double, flicker_steps + 1> r{};
  for (double& v : r) v = *rc::gen::inRange(0, 65) / 64.0;
  const Parts parts = flicker_parts(r);
  double sum = 0;
  for (double part : parts) {
    RC_ASSERT(part >= 0);
    sum += part;
  }
  RC_ASSERT(sum == std::abs(r[4] - r[0]));
  // A lookup that is the one before brings nothing.
  r[2] = r[1];
  RC_ASSERT(flicker_parts(r)[1] == 0);
}

Image<float> row_of(std::initializer_list<float> values) {
  Image<float> image(static_cast<int>(values.size()), 1);
  std::copy(values.begin(), values.end(), image.pixels.begin());
  return image;
}

FlickerPoints points_of(Image<uint8_t> counted, uint64_t shared = 0, uint64_t truth_changed = 0) {
  Image<uint8_t> held(counted.width, counted.height, 1);
  return {std::move(counted), std::move(held), shared, truth_changed};
}

TEST(Flicker, CountsOnlyWhatBothFramesSeeWithOneTruth) {
  Image<uint8_t> counted(5, 1, 1);
  counted[3] = 0;
  FlickerPoints points = points_of(counted, 6, 2);
  points.held[4] = 0;
  const Image<float> now = row_of({1, 0, 0.5f, 1, 1}), choice = row_of({0.75f, 0, 0.5f, 0, 0}),
                     grid = row_of({0, 0, 0.5f, 0, 0}), depth = row_of({0, 0, 0.5f, 0, 0}),
                     next = row_of({0, 0, 0.75f, 0, 0.5f});
  const Flicker flicker = flicker_of({now, choice, grid, depth, next}, points);
  const auto metrics = measure_flicker(flicker);
  EXPECT_EQ(metrics.at("flicker_points"), 4);
  EXPECT_EQ(metrics.at("flicker"), 1.75 / 4);
  EXPECT_EQ(metrics.at("flicker_changed"), 3.0 / 4);
  EXPECT_EQ(metrics.at("flicker_cascade"), 0.25 / 4);
  EXPECT_EQ(metrics.at("flicker_grid"), 0.75 / 4);
  EXPECT_EQ(metrics.at("flicker_depth"), 0);
  EXPECT_EQ(metrics.at("flicker_kernel"), 0.25 / 4);
  EXPECT_EQ(metrics.at("flicker_coverage"), 0.5 / 4);
  EXPECT_EQ(metrics.at("flicker_truth"), 2.0 / 6);
  EXPECT_EQ(flicker.parts[0][3], 0);
}

TEST(Flicker, OfNoPointsHasNoFractions) {
  const Image<float> one(1, 1, 1);
  const auto metrics = measure_flicker(flicker_of({one, one, one, one, one}, points_of(Image<uint8_t>(1, 1, 0))));
  EXPECT_EQ(metrics, (std::map<std::string, double>{{"flicker_points", 0},
                                                    {"flicker_outside", 0},
                                                    {"flicker_hidden", 0},
                                                    {"flicker_unlit", 0},
                                                    {"flicker_ambiguous", 0}}));
}

TEST(Flicker, OfALookupThatIsNotFiniteIsNotFinite) {
  const Image<float> one(1, 1, 1), none(1, 1, std::nanf(""));
  const FlickerPoints point = points_of(Image<uint8_t>(1, 1, 1), 1);
  EXPECT_TRUE(std::isnan(measure_flicker(flicker_of({one, one, one, one, none}, point)).at("flicker")));
  EXPECT_TRUE(std::isnan(measure_flicker(flicker_of({one, one, none, one, one}, point)).at("flicker_grid")));
}

}  // namespace
}  // namespace noonmark
