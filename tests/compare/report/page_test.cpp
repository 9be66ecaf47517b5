// The report's page in a real browser, headless Chromium: what its scripts draw, and what clicks and keys do.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/report/data.h"
#include "compare/report/phase.h"
#include "compare/report/report.h"
#include "compare/report/section_picture.h"
#include "compare/report/speed.h"
#include "compare/report/speed_reading.h"
#include "tests/compare/report/browser.h"
#include "tests/compare/report/sample.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

using nlohmann::json;

class Page : public Browser {
 protected:
  void SetUp() override {
    Results results = sample_results();
    results.points[3].metrics["error"] = std::numeric_limits<double>::quiet_NaN();
    results.points[4].metrics["error"] = 0;
    results.points[26].pictures.push_back({"map", "images/p0018-map.png", "The map of another."});
    results.points[18].worst_of = {{"acne", 56, 78, 0.5}};
    results.bounds.push_back({.metric = "acne",
                              .max = 0.005,
                              .where = {},
                              .join = "worst",
                              .held = false,
                              .found = 0.0083,
                              .point = 18,
                              .points = 32,
                              .reproduce = "render 18"});
    results.points[18].images = {{report::section_path(18, {56, 78}), ""}, {report::section_path(18, {1, 2}), ""}};
    open(render_report(results, sample_picture), "page_probe.js");
  }
};

// A click on a broken point shows what breaks there: the bound, the pixel of its own metric, and the bias that was judged,
// whatever bias the page shows.
TEST_F(Page, AClickOnABrokenPointShowsTheFailure) {
  for (const char* how : {"failure", "failure_by_row"}) {
    const json& seen = saw_["card"][how];
    EXPECT_EQ(seen["words"].get<std::string>().find(
                  "Broken: Acne is 0.83\u202f% where at most 0.5\u202f% is allowed, with a bias of "),
              0u)
        << seen["words"];
    EXPECT_EQ(seen["pixel"], "Worst pixel (56, 78) from the top left. Acne 50\u202f% there, with the bias as set.")
        << how;
    EXPECT_EQ(seen["chosen"], "acne") << how;
    EXPECT_EQ(seen["section"], "Section through pixel (56, 78)") << how;
    EXPECT_EQ(seen["bias"], "As set") << how << ": the page is at the recommended bias";
  }
  EXPECT_EQ(saw_["card"]["asked_recommended"], "Recommended") << "the answer's own link shows its bias";
}

// 4 resolutions and 4 extents; the list has the filters.
TEST_F(Page, OpensWithTheErrorOverBiasResolutionAndExtent) {
  const json& figure = saw_["figure"];
  EXPECT_EQ(figure["first"], "chart-function");
  EXPECT_EQ(figure["grids"], 2);
  EXPECT_EQ(figure["cells"], 16);
  EXPECT_EQ(figure["shown"], json({"none"})) << "one grid at a time";
  EXPECT_EQ(figure["other"], json({"box"}));
  const std::string tip = figure["tip"];
  EXPECT_NE(tip.find(" texels)Acne (too dark)"), std::string::npos) << "the bias, then the causes: " << tip;
  ASSERT_GE(figure["tip_rows"].size(), 3u);
  EXPECT_EQ(figure["tip_rows"].back()[0], "Error");
  EXPECT_EQ(figure["cursor"], "visible");
  EXPECT_EQ(figure["left"], (json{true, "hidden"}));
}

TEST_F(Page, TheTableSortsAndSelects) {
  const json& table = saw_["table"];
  std::vector<double> up, down;
  for (const json& cell : table["error"][0]) up.push_back(std::strtod(cell.get<std::string>().c_str(), nullptr));
  for (const json& cell : table["error"][1]) down.push_back(std::strtod(cell.get<std::string>().c_str(), nullptr));
  ASSERT_EQ(up.size(), 32u);
  ASSERT_EQ(down.size(), 32u);
  EXPECT_TRUE(std::isnan(up.back()) && std::isnan(down.back())) << "not finite values must be last in both orders";
  EXPECT_TRUE(std::is_sorted(up.begin(), up.end() - 1));
  EXPECT_TRUE(std::is_sorted(down.begin(), down.end() - 1, std::greater<>()));
  EXPECT_EQ(table["sorted"], "descending");
  EXPECT_EQ(table["filter"][0], "box") << "words must be sorted as words, with the keyboard too";
  EXPECT_TRUE(table["focus"]);
  EXPECT_EQ(table["filter"][31], "none");
  EXPECT_EQ(saw_["selected_by_row"], json({5}));
  const std::vector<std::string> cells = saw_["cells_of_5"];
  ASSERT_EQ(cells.size(), 1u) << "the figure marks the selected point";
  EXPECT_EQ(cells[0].find("5:"), 0u) << cells[0];
  EXPECT_EQ(saw_["grid_of_5"], json({sample_results().points[5].settings.at("filter.kind")})) << "and shows its grid";
  EXPECT_EQ(saw_["selected_by_click"], json({std::stoi(saw_["clicked"].get<std::string>())}));
}

TEST_F(Page, ChartsAreReadByKeyboard) {
  const json& keys = saw_["keys"];
  EXPECT_EQ(keys["stop"], 0);
  const std::vector<std::string> said = keys["said"];
  EXPECT_EQ(said[0].find("bias "), 0u) << said[0];
  EXPECT_NE(said[0].find("Peter Panning (too light) "), std::string::npos) << said[0];
  EXPECT_NE(said[1], said[0]) << "the next chart";
  EXPECT_EQ(said[2], said[0]) << "Home is the first";
  EXPECT_NE(said[3], said[1]);
  EXPECT_EQ(said[4], said[3]) << "Escape says nothing";
  EXPECT_TRUE(keys["tip"]) << "and hides the tip";
  EXPECT_TRUE(keys["card"].is_string()) << "Enter opens the card";
}

// The table follows the bias that is chosen at the top. A bound of this sample is broken, so the page opens
// at the bias as set, of which its head speaks.
TEST_F(Page, OneBiasIsInAllFigures) {
  EXPECT_EQ(saw_["bias_choice"], json({"set", "recommended", "set"}));
  const json &recommended = saw_["at_recommended"], &set = saw_["as_set"], &point = saw_["data_of_5"];
  EXPECT_EQ(set["error"], point["metrics"]["error"]);
  EXPECT_EQ(recommended["error"], point["at"]["metrics"]["error"]);
  EXPECT_NE(set["error"], recommended["error"]);
  EXPECT_EQ(set["words"], "inline");
  EXPECT_EQ(recommended["words"], "none");
}

TEST_F(Page, ControlsHaveNamesAndImagesHaveTexts) {
  EXPECT_EQ(saw_["unnamed"], json::array());
  EXPECT_EQ(saw_["images_without_text"], 0);
  EXPECT_EQ(saw_["headings"], json::array()) << "a level is skipped before these";
}

TEST_F(Page, EachPointHasACard) {
  const json& card = saw_["card"];
  EXPECT_TRUE(card["by_click"]) << "a click on a mark opens the card";
  EXPECT_TRUE(card["closed"]);
  const json &pictures = card["with_pictures"], &zoomed = card["zoomed"], &recommended = card["recommended"];
  EXPECT_TRUE(pictures["open"]);
  EXPECT_EQ(pictures["title"].get<std::string>().find("Point 18: "), 0u) << pictures["title"];
  EXPECT_EQ(pictures["pictures"], 2);
  EXPECT_EQ(pictures["left"].get<std::string>().find("truth"), 0u);
  EXPECT_EQ(pictures["cuts"], 3) << "truth, classes and map";
  EXPECT_EQ(pictures["rows"], static_cast<int>(sample_results().points[18].metrics.size()));
  EXPECT_EQ(pictures["divide"], "inset(0px 0px 0px 50%)");
  EXPECT_EQ(zoomed["divide"], "inset(0px 0px 0px 20%)");
  EXPECT_EQ(pictures["width"], "100%");
  EXPECT_EQ(zoomed["width"], "200%");
  const std::string command = pictures["command"], at_recommended = recommended["command"];
  EXPECT_EQ(command.find("noonmark render --set "), 0u) << command;
  EXPECT_NE(command.find("--set map.extent_m=20"), std::string::npos) << command;
  EXPECT_EQ(command.find("--set bias.constant="), std::string::npos) << "the default bias: " << command;
  EXPECT_NE(at_recommended.find("--set bias.constant="), std::string::npos) << at_recommended;
  EXPECT_EQ(card["next"]["title"].get<std::string>().find("Point 19: "), 0u);
}

TEST_F(Page, TheTableIsSearched) {
  std::vector<int> expected;
  for (const PointRecord& point : sample_results().points)
    if (point.settings.at("filter.kind") == "box" && point.settings.at("map.resolution") == "2048")
      expected.push_back(static_cast<int>(point.id));
  std::vector<int> found = saw_["found"];
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
}

TEST_F(Page, KeysFlipThePicturesInSight) {
  EXPECT_EQ(saw_["flips"], json({"1 18 truth",  // not in view
                                 "1 18 map", "1 18 classes", "1 18 truth", "1 18 classes", "1 18 map",
                                 "1 18 map",     // there is no ninth
                                 "1 18 map",     // the list has the focus
                                 "1 26 map"}));  // another point, the same picture
}

class ReductionPage : public Browser {
 protected:
  // Two points have a curve over the reduction beside that over the bias.
  void SetUp() override {
    Results results = sample_results();
    for (size_t k : {5u, 9u}) {
      for (int i = 0; i < 100; ++i) {
        const double r = i / 100.0, leak = std::max(0.0, 0.002 * (0.3 - r));
        results.points[k].lookup_curve.push_back(
            {"lookup.reduction", r, leak + 0.05 * r, leak, 0.001, 0, 0.05 * r, 0, 0, 0, leak + 0.05 * r});
      }
      results.points[k].metrics.insert(
          {{"best_reduction", 0}, {"best_reduction_error", 0.0006}, {"reduction_min", 0.1}, {"reduction_max", 0.2}});
    }
    open(render_report(results, sample_picture), "page_probe.js");
  }
};

TEST_F(ReductionPage, TheReductionChartDrawsTheSeriesAboveZeroAndTheWindow) {
  EXPECT_EQ(marks("chart-reduction", "line"), 5) << "both errors, leak, reduction and over-darkening; no Peter Panning";
  EXPECT_EQ(marks("chart-reduction", "rect"), 1) << "the window";
}

class FilteredPage : public Browser {
 protected:
  void SetUp() override { open(render_report(filtered_sample_results(), sample_picture), "lookup_probe.js"); }
};

TEST_F(FilteredPage, IsReadAtItsReduction) {
  EXPECT_EQ(saw_["choice"], "Reduction") << "the switch of the whole page";
  const json &first = saw_["reduction"]["at"][0], &second = saw_["reduction"]["at"][1];
  EXPECT_EQ(first["facts"].get<std::string>().find("No usable window."), 0u) << first["facts"];
  EXPECT_EQ(second["facts"], "Usable from 0.15 to 0.2. Least error at 0.2, with 0.5\u202f%.");
  EXPECT_EQ(first["windows"], 0);
  EXPECT_EQ(second["windows"], 1);
  EXPECT_EQ(second["bounds"], 1);
  EXPECT_NE(second["words"].dump().find("\"bound 0.1\u202f%\""), std::string::npos)
      << "both are equal: " << second["words"];
  // The leak is 0 from 0.3 on: its line ends there, and none runs along the axis.
  EXPECT_EQ(second["zeros"], 1) << "the end of the line alone";
  EXPECT_FALSE(saw_.contains("over"));
  const std::string verdict = saw_["verdict"];
  EXPECT_NE(verdict.find(" at lookup.reduction 0.19, which is usable."), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("Usable reductions: 0.15 to 0.2."), std::string::npos) << verdict;
  EXPECT_NE(saw_["command"].get<std::string>().find("lookup.reduction=0.19"), std::string::npos) << saw_["command"];
}

// Two points have a curve over lookup.moment_bias, whose rounding makes the errors of small values larger than those of the exact
// map.
class OverPage : public Browser {
 protected:
  void SetUp() override {
    Results results = filtered_sample_results();
    for (size_t k : {0u, 1u}) {
      results.points[k].settings["lookup.moment_bias"] = "0.001";
      for (const double value : {0.0, 1e-6, 1e-3, 1e-2}) {
        LookupCurvePoint at{.parameter = "lookup.moment_bias", .value = value, .error = 0.004 + value};
        at.leak = 0.001, at.over_darkening = 0.002 - 0.1 * value, at.peter_panning = 0.01 * value;
        at.shown_error = at.error + (value < 1e-4 ? 0.01 : 0) + (k == 1 && value == 1e-3 ? 0.05 : 0);
        results.points[k].over_curve.push_back(at);
      }
    }
    open(render_report(results, sample_picture), "lookup_probe.js");
  }
};

TEST_F(OverPage, DrawsBothErrorsAndTheCausesAtNamedValues) {
  const json &first = saw_["over"]["at"][0], &second = saw_["over"]["at"][1];
  EXPECT_EQ(first["title"], (json{"share of counted receivers", "lookup.moment_bias"})) << first["title"];
  const std::string labels = first["labels"].dump(), words = first["words"].dump();
  EXPECT_NE(labels.find("\"0\",\"1×10⁻⁶\",\"0.001\",\"0.01\""), std::string::npos) << "0 has a place: " << labels;
  EXPECT_EQ(first["series"], (json{"error", "exact_map", "leak", "over_darkening", "peter_panning"}))
      << "the reduction darkens nothing";
  for (const char* mark : {"\"least error\"", "\"as set\""}) EXPECT_NE(words.find(mark), std::string::npos) << words;
  EXPECT_EQ(first["facts"], "Least error at 0.001, with 0.5\u202f%.") << "and no window";
  EXPECT_NE(second["error"], first["error"]) << "the selected point is drawn";
  EXPECT_EQ(saw_["over"]["at"][2], second) << "a point without such a curve leaves it";
  EXPECT_EQ(saw_["over"]["points"].size(), 2u);
}

// A dashed line of a chart is dashed in its legend, and as thick.
TEST_F(OverPage, TheLegendHasTheLinesOfTheChart) {
  for (const char* chart : {"over", "reduction"}) {
    const json &legend = saw_[chart]["legend"], &drawn = saw_[chart]["drawn"];
    ASSERT_EQ(legend.size(), 3u) << legend;
    for (const json& one : legend)
      EXPECT_NE(std::find(drawn.begin(), drawn.end(), one[1]), drawn.end()) << one << " is none of " << drawn;
  }
}

// Two groups of choices. One choice has no curve and no error, one has no usable window.
class SpeedPage : public Browser {
 protected:
  void SetUp() override {
    Results results = sample_results();
    for (size_t i = 28; i < 32; ++i) results.points[i].settings["scene.name"] = "plane";
    results.points[0].curve.reset();
    results.points[0].metrics["error"] = 0;
    results.points[0].metrics["map_ms"] = 100;  // the most, so that others are on the front of map_ms too
    for (auto end : {&BiasCurve::window_min_depth, &BiasCurve::window_max_depth})
      (*results.points[18].curve).*end = std::nullopt;
    results.info.swept.push_back("scene.name");
    for (size_t i = 0; i < 32; ++i)
      has_window_ += i > 0 && i < 28 && results.points[i].curve->window_min_depth.has_value();
    for (PointRecord& point : results.points) {
      point.metrics["texel_work"] = 1e6;  // all marks side by side
      point.metrics["map_low_ms"] = 0.9 * point.metrics["map_ms"];
      point.metrics["map_high_ms"] = 1.2 * point.metrics["map_ms"];
    }
    const ComparedGroup group = compared_groups(results).at(0);
    const report::ChoiceNames names(results);
    for (size_t i : report::front_of(group, "map_ms", "error"))
      front_.push_back(names.of(group.choices[i].choice, AtBias::best));
    open(render_report(results, sample_picture), "speed_probe.js");
  }
  int has_window_ = 0;
  std::vector<std::string> front_;  // from cheap to accurate, if the cost is map_ms
};

TEST_F(SpeedPage, DrawsEachChoiceAtItsBestBias) {
  const json& first = saw_["first"];
  EXPECT_EQ(first["choices"], 28);
  EXPECT_EQ(first["bars"], 0) << "the balanced choice has no curve";
  EXPECT_EQ(saw_["bars_of_selected"], 1);
  EXPECT_EQ(first["crosses"], 27 - has_window_) << "a cross for each empty window";
  EXPECT_EQ(first["rings"], 1) << "of choices of one cost, one is all three answers";
  EXPECT_EQ(first["labels"], json({"least, balanced, best"}));
  EXPECT_EQ(first["zeros"], 1) << "an error of 0 needs a mark of its own on a logarithmic axis";
  EXPECT_EQ(first["titles"], json({"Error against the hard truth", "Texel work (number)"}));
  EXPECT_EQ(first["shapes"], 3) << "two filters and the cross";
  EXPECT_LT(saw_["at_one_cost"], 1.0) << "choices of equal cost must be drawn at that cost";
  EXPECT_TRUE(saw_["apart"]) << "marks must not hide each other";
  EXPECT_FALSE(saw_["shared"].empty());
  EXPECT_EQ(saw_["counts"], saw_["shared"]) << "a mark says how many more it stands for";
  EXPECT_NE(saw_["ticks"].dump().find("1\u202fM"), std::string::npos) << saw_["ticks"];
  EXPECT_EQ(saw_["words"].get<std::string>().find("Least, balanced, best: "), 0u) << saw_["words"];
  for (const char* text : {"at no usable bias", "Largest cause", "filter", "box", "answer"})
    EXPECT_NE(saw_["legend"].get<std::string>().find(text), std::string::npos) << text;
  EXPECT_TRUE(saw_["width"]);
}

TEST_F(SpeedPage, LetsTheReaderChooseAxesGroupAndShape) {
  EXPECT_EQ(saw_["options"], (json{{"compare", 2}, {"cost", 4}, {"error", 2}, {"shape", 3}}));
  const json& soft = saw_["soft"];
  EXPECT_EQ(soft["titles"][0], "Error against the light's size");
  EXPECT_EQ(soft["bars"], 2) << "the selected choice has a window, and so has one on the curve that errs least";
  EXPECT_EQ(soft["choices"], 28) << "the curve gives this error at every bias too";
  EXPECT_EQ(saw_["soft_note"].get<std::string>().find("as rendered"), std::string::npos) << saw_["soft_note"];
  EXPECT_EQ(saw_["first"]["cost_bars"], 0) << "a cost that does not depend on the machine has no interval";
  EXPECT_EQ(saw_["map_ms"]["titles"][1], "Map (ms)");
  EXPECT_EQ(saw_["map_ms"]["cost_bars"], 28) << "the interval of each time";
  EXPECT_NE(saw_["map_ms_legend"].get<std::string>().find("interval of the time"), std::string::npos);
  EXPECT_NE(saw_["map_ms_words"].get<std::string>().find(" … "), std::string::npos) << saw_["map_ms_words"];
  EXPECT_EQ(saw_["map_ms_front"], json(front_)) << "the page's front must be that of front_of()";
  EXPECT_EQ(saw_["by_resolution"]["choices"], 28);
  EXPECT_EQ(saw_["by_resolution"]["shapes"], 5) << "four extents and the cross";
  EXPECT_EQ(saw_["other"]["choices"], 4);
}

TEST_F(SpeedPage, SelectsWithClicksAndKeys) {
  EXPECT_EQ(saw_["clicked"], json({18}));
  EXPECT_EQ(saw_["chosen_rings"], 1);
  EXPECT_EQ(saw_["picture"], 1) << "point 18 has pictures";
  EXPECT_NE(saw_["tip"].get<std::string>().find("no bias is good enough"), std::string::npos) << saw_["tip"];
  EXPECT_NE(saw_["clicked_words"].get<std::string>().find("no bias is good enough"), std::string::npos);
  EXPECT_EQ(saw_["by_key"], json({saw_["next"]}));
}

// The chart draws the front of the bias that the page has, and the table shows it.
class FrontPage : public Browser {};

TEST_F(FrontPage, TheFrontFollowsTheBiasOfThePage) {
  Results results = sample_results();
  for (PointRecord& point : results.points) {
    point.metrics["texel_work"] = 1e6 * static_cast<double>(1 + point.id);
    // Every second one is rendered with a usable bias, the others with one that is too large.
    if (!point.curve || !point.curve->window_min_depth) continue;
    const double high = *point.curve->window_max_depth;
    point.settings["bias.unit"] = "depth";
    point.settings[point.curve->parameter] = fmt::format("{}", point.id % 2 ? high : 2 * high);
  }
  const ComparedGroup group = compared_groups(results).at(0);
  size_t curves = 0;
  for (const auto& curve : report::SpeedReadings(group, results).of("texel_work", "error", AtBias::best).curves)
    curves += curve.size() > 1;
  open(render_report(results, sample_picture), "front_probe.js");
  if (IsSkipped()) return;
  EXPECT_EQ(saw_["errors"], json::array());
  for (const char* mode : {"recommended", "set"}) {
    const json& front = saw_[mode];
    EXPECT_EQ(front["bodies"], 1) << "one front is seen at a time";
    ASSERT_FALSE(front["rows"].empty()) << mode;
    json names = json::array();
    for (const json& row : front["rows"]) names.push_back(row[0]);
    EXPECT_EQ(front["drawn"], names) << mode;
    const size_t count = front["rows"].size();
    EXPECT_NE(front["summary"].get<std::string>().find(fmt::format("{} choice{}", count, count == 1 ? "" : "s")),
              std::string::npos)
        << front["summary"];
  }
  EXPECT_NE(saw_["recommended"]["rows"], saw_["set"]["rows"]) << "the sample is not rendered at its best biases";
  // Four extents and two filters make eight techniques over the resolution; one counts at one resolution alone.
  const json& best = saw_["recommended"];
  EXPECT_EQ(best["lines"], curves);
  EXPECT_GE(curves, 7u);
  EXPECT_LE(saw_["set"]["lines"], 8);
  const std::string takeovers = best["takeovers"];
  EXPECT_FALSE(takeovers.empty());
  size_t ahead = 0;
  for (const json& name : best["names"]) ahead += takeovers.find(name.get<std::string>()) != std::string::npos;
  EXPECT_GE(ahead, 1u) << "a technique that errs least somewhere has a label: " << takeovers;
  EXPECT_NE(best["legend"].get<std::string>().find("Over resolution"), std::string::npos);
}

class PhasePage : public Browser {
 protected:
  void SetUp() override {
    PhaseDiagram d = sample_phase();
    d.law_steepest = 3;
    d.points.clear();
    ASSERT_TRUE(d.usable(d.rows[0]).empty());
    ASSERT_EQ(d.usable(d.rows[1]).low, d.bias_m[4]);
    ASSERT_EQ(d.usable(d.rows[1]).high, d.bias_m[4]);
    ASSERT_EQ(d.usable(d.rows[2]).low, d.bias_m[2]);
    open(render_phase(d), "phase_probe.js");
  }
};

TEST_F(PhasePage, HasACellForEachPairAndAnswersThePointer) {
  EXPECT_EQ(saw_["cells"], 24) << "three texel sizes and eight biases";
  EXPECT_EQ(saw_["lines"], 6) << "two bounds, each worst and mean, and two lines of law 1";
  EXPECT_GT(saw_["hatch"], 4);
  EXPECT_NE(saw_["texts"].dump().find("usable up to 20"), std::string::npos) << saw_["texts"];
  EXPECT_NE(saw_["tip"].get<std::string>().find("64 texels of 40"), std::string::npos) << saw_["tip"];
  EXPECT_NE(saw_["tip"].get<std::string>().find("Acne"), std::string::npos) << saw_["tip"];
  EXPECT_EQ(saw_["command"],
            "noonmark render --set scene.name='x y' --set map.resolution=64 --set bias.constant=0.001");
  const json& keys = saw_["keys"];
  EXPECT_EQ(keys["stop"], 0) << "one tab stop";
  EXPECT_EQ(keys["corner"].get<std::string>().find("64 texels of 40"), 0U) << keys;
  EXPECT_NE(keys["corner"].get<std::string>().find("not usable, error "), std::string::npos) << keys;
  EXPECT_NE(keys["right"], keys["corner"]);
  EXPECT_EQ(keys["frames"], 1);
  EXPECT_NE(keys["command"].get<std::string>().find("--set map.resolution=64 "), std::string::npos) << keys;
  EXPECT_NE(keys["command"], saw_["command"]) << "the second bias";
  EXPECT_EQ(saw_["rows"], 3) << "the table for readers without JavaScript";
  EXPECT_EQ(saw_["title"], "Phase diagram of a <b> scene");
}

// The diagram of a sweep, with its points.
class ReportWithPhase : public Browser {
 protected:
  void SetUp() override {
    Results results = sample_results();
    results.phases = {sample_phase()};
    open(render_report(results, sample_picture), "phase_probe.js");
  }
};

TEST_F(ReportWithPhase, HasTheDiagramAndThePointsOnIt) {
  EXPECT_EQ(saw_["first_figure"], "chart-function") << "the function of all three stands above its slice";
  EXPECT_EQ(saw_["cells"], 24);
  EXPECT_EQ(saw_["lines"], 5) << "the steepest plane has no line, because law 1 gave no number";
  const json& points = saw_["points"];
  EXPECT_EQ(points["rings"], 2) << "two points share a place, a third has its own, the fourth is left out";
  EXPECT_NE(points["tip"].get<std::string>().find("Point 0: "), std::string::npos) << points["tip"];
  EXPECT_NE(points["tip"].get<std::string>().find("Point 1: "), std::string::npos) << points["tip"];
  EXPECT_EQ(points["links"], json({"#p0", "#p1"}));
  EXPECT_EQ(points["selected"], json::array({0}));
  EXPECT_NE(saw_["keys"]["first"].get<std::string>().find("; points 0, 1."), std::string::npos) << saw_["keys"];
  EXPECT_EQ(points["rows"], 3) << "the table for readers without JavaScript";
  EXPECT_EQ(saw_["command"],
            "noonmark render --set scene.name='x y' --set map.resolution=64 --set bias.constant=0.001");
}

// So many points that the page packs its data.
Results packed_results() {
  Results results = sample_results();
  const std::vector<PointRecord> sample = results.points;
  for (size_t id = sample.size(); id < 600; ++id) {
    PointRecord point = sample[id % sample.size()];
    point.id = static_cast<int64_t>(id);
    point.pictures.clear();
    point.settings["map.extent_m"] = fmt::format("{}", 100 + id);
    results.points.push_back(std::move(point));
  }
  results.planned_points = static_cast<int64_t>(results.points.size());
  return results;
}

class PackedPage : public Browser {};

TEST_F(PackedPage, HasTheSameDataAndDrawsThem) {
  const Results results = packed_results();
  const json data = report::chart_data(report::shown_points(results));
  ASSERT_GT(data.dump().size(), size_t{1} << 20) << "the page of this test must be packed";
  open(render_report(results, sample_picture), "packed_probe.js");
  if (IsSkipped()) return;
  EXPECT_TRUE(saw_["packed"]);
  EXPECT_EQ(saw_["points"], data["points"]);
  EXPECT_LE(saw_["cells"], 2 * 4 * 6) << "of hundreds of extents six are shown";
  EXPECT_GE(saw_["cells"], 6) << "most of them were measured at one resolution alone";
  EXPECT_EQ(saw_["rows"], 60) << "the table makes its first rows";
}

TEST_F(PackedPage, IsReadWithoutScriptsWhereTheBrowserCannotUnpack) {
  std::string page = render_report(packed_results(), sample_picture);
  page.insert(page.find("</head>"), "<script>delete window.DecompressionStream;</script>");
  open(page, "packed_probe.js");
  if (IsSkipped()) return;
  EXPECT_EQ(saw_.count("points"), 0u);
  EXPECT_EQ(saw_["said"].get<std::string>().find("This browser cannot unpack the data"), 0u) << saw_["said"];
  EXPECT_EQ(saw_["fallback_rows"], 600) << "the table for readers without JavaScript";
}

}  // namespace
}  // namespace noonmark
