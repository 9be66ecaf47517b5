#include "compare/ladder/wrong_patch.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/compare/ladder/measured_picture.h"

namespace noonmark {
namespace {

void make_wrong(Picture& p, int x, int y) { p.rungs(x, y, {1, 1, 1, 1, 0, 0}); }

// A stripe `thick` pixels high that rises by a pixel every `run` columns has width * thick pixels, and does not fall
// apart where it rises, at a corner if it is one pixel thick. A second stripe, one row apart or more, is a patch of its
// own.
RC_GTEST_PROP(WrongPatch, IsTheLargestStripe, ()) {
  const int width = *rc::gen::inRange(1, 40), thick = *rc::gen::inRange(1, 4), run = *rc::gen::inRange(1, 5);
  const int between = *rc::gen::inRange(1, 4), second = *rc::gen::inRange(1, 4);
  Picture p(width, width + 3 * 4 + 2);
  for (int x = 0; x < width; ++x)
    for (int row = 0; row < thick + between + second; ++row)
      if (row < thick || row >= thick + between) make_wrong(p, x, row + x / run);
  // One row apart and rising with every column, the stripes touch at corners.
  const bool touch = between == 1 && width > run;
  RC_ASSERT(largest_wrong_patch(p.ladder) == width * (touch ? thick + second : std::max(thick, second)));
}

TEST(WrongPatch, HasPixelsOnTheWrongSideOfOneHalf) {
  Picture p(5, 1);
  EXPECT_EQ(largest_wrong_patch(p.ladder), 0);
  p.rungs(1, 0, {1, 1, 1, 1, 0.5f, 0.5f});  // lit, and no more wrong than right
  EXPECT_EQ(largest_wrong_patch(p.ladder), 0);
  p.rungs(2, 0, {1, 1, 1, 1, 0.25f, 0.25f});
  p.rungs(3, 0, {0, 0, 0, 0, 0.5f, 0.5f});
  EXPECT_EQ(largest_wrong_patch(p.ladder), 2) << "one too dark, one too light: one patch";
  EXPECT_DOUBLE_EQ(p.metric("wrong_patch"), 2 / 5.0);
}

TEST(WrongPatch, IsAShareOfThePictureAndNotOfItsReceivers) {
  Picture p(5, 2);
  make_wrong(p, 1, 0);
  for (int x = 0; x < 4; ++x) attach(p, x, 1);
  EXPECT_DOUBLE_EQ(p.metric("wrong_patch"), 1 / 10.0);
}

TEST(WrongPatch, HasCountedPixelsOnly) {
  Picture p(5, 1);
  for (int x = 0; x < 5; ++x) make_wrong(p, x, 0);
  EXPECT_EQ(largest_wrong_patch(p.ladder), 5);
  p.ladder.flags.at(1, 0) |= flag_ambiguous;
  EXPECT_EQ(largest_wrong_patch(p.ladder), 3);
  p.ladder[Rung::shown].at(1, 0) = nan_float;
  attach(p, 3, 0);
  EXPECT_EQ(largest_wrong_patch(p.ladder), 1);
  p.ladder[Rung::shown].at(2, 0) = nan_float;
  EXPECT_TRUE(std::isnan(largest_wrong_patch(p.ladder)));
  EXPECT_EQ(largest_wrong_patch(Picture(0, 0).ladder), 0);
}

Image<uint8_t> mask_of(const std::vector<std::string>& rows) {
  Image<uint8_t> mask(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) mask.at(x, y) = rows[static_cast<size_t>(y)][static_cast<size_t>(x)] == '#';
  return mask;
}

TEST(Patch, DeepestIsThePixelFarthestFromItsOutside) {
  const auto deepest = [](const std::vector<std::string>& rows) { return deepest_in(largest_patch(mask_of(rows))); };
  EXPECT_EQ(deepest({"###....",  //
                     "###....",  //
                     "###...#"}),
            glm::ivec2(1, 1));
  EXPECT_EQ(deepest({"#........",  // a tail and a body
                     "#..#####.",  //
                     "########.",  //
                     "...#####.",  //
                     "...#####.",  //
                     "...#####."}),
            glm::ivec2(5, 3));
  EXPECT_EQ(deepest({"..........",  // a stripe of acne: halfway, and not at its end
                     "#########.",  //
                     ".........."}),
            glm::ivec2(4, 1));
  EXPECT_EQ(deepest({"#####", "#####", "#####"}), glm::ivec2(2, 1)) << "the picture's border is outside";
  EXPECT_EQ(deepest({"##...", "....#", "....#", "....#"}), glm::ivec2(4, 2)) << "of the larger one";
  EXPECT_TRUE(largest_patch(mask_of({"...", "..."})).empty());
}

}  // namespace
}  // namespace noonmark
