// FLIP compared with the closed form where there is one, and with its authors' program.
#include "compare/ladder/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace noonmark {
namespace {

using Picture8 = Image<glm::u8vec3>;

Picture8 painted(int width, int height, const std::function<glm::ivec3(int, int)>& color) {
  Picture8 picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) picture.at(x, y) = glm::u8vec3(color(x, y));
  return picture;
}
Picture8 of_color(glm::ivec3 color) {
  return painted(40, 30, [=](int, int) { return color; });
}

// Lightness 100 and 0, and no chroma: HyAB is 100. The largest distance is that of green (87.737; -86.185, 83.181) and
// blue (32.303; 79.197, -107.864), CIELAB of sRGB's primaries, whose chroma Hunt's effect scales by a hundredth of the
// lightness.
TEST(Flip, OfBlackAndWhiteIsAClosedForm) {
  const double a = 0.87737 * -86.185 - 0.32303 * 79.197, b = 0.87737 * 83.181 + 0.32303 * 107.864;
  const double largest = std::pow(87.737 - 32.303 + std::hypot(a, b), 0.7);
  const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - 0.4 * largest) / (0.6 * largest);
  const Flip found = flip(of_color({0, 0, 0}), of_color({255, 255, 255}));
  // The detectors' weights sum to 0 up to 1e-15, of which the root is taken.
  EXPECT_NEAR(found.mean, expected, 1e-5);
  const auto [least, most] = std::minmax_element(found.error.pixels.begin(), found.error.pixels.end());
  EXPECT_NEAR(*least, *most, 1e-6);
  EXPECT_NEAR(flip(of_color({0, 255, 0}), of_color({0, 0, 255})).mean, 1, 1e-6);
}

TEST(Flip, OfAlikePicturesIsZeroAndOfTwoTheSameBothWays) {
  const Picture8 a = painted(150, 90, [](int x, int y) { return glm::ivec3(x, 2 * y, (x * y) % 256); });
  Picture8 b = a;
  EXPECT_EQ(flip(a, a).mean, 0);
  b.at(70, 40) = {255, 0, 255};
  const Flip found = flip(a, b);
  EXPECT_GT(found.mean, 0);
  EXPECT_EQ(found.error.pixels, flip(b, a).error.pixels);
  // FLIP's filters reach 10 pixels at 67 pixels per degree, so a difference changes nothing further away.
  EXPECT_EQ(flip_reach(), 10);
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 150; ++x) {
      const bool near = std::max(std::abs(x - 70), std::abs(y - 40)) <= 10;
      ASSERT_TRUE(near || found.error.at(x, y) == 0) << x << ", " << y;
    }
  EXPECT_TRUE(std::isnan(flip(Picture8(), Picture8()).mean));
  EXPECT_THROW(flip(a, Picture8(90, 150)), std::logic_error);
}

// The picture is cut into tiles, and of a tile only a part is evaluated. Neither may show.
TEST(Flip, OfAPointIsTheSameWhereverItLies) {
  constexpr int reach = 12;  // more than that of the filters
  const auto around = [&](int x, int y) {
    const Picture8 grey = painted(200, 150, [](int, int) { return glm::ivec3(90); });
    Picture8 other = grey;
    other.at(x, y) = {255, 30, 0};
    other.at(x + 2, y - 1) = {0, 30, 255};
    const Flip found = flip(grey, other);
    std::vector<float> errors;
    for (int j = y - reach; j <= y + reach; ++j)
      for (int i = x - reach; i <= x + reach; ++i) errors.push_back(found.error.at(i, j));
    return errors;
  };
  const std::vector<float> expected = around(32, 32);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.1f);
  for (const auto& [x, y] : {std::pair(63, 63), {64, 64}, {65, 40}, {70, 127}, {128, 60}, {118, 74}})
    EXPECT_EQ(around(x, y), expected) << x << ", " << y;
}

// Outside the picture FLIP repeats the pixels at its border. So a picture with such a border around it has the same errors inside.
TEST(Flip, GoesOnBeyondTheBorderWithItsColours) {
  constexpr int width = 75, height = 37, more = 24;  // twice the reach and more
  const auto colors = [](int x, int y) { return glm::ivec3((7 * x) % 256, (x * y) % 256, (11 * y) % 256); };
  const auto wrong = [](int x, int y) { return (5 * x + 3 * y) % 97 == 0; };
  const auto flipped = [&](int around) {
    const auto picture = [&](bool differs) {
      return painted(width + 2 * around, height + 2 * around, [=](int i, int j) {
        const int x = std::clamp(i - around, 0, width - 1), y = std::clamp(j - around, 0, height - 1);
        return differs && wrong(x, y) ? glm::ivec3(255, 0, 90) : colors(x, y);
      });
    };
    return flip(picture(false), picture(true)).error;
  };
  const Image<float> alone = flipped(0), within = flipped(more);
  EXPECT_GT(alone.at(0, 0), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) ASSERT_EQ(alone.at(x, y), within.at(x + more, y + more)) << x << ", " << y;
}

// The further away, the less is seen of fine lines.
TEST(Flip, FallsWithTheDistance) {
  const Picture8 grey = painted(64, 64, [](int, int) { return glm::ivec3(128); });
  const Picture8 lines = painted(64, 64, [](int x, int) { return glm::ivec3(128 + (x % 2 ? 30 : -30)); });
  EXPECT_LT(flip(grey, lines, 60).mean, 0.7 * flip(grey, lines, 20).mean);
}

struct OfTheAuthors {
  const char* name;
  Picture8 reference, test;
  double mean;
};

// What the authors' program prints as Mean (NVlabs/flip at 1eb247c: `flip -r reference.png -t test.png`, built from
// src/cpp/tool with GCC 12). It computes in float, where the detectors find about 1e-7 on an even picture, and the
// difference of two such numbers counts with its root, 3e-4.
TEST(Flip, IsWhatTheAuthorsProgramPrints) {
  constexpr int width = 96, height = 64;
  const auto picture = [](const std::function<glm::ivec3(int, int)>& color) { return painted(width, height, color); };
  const auto even = [&](int r, int g, int b) { return picture([=](int, int) { return glm::ivec3(r, g, b); }); };
  const auto edge_at = [&](int column) {
    return picture([=](int x, int) { return glm::ivec3(x >= column ? 200 : 40); });
  };
  const OfTheAuthors pairs[] = {
      {"black and white", even(0, 0, 0), even(255, 255, 255), 0.967325},
      {"green and blue", even(0, 255, 0), even(0, 0, 255), 1},
      {"an edge moved by three pixels", edge_at(40), edge_at(43), 0.054703},
      {"dots", even(120, 120, 120), picture([](int x, int y) {
         return glm::ivec3(x >= 4 && y >= 4 && (x - 4) % 9 == 0 && (y - 4) % 9 == 0 ? 10 : 120);
       }),
       0.019586},
      {"colours",
       picture([](int x, int y) { return glm::ivec3((x * 7 + y * 3) % 256, (x * x + 5 * y) % 256, (x * y) % 256); }),
       picture([](int x, int y) {
         return glm::ivec3((x * 7 + y * 3 + (x / 8 + y / 8) % 2 * 40) % 256, (x * x + 5 * y) % 256, (x * y + x) % 256);
       }),
       0.284508},
  };
  for (const OfTheAuthors& pair : pairs)
    EXPECT_NEAR(flip(pair.reference, pair.test).mean, pair.mean, 1e-4) << pair.name;
}

}  // namespace
}  // namespace noonmark
