// The message about a picture in which almost no pixel can be judged.
#include "compare/judge/poor_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace noonmark {
namespace {

// 100 x 100 pixels.
PointRecord point_with(const std::map<std::string, double>& metrics) {
  PointRecord point;
  point.settings = {{"view.width_px", "100"}, {"view.height_px", "100"}};
  point.metrics = {{"receivers", 9000}, {"facing", 8000}, {"counted", 7990},  {"lit", 0.5},
                   {"clipped", 0},      {"culled", 0},    {"scene_behind", 0}};
  for (const auto& [name, value] : metrics) point.metrics[name] = value;
  return point;
}

TEST(PoorView, NamesTheReasonThatHidesMost) {
  const double nan = std::nan("");
  const std::map<std::string, double> none = {{"receivers", 0}, {"facing", 0}, {"counted", 0}, {"lit", nan}};
  const auto with = [](std::map<std::string, double> metrics, const std::map<std::string, double>& more) {
    for (const auto& [name, value] : more) metrics[name] = value;
    return why_poor_view(point_with(metrics));
  };
  const auto begins = [](const std::string& text, const std::string& beginning) {
    EXPECT_EQ(text.substr(0, beginning.size()), beginning);
  };
  begins(with(none, {}), "no pixel of 10000 can be judged: the camera looks past the scene");
  begins(with(none, {{"scene_behind", 1}}), "no pixel of 10000 can be judged: the whole scene is behind the camera");
  begins(with(none, {{"clipped", 700}, {"culled", 30}}),
         "no pixel of 10000 can be judged: at 700 pixels the camera's near");
  begins(with(none, {{"clipped", 30}, {"culled", 700}}), "no pixel of 10000 can be judged: 700 pixels see only backs");
  begins(with({}, {{"receivers", 60}, {"facing", 55}, {"counted", 50}, {"clipped", 700}}),
         "only 50 of 10000 pixels can be judged: at 700 pixels the camera's near");
  begins(with({}, {{"facing", 0}, {"counted", 0}, {"lit", nan}}),
         "no pixel of 10000 can be judged: of 9000 that see a surface 9000 see one that faces away");
  begins(with({}, {{"counted", 0}, {"lit", nan}}),
         "no pixel of 10000 can be judged: 8000 face the light, but the truth of 8000 of them is ambiguous");
  begins(with({}, {{"clipped", 100}}), "at 100 pixels the camera's near or far plane cuts the surface off");
  begins(with({}, {{"lit", 0}}), "all of the 7990 pixels that can be judged are in shadow");
}

// view.fit_depths changes only planes from the scene's file. A near or far plane that the user set stays until the user
// removes it.
TEST(PoorView, AdvisesToTakeBackTheNearOrFarThatWasGiven) {
  const auto advice = [](const std::string& near_m, const std::string& far_m, const std::string& fit_depths) {
    PointRecord point = point_with({{"receivers", 0}, {"facing", 0}, {"counted", 0}, {"clipped", 700}});
    point.settings["view.near_m"] = near_m;
    point.settings["view.far_m"] = far_m;
    point.settings["view.fit_depths"] = fit_depths;
    const std::string text = why_poor_view(point);
    return text.substr(std::min(text.size(), text.find("off; ") + 5));
  };
  EXPECT_EQ(advice("auto", "auto", "false"), "set view.fit_depths = true, or view.near_m and view.far_m");
  EXPECT_EQ(advice("auto", "auto", "true"), "set view.near_m, or move the camera");
  EXPECT_EQ(advice("auto", "0.001", "true"), "set view.far_m = auto");
  EXPECT_EQ(advice("60", "auto", "true"), "set view.near_m = auto");
  EXPECT_EQ(advice("auto", "0.001", "false"),
            "set view.far_m = auto (with view.fit_depths = true, where the scene's file gives a near or far plane)");
  EXPECT_EQ(advice("60", "70", "false"),
            "set view.near_m = auto and view.far_m = auto (with view.fit_depths = true, where the scene's file gives a "
            "near or far plane)");
}

TEST(PoorView, IsSilentOfAGoodOneAndOfOldRecords) {
  EXPECT_EQ(why_poor_view(point_with({})), "");
  EXPECT_EQ(why_poor_view(point_with({{"counted", 100}})), "") << "1% of the pixels is enough";
  EXPECT_NE(why_poor_view(point_with({{"counted", 99}})), "");
  EXPECT_EQ(why_poor_view(point_with({{"clipped", 99}, {"culled", 500}})), "");
  EXPECT_EQ(why_poor_view(PointRecord{}), "");
  PointRecord old = point_with({});
  old.metrics.erase("lit");
  EXPECT_EQ(why_poor_view(old), "");
}

TEST(PoorView, TellsOfManyPointsByTheFirst) {
  std::vector<PointRecord> points(3, point_with({}));
  for (int64_t i = 0; i < 3; ++i) points[static_cast<size_t>(i)].id = i;
  EXPECT_EQ(poor_view_note(points), "");
  points[1].metrics["lit"] = 0;
  EXPECT_EQ(poor_view_note(points).find("point 1: all of the 7990"), 0u);
  points[2].metrics["lit"] = 0;
  EXPECT_EQ(poor_view_note(points).find("the picture is poor at 2 of 3 points; at point 1, all"), 0u);
  EXPECT_EQ(poor_view_note(std::span(points).subspan(1, 1)).find("all of"), 0u) << "a single point needs no number";
}

}  // namespace
}  // namespace noonmark
