// What each setting does around the recommended ones, against law 1 on a lone plane. Its slope runs along the texels at 60
// degrees. With texels of w and a bias of b metres the share of acne is max(0, 1/2 - b / (w tan(theta))): half of the
// bias and half of the resolution are the same, and both ends of the range are at b = w/2 tan(theta).
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "app/advise/recommend_around.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

// The picture samples the texel at 14,000 receivers, and no alignment is preferred: one percent, as in the laws of experiments/laws.toml.
constexpr double sampling = 0.01;
// A step of the search for an end, and the 0.1 % of acne that the bound allows.
constexpr double end_tolerance = 0.03;

const TornadoRow& row_of(const Tornado& tornado, const std::string& name) {
  for (const TornadoRow& row : tornado.rows)
    if (row.setting == name) return row;
  throw std::out_of_range(name);
}

Settings plane_with_margin(double margin) {
  Settings settings = with({{"scene.theta_deg", "60"},
                            {"scene.phi_deg", "0"},
                            {"map.resolution", "256"},
                            {"map.format", "32f"},
                            {"map.placements", "4"},
                            {"bias.unit", "m"}},
                           small("plane", 160, 90));
  settings.bias["constant"] =
      margin * 0.5 * (10.0 / 256) * std::tan(1.0471975511965976);  // the plane's map is 10 m wide
  return settings;
}

TEST(Around, LawOneMovesTheThresholdWithTheTexel) {
  constexpr double margin = 1.3;
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = plane_with_margin(margin);
  const Tornado tornado = settings_around(bench, {&settings, 1}, {}, [](const std::string&) {});
  EXPECT_TRUE(tornado.held);
  EXPECT_EQ(tornado.error, 0);
  EXPECT_EQ(tornado.accuracy, "error") << "the light has no size, so the error is measured at every placement";
  EXPECT_EQ(tornado.placements, 16);
  const double acne_at_half = 0.5 - margin / 4;
  for (const char* name : {"bias.constant", "map.resolution"}) {
    const TornadoRow& row = row_of(tornado, name);
    EXPECT_NEAR(row.half.error, acne_at_half, sampling) << name;
    EXPECT_FALSE(row.half.held) << name;
    EXPECT_EQ(row.twice.error, 0) << name;
    EXPECT_TRUE(row.twice.held) << name;
    EXPECT_NEAR(std::stod(row.low.value) * margin / std::stod(row.value), 1, end_tolerance) << name;
    EXPECT_FALSE(row.low_open) << name;
    EXPECT_TRUE(row.high_open) << name << ": nothing casts a shadow, so no bias is too large";
  }
  // A wider map has wider texels.
  const TornadoRow& extent = row_of(tornado, "map.extent_scale");
  EXPECT_NEAR(extent.twice.error, acne_at_half, sampling);
  EXPECT_NEAR(std::stod(extent.high.value), margin, end_tolerance * margin);
  // Half of the resolution needs twice the bias.
  Settings coarse = settings;
  coarse.map.resolution /= 2;
  coarse.bias["constant"] *= 2;
  const Tornado other = settings_around(bench, {&coarse, 1}, {}, [](const std::string&) {});
  EXPECT_NEAR(
      std::stod(row_of(other, "bias.constant").low.value) / std::stod(row_of(tornado, "bias.constant").low.value), 2,
      2 * end_tolerance);
}

TEST(Around, TheWorstConditionDecides) {
  Workbench bench(gl::DebugMode::fatal);
  std::vector<Settings> both(2, plane_with_margin(1.3));
  both[1].map.extent_scale = 1.5;  // too little bias there
  for (Settings& settings : both) settings.map.placements = 2;
  const auto none = [](const std::string&) {};
  const Tornado gentle = settings_around(bench, {&both[0], 1}, {}, none);
  const Tornado worst = settings_around(bench, both, {}, none);
  EXPECT_TRUE(gentle.held);
  EXPECT_FALSE(worst.held);
  EXPECT_NEAR(worst.error, 0.5 - 1.3 / 2 / 1.5, sampling);
  EXPECT_EQ(worst.conditions, 2u);
  EXPECT_EQ(row_of(worst, "bias.constant").low.value, row_of(worst, "bias.constant").value) << "no range";
}

TEST(Around, ThePageHasEveryNumberAsATable) {
  Tornado tornado{
      .error = 0.01, .held = true, .accuracy = "error", .placements = 64, .conditions = 2, .placed = true, .rows = {}};
  TornadoRow row;
  row.setting = "map.resolution", row.unit = "texels", row.value = "1024";
  row.half = {"512", 0.0213, false, ""};
  row.twice = {"2048", 0, true, ""};
  row.low = {"<725>", 0.0142, true, ""};
  row.high = {"8192", 0.00125, true, ""};
  row.high_open = true;
  tornado.rows.push_back(row);
  const std::string page = to_tornado_page(tornado, "0.1.0");
  for (const char* text :
       {"<svg", "2.13", "breaks a bound", "&lt;725&gt;", "at least 8192", "1024 texels", "map.resolution"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_NE(tornado_text(tornado).at(1).find("the bounds hold from <725> to at least 8192 texels"), std::string::npos)
      << tornado_text(tornado).at(1);
}

}  // namespace
}  // namespace noonmark::acceptance
