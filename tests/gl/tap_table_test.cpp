// The table of taps that the shader reads.
#include "gl/tap_table.h"

#include <gtest/gtest.h>

namespace noonmark::gl {
namespace {

TEST(TapTable, HoldsThePatternsOffsets) {
  const TapPattern pattern = tap_pattern({"poisson", {{"rotate", 1}}});
  const auto table = tap_table(pattern);
  ASSERT_EQ(table.size(), 64u * 16u);
  for (int v = 0; v < 64; ++v)
    for (int t = 0; t < 16; ++t) EXPECT_EQ(glm::vec3(table[static_cast<size_t>(v * 16 + t)]), pattern.offset(v, t));
}

TEST(TapTable, FetchesWeighOneExactly) {
  for (const int size : {1, 3, 5, 31})
    for (const double sigma : {0.2, 1.0, 7.0}) {
      const TapPattern pattern = tap_pattern({"gaussian", {{"size", size}, {"sigma_texels", sigma}}});
      const auto table = tap_table(pattern);
      const size_t n = static_cast<size_t>(size);
      ASSERT_EQ(table.size(), n * n);
      float forwards = 0, backwards = 0;  // the shader's float sum is exact in any order
      for (size_t k = 0; k < table.size(); ++k) {
        forwards += table[k].w;
        backwards += table[table.size() - 1 - k].w;
        EXPECT_NEAR(table[k].w, pattern.kernel[k % n] * pattern.kernel[k / n], 0x1p-24);
        EXPECT_EQ(table[k].x, static_cast<float>(k % n) - static_cast<float>(size - 1) / 2);
        EXPECT_EQ(table[k].y, static_cast<float>(k / n) - static_cast<float>(size - 1) / 2);
      }
      EXPECT_EQ(forwards, 1.0f);
      EXPECT_EQ(backwards, 1.0f);
    }
}

}  // namespace
}  // namespace noonmark::gl
