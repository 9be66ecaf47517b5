// The page's stylesheet: the colours of text have the contrast that WCAG 2.1 AA asks for, light and dark.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <utility>

#include "base/file.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

// WCAG 2.1, success criterion 1.4.3: text that is not large.
constexpr double least_contrast = 4.5;

// "Relative luminance" of WCAG 2.1.
double luminance(const std::string& hex) {
  double sum = 0;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  for (size_t k = 0; k < 3; ++k) {
    const double c = std::stoi(hex.substr(2 * k, 2), nullptr, 16) / 255.0;
    sum += weights[k] * (c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const std::string& a, const std::string& b) {
  const double x = luminance(a), y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

using Colors = std::map<std::string, std::string>;

// The variables that are colours: "--ink: #1f2328".
void read_colors(const std::string& text, Colors& colors) {
  static const std::regex variable("--([a-z0-9-]+): #([0-9a-f]{6})");
  for (std::sregex_iterator i(text.begin(), text.end(), variable), end; i != end; ++i) colors[(*i)[1]] = (*i)[2];
}

void expect_readable(const Colors& colors, const char* scheme) {
  const std::pair<const char*, const char*> pairs[] = {
      {"ink", "paper"},    {"ink", "card"},    {"soft", "paper"}, {"soft", "card"},      {"faint", "paper"},
      {"faint", "card"},   {"accent", "card"}, {"good", "card"},  {"good", "good-wash"}, {"bad", "bad-wash"},
      {"accent", "paper"}, {"good", "paper"},  {"bad", "paper"},  {"bad", "card"},
  };
  for (const auto& [text, ground] : pairs) {
    ASSERT_TRUE(colors.contains(text) && colors.contains(ground)) << text << " or " << ground;
    EXPECT_GE(contrast(colors.at(text), colors.at(ground)), least_contrast)
        << text << " on " << ground << ", " << scheme;
  }
}

TEST(Style, ContrastIsThatOfWcag) {
  EXPECT_NEAR(contrast("000000", "ffffff"), 21, 1e-9);
  EXPECT_NEAR(contrast("777777", "ffffff"), 4.48, 0.01) << "the grey that WCAG's own notes name as just too light";
}

TEST(Style, TextHasContrastInLightAndDark) {
  const std::string style = read_file(noonmark::test::source_dir() + "/compare/report/page/style.css");
  const size_t dark_at = style.find("(prefers-color-scheme: dark)");
  ASSERT_NE(dark_at, std::string::npos);
  Colors light, dark;
  read_colors(style.substr(0, dark_at), light);
  dark = light;
  read_colors(style.substr(dark_at), dark);
  EXPECT_NE(light.at("paper"), dark.at("paper"));
  expect_readable(light, "light");
  expect_readable(dark, "dark");
}

}  // namespace
}  // namespace noonmark
