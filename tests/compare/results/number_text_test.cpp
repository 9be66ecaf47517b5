// Numbers for people.
#include "compare/results/number_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace noonmark {
namespace {

TEST(NumberText, HasAtMostFourSignificantDigits) {
  EXPECT_EQ(number_text(0.083472391), "0.08347");
  EXPECT_EQ(number_text(9.476307651486675e-05), "9.476e-05");
  EXPECT_EQ(number_text(24.784620536051), "24.78");
  EXPECT_EQ(number_text(-2), "-2");
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(16384), "16384") << "a resolution is whole";
  EXPECT_EQ(number_text(12345.678), "12350");
  EXPECT_EQ(number_text(578734.4), "578700");
  EXPECT_EQ(number_text(1.7e18), "1.7e+18");
  EXPECT_EQ(number_text(std::nan("")), "not measured");
}

TEST(NumberText, SharesAreInPercentAndCountsAreWholeNumbers) {
  EXPECT_EQ(quantity_text(0.005, "fraction"), "0.5%");
  EXPECT_EQ(quantity_text(0.07, "fraction", 9), "7%") << "100 times 0.07 is not 7 in double";
  EXPECT_EQ(quantity_text(0.0083472391, "fraction"), "0.8347%");
  EXPECT_EQ(quantity_text(35158, "count"), "35158");
  EXPECT_EQ(quantity_text(17093806, "count"), "17090000");
  EXPECT_EQ(quantity_text(4194304, "bytes"), "4.194 MB");
  EXPECT_EQ(quantity_text(0.25, "m"), "0.25 m");
  EXPECT_EQ(quantity_text(1, "pixels"), "1 pixel");
  EXPECT_EQ(quantity_text(1.5, "pixels"), "1.5 pixels");
  EXPECT_EQ(quantity_text(-1, "texels"), "-1 texels");
  EXPECT_EQ(quantity_text(std::nan(""), "fraction"), "not measured");
}

TEST(NumberText, AShareThatIsTheRoundingOfASumIsZero) {
  EXPECT_EQ(share_text(0.0083472391), "0.835%");
  EXPECT_EQ(share_text(2.23e-17), "0%") << "doubles around 1 are 2.2e-16 apart";
  EXPECT_EQ(share_text(-2.23e-17), "0%");
  EXPECT_EQ(quantity_text(2.23e-17, "fraction"), "0%");
  EXPECT_EQ(share_text(1.0 / 961 / 67108864), "1.55e-09%") << "one tap of one pixel is something";
  EXPECT_EQ(share_text(std::nan("")), "not measured");
  EXPECT_EQ(quantity_text(2.23e-17, "m"), "2.23e-17 m");
}

TEST(NumberText, AValueDoesNotReadAsTheLimitThatItBreaks) {
  EXPECT_EQ(digits_to_tell(0.006, 0.005), 4);
  const int digits = digits_to_tell(0.00500004, 0.005);
  EXPECT_NE(quantity_text(0.00500004, "fraction", digits), quantity_text(0.005, "fraction", digits));
  EXPECT_EQ(digits_to_tell(0.005, 0.005), 4);
  EXPECT_EQ(digits_to_tell(std::nan(""), 0.005), 4);
}

TEST(NumberText, SettingsKeepTheirWordsAndShortenTheirNumbers) {
  EXPECT_EQ(setting_text("24.784620536051,27.988505709867965,0"), "24.78,27.99,0");
  EXPECT_EQ(setting_text("box"), "box");
  EXPECT_EQ(setting_text("16384"), "16384");
  EXPECT_EQ(setting_text("models/a,b.gltf"), "models/a,b.gltf");
  EXPECT_EQ(setting_text(""), "");
}

}  // namespace
}  // namespace noonmark
