// How the pages are laid out, in a real browser: none scrolls sideways, no label is cut, numbers stand on their points, the
// first picture is one of full size, charts are saved, and a print is short.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "compare/report/index_page.h"
#include "compare/report/phase.h"
#include "compare/report/report.h"
#include "tests/compare/report/browser.h"
#include "tests/compare/report/sample.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

using nlohmann::json;

// A sweep with long names: they differ at their end.
Results long_names() {
  Results results = sample_results();
  results.info.swept = {"view.eye_m", "light.angular_diameter_deg", "map.extent_m", "filter.kind", "map.resolution"};
  for (PointRecord& point : results.points) {
    point.settings["view.eye_m"] = point.id % 2 ? "-12.345678,2.3456789,-34.567891" : "12.345678,2.3456789,34.567891";
    point.settings["light.angular_diameter_deg"] = "0.53312345";
  }
  return results;
}

Results parts_and_laws() {
  Results results = long_names();
  for (PointRecord& point : results.points)
    point.part =
        point.id % 2 ? "a part with quite a long name of its own" : "the_other_part_whose_name_has_no_spaces_at_all";
  LawResult law = sample_law();
  law.measured = "acne_free_bias_m / (texel_m * (abs(tan_theta) + depth_quantum_m) * some_other_quantity_of_the_point)";
  results.laws.push_back(law);
  return results;
}

std::string index() {
  IndexEntry entry;
  entry.verdict = Verdict::broken;
  entry.experiment = "mine_in_a_folder_with_a_long_name/an_experiment_with_a_very_long_name_without_spaces.toml";
  entry.title = "An experiment";
  entry.report = "report.html";
  entry.words = "1 of 2 bounds held";
  entry.numbers = "Error at most 3 %, Acne at most 2 %, Peter Panning at most 1 %";
  return index_page({entry, entry}, "0.1.0");
}

std::string with_lights() {
  Results results = long_names();
  results.points.resize(3);
  for (PointRecord& point : results.points) {
    point.part = "the_light_over_the_table_number_" + std::to_string(point.id);
    point.metrics["lights_frame"] = 0;
    for (const char* metric : {"lights_error", "lights_rmse", "lights_flip", "light_weight", "light_error"})
      point.metrics[metric] = 0.0123456;
    point.metrics["light_share"] = point.id == 1 ? 0.6 : 0.2;
  }
  return render_report(results, sample_picture);
}

std::string with_phase() {
  Results results = long_names();
  results.phases = {sample_phase()};
  return render_report(results, sample_picture);
}

struct Page {
  const char* name;
  std::string (*make)();
};
const Page pages[] = {
    {"sweep", [] { return render_report(long_names(), sample_picture); }},
    {"phase", with_phase},
    {"lights", with_lights},
    {"parts", [] { return render_report(parts_and_laws(), sample_picture); }},
    {"map", [] { return render_phase(sample_phase()); }},
    {"index", index},
};

// A page without scripts forbids them, also that of the test.
std::string with_scripts(std::string page) {
  if (const size_t at = page.find("style-src 'unsafe-inline'\">"); at != std::string::npos)
    page.insert(at, "script-src 'unsafe-inline'; ");
  return page;
}

class Width : public Browser, public testing::WithParamInterface<std::tuple<const char*, Page>> {};

TEST_P(Width, NoPageScrollsSideways) {
  const auto& [window, page] = GetParam();
  open(with_scripts(page.make()), "layout_probe.js", window);
  if (IsSkipped() || HasFatalFailure()) return;
  EXPECT_LE(saw_["width"], std::stoi(window));
  EXPECT_LE(saw_["needed"], saw_["width"]);
  EXPECT_LE(saw_["needed_unfolded"], saw_["width"]) << "with all that is folded unfolded";
  EXPECT_EQ(saw_["stacked_that_scroll"], 0) << "tables whose rows are lists on a narrow screen";
  EXPECT_EQ(saw_["stacked"], page.name == std::string("lights") ? 1 : 0);
}
INSTANTIATE_TEST_SUITE_P(Layout, Width,
                         testing::Combine(testing::Values("400,900", "500,900", "1280,900"), testing::ValuesIn(pages)),
                         [](const auto& test) {
                           return std::string(std::get<1>(test.param).name) +
                                  std::to_string(std::stoi(std::get<0>(test.param)));
                         });

// A live picture of 2 x 1 pixels (compare/ladder/live_picture.h): both are lit from the bias 0.001 on.
std::string live_picture() {
  const json head{{"width", 2},
                  {"height", 1},
                  {"taps", 1},
                  {"answers", 4},
                  {"unit", "depth"},
                  {"parameter", "bias.constant"},
                  {"depth_per_unit", 1},
                  {"m_per_depth", 6.5},
                  {"texels_per_depth", 100},
                  {"causes", {"none", "acne"}}};
  std::string file = head.dump();
  file.resize((file.size() + 4) / 4 * 4 - 1, ' ');
  file += '\n';
  const float from[] = {0, 0.001f, 0, 0.001f};
  file.append(reinterpret_cast<const char*>(from), sizeof from);
  file += std::string("\0\1\0\1", 4) + std::string("\1\0\1\0", 4) + std::string("\1\0\1\0", 4) + std::string(4, '\0');
  file += std::string("\x0b\x0b", 2) + std::string(2, '\x7f') + std::string("\2\0\2\0", 4);
  return file;
}

class Layout : public Browser {
 protected:
  void SetUp() override {
    Results results = long_names();
    results.points[18].images.push_back({"images/p0018-live.bin", ""});
    results.laws.push_back(sample_law());
    open(render_report(results,
                       [](const std::string& path) {
                         return path.ends_with("-live.bin") ? live_picture() : sample_picture(path);
                       }),
         "layout_probe.js");
  }
};

TEST_F(Layout, NumbersStandOnTheirPoints) {
  size_t columns = 0;
  for (const auto& [head, places] : saw_["points"].items()) {
    if (head.find("Error") != 0 && head.find("Aliasing") != 0) continue;
    ++columns;
    ASSERT_GT(places.size(), 20u) << head;
    const auto [least, most] = std::minmax_element(places.begin(), places.end());
    EXPECT_LT(most->get<double>() - least->get<double>(), 3) << head << ": in pixels; a digit has eight";
  }
  EXPECT_GE(columns, 3u);
}

TEST_F(Layout, OpensWithAPictureOfFullSize) {
  const json &first = saw_["live"]["first"], &moved = saw_["live"]["moved"], &back = saw_["live"]["back"];
  EXPECT_EQ(first["whole"], json({320})) << "the point's own picture";
  EXPECT_EQ(first["canvas"], 0);
  EXPECT_NE(first["facts"].get<std::string>().find("as set"), std::string::npos) << first;
  EXPECT_EQ(moved["whole"], json::array());
  EXPECT_EQ(moved["canvas"], 1) << "the live picture, once the bias is moved";
  EXPECT_EQ(moved["facts"].get<std::string>().find("as set"), std::string::npos) << moved;
  EXPECT_EQ(back, first);
}

TEST_F(Layout, EachChartIsSaved) {
  EXPECT_GE(saw_["charts"], 4);
  EXPECT_EQ(saw_["charts_with_save"], saw_["charts"]);
  size_t svg = 0, png = 0;
  std::set<std::string> names;
  for (const json& file : saw_["files"]) {
    const std::string name = file["name"];
    EXPECT_TRUE(names.insert(name).second) << name;
    if (name.ends_with(".svg")) {
      ++svg;
      EXPECT_TRUE(file["svg"]) << name;
      EXPECT_EQ(file["variables"], 0) << name << ": outside of the page its variables have no value";
      EXPECT_GT(file["marks"], 5) << name;
      if (name == "noonmark-function.svg") {
        EXPECT_NE(file["text"].get<std::string>().find("Acne"), std::string::npos) << "legend";
      }
    } else {
      ++png;
      EXPECT_TRUE(file["png"]) << name;
      if (name != "noonmark-live-picture.png") {
        EXPECT_GT(file["size"], 4000) << name;
      }
    }
  }
  EXPECT_EQ(png, saw_["charts"].get<size_t>());
  EXPECT_EQ(svg, png - 1) << "the live picture is of pixels";
}

// What a browser prints, as the number of its pages.
class Print : public Browser {};

TEST_F(Print, SixteenPointsTakeAtMostSixPages) {
  Results results = long_names();
  results.points.resize(27);
  results.points.erase(results.points.begin(), results.points.begin() + 11);  // 16, with two that have pictures
  results.planned_points = 16;
  for (BoundResult& bound : results.bounds) bound.point = 18;
  const std::string pdf = printed(render_report(results, sample_picture));
  if (IsSkipped()) return;
  size_t count = 0;
  for (size_t at = pdf.find("/Type /Page\n"); at != std::string::npos; at = pdf.find("/Type /Page\n", at + 1)) ++count;
  EXPECT_GE(count, 2u);
  EXPECT_LE(count, 6u);
}

}  // namespace
}  // namespace noonmark
