// The report's first figure: which charts it has, and that what it draws are the numbers of the results.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "compare/judge/curve_reading.h"
#include "compare/report/function_figure.h"
#include "compare/report/function_shapes.h"
#include "compare/report/report.h"
#include "compare/report/shown.h"
#include "tests/compare/report/page_text.h"
#include "tests/compare/report/sample.h"

namespace noonmark::report {
namespace {

// Half a unit of the box, in which places are whole numbers.
constexpr double half = 0.5 + 1e-9;

std::string attribute(const std::string& text, const std::string& name) {
  std::smatch found;
  return std::regex_search(text, found, std::regex(" " + name + "=\"([^\"]*)\"")) ? found[1].str() : "";
}

std::vector<std::string> elements(const std::string& html, const std::string& pattern) {
  std::vector<std::string> out;
  const std::regex regex(pattern);
  for (std::sregex_iterator i(html.begin(), html.end(), regex); i != std::sregex_iterator(); ++i)
    out.push_back(i->str());
  return out;
}

// The corners of a path "M70 980l0 0 13 -4".
std::vector<std::pair<double, double>> corners(const std::string& path) {
  std::vector<std::pair<double, double>> out;
  double x = 0, y = 0;
  for (const std::string& step : elements(path, "-?[0-9]+ -?[0-9]+")) {
    const size_t space = step.find(' ');
    x += std::stod(step.substr(0, space)), y += std::stod(step.substr(space));
    out.emplace_back(x, y);
  }
  return out;
}

// Of the upper edge of a layer, whose first and last corner stand on the ground. At a jump the upper end.
double height(const std::vector<std::pair<double, double>>& edge, long x) {
  double least = 1000;
  for (size_t i = 1; i + 2 < edge.size(); ++i) {
    const auto [x0, y0] = edge[i];
    const auto [x1, y1] = edge[i + 1];
    if (static_cast<double>(x) < x0 || static_cast<double>(x) > x1) continue;
    least = std::min(least, x1 > x0 ? y0 + (y1 - y0) * (static_cast<double>(x) - x0) / (x1 - x0) : std::min(y0, y1));
  }
  return least;
}

double at_bias(const BiasCurve& curve, const char* metric, double metres) {
  return curve_value(curve, metric, metres / curve.m_per_depth).value();
}

// Every corner of every layer is the sum of the causes below it at the curve's own bias.
TEST(FunctionFigure, StacksTheCurves) {
  const Results results = sample_results();
  const FunctionFigure figure = function_figure(results);
  const FunctionScale scale = function_scale(figure);
  const std::vector<std::string> order = {"acne", "peter_panning", "aliasing", "coverage"};
  ASSERT_GE(figure.causes.size(), order.size());
  for (size_t k = 0; k < order.size(); ++k) EXPECT_EQ(figure.causes[k].name, order[k]);
  for (const size_t index : {5u, 10u}) {
    const FunctionCell& cell = figure.grids[0].cells[index];
    const BiasCurve& curve = *cell.points.front()->curve;
    const std::string html = function_shapes(cell, figure, scale).html();
    const std::vector<size_t> entries = drawn_entries(cell, scale);
    size_t seen = 0;
    for (const std::string& path : elements(html, "<path[^>]*data-cause[^>]*>")) {
      const auto found = std::find(order.begin(), order.end(), attribute(path, "data-cause"));
      if (found == order.end()) continue;
      const std::vector<std::pair<double, double>> all = corners(attribute(path, "d"));
      for (size_t i = 0; i < entries.size(); ++i) {
        const double bias = curve.bias_depth[entries[i]] * curve.m_per_depth;
        double sum = 0;
        for (auto cause = order.begin(); cause <= found; ++cause) sum += at_bias(curve, cause->c_str(), bias);
        EXPECT_NEAR(height(all, std::lround(scale.x(bias))), 1000 * (1 - std::sqrt(std::min(1.0, sum / scale.top))),
                    half)
            << bias << " m";
        ++seen;
      }
    }
    EXPECT_GE(seen, 3 * entries.size()) << "acne, Peter Panning, aliasing";
  }
}

TEST(FunctionFigure, MarksTheWindowAndTheBiasAsSetOfTheResults) {
  const Results results = sample_results();
  const FunctionFigure figure = function_figure(results);
  const FunctionScale scale = function_scale(figure);
  size_t windows = 0;
  for (const FunctionGrid& grid : figure.grids)
    for (const FunctionCell& cell : grid.cells) {
      const PointRecord& point = *cell.points.front();
      const std::string html = function_shapes(cell, figure, scale).html();
      const std::vector<std::string> marks = elements(html, "<rect[^>]*var\\(--window\\)[^>]*>");
      const std::optional<Interval> window = usable_window(point);
      ASSERT_EQ(marks.size(), window ? 1u : 0u) << point.id;
      if (window) {
        const double from = scale.x(window->low * point.curve->m_per_depth),
                     to = scale.x(window->high * point.curve->m_per_depth);
        EXPECT_NEAR(std::stod(attribute(marks[0], "x")), from, half);
        EXPECT_NEAR(std::stod(attribute(marks[0], "width")), to - from, half);
        ++windows;
      }
      const std::vector<std::string> set = elements(html, "<line[^>]*var\\(--accent\\)[^>]*>");
      ASSERT_EQ(set.size(), 1u);
      EXPECT_NEAR(std::stod(attribute(set[0], "x1")), scale.x(*bias_as_set(point) * point.curve->m_per_depth), half);
    }
  EXPECT_GT(windows, 5u);
}

// Resolution across and extent down, whatever was swept first; the filter is a switch.
TEST(FunctionFigure, HasResolutionAcrossAndExtentDown) {
  Results results = sample_results();
  std::reverse(results.info.swept.begin(), results.info.swept.end());
  const FunctionFigure figure = function_figure(results);
  EXPECT_EQ(figure.switches, std::vector<std::string>{"filter.kind"});
  ASSERT_EQ(figure.grids.size(), 2u);
  const FunctionGrid& grid = figure.grids[1];
  EXPECT_EQ(grid.column, "map.resolution");
  EXPECT_EQ(grid.row, "map.extent_m");
  EXPECT_EQ(grid.columns.size() * grid.rows.size(), grid.cells.size());
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    const PointRecord& point = *grid.cells[i].points.front();
    EXPECT_EQ(point.settings.at("map.resolution"), grid.columns[i % grid.columns.size()]);
    EXPECT_EQ(point.settings.at("map.extent_m"), grid.rows[i / grid.columns.size()]);
    EXPECT_EQ(point.settings.at("filter.kind"), grid.chosen[0]);
  }
  const FunctionCell* const largest = largest_usable(grid);
  ASSERT_NE(largest, nullptr);
  for (const FunctionCell& cell : grid.cells)
    if (usable_window(*cell.points.front())) {
      EXPECT_LE(cell.texel_m, largest->texel_m);
    }
}

// The swept bias is the axis of a chart, not a chart of its own.
TEST(FunctionFigure, PutsPointsThatDifferInTheBiasIntoOneChart) {
  Results results = sample_results();
  results.info.swept.push_back("bias.constant");
  const std::vector<PointRecord> points = results.points;
  for (const PointRecord& point : points) {
    results.points.push_back(point);
    results.points.back().id += 100;
    results.points.back().settings["bias.constant"] = "0.001";
    std::swap(results.points.back().settings, results.points[static_cast<size_t>(point.id)].settings);
  }
  const FunctionFigure figure = function_figure(results);
  ASSERT_EQ(figure.grids.size(), 2u);
  EXPECT_EQ(figure.grids[0].inner, "bias.constant");
  for (const FunctionCell& cell : figure.grids[0].cells) {
    ASSERT_EQ(cell.points.size(), 2u);
    EXPECT_EQ(cell.points[1]->settings.at("bias.constant"), "0.001") << "by ascending values";
  }
}

TEST(FunctionFigure, HasBarsWhereTheBiasHasNoCurve) {
  Results results = sample_results();
  for (PointRecord& point : results.points) point.curve.reset();
  const FunctionFigure figure = function_figure(results);
  const FunctionScale scale = function_scale(figure);
  const FunctionGrid& grid = figure.grids.at(0);
  EXPECT_EQ(grid.inner, "map.resolution") << "no bias was swept";
  EXPECT_EQ(grid.column, "map.extent_m");
  EXPECT_EQ(grid.row, "filter.kind");
  const FunctionCell& cell = grid.cells.at(0);
  ASSERT_EQ(cell.points.size(), 4u);
  const std::string html = function_shapes(cell, figure, scale).html();
  const std::vector<std::string> acne = elements(html, "<rect[^>]*var\\(--c-acne\\)[^>]*>");
  const std::vector<std::string> error = elements(html, "<line[^>]*var\\(--ink\\)[^>]*>");
  ASSERT_EQ(acne.size(), 1u) << "the coarsest map alone has acne";
  EXPECT_NEAR(std::stod(attribute(acne[0], "y")), scale.y(cell.points[0]->metrics.at("acne")), half) << "at the ground";
  ASSERT_EQ(error.size(), 4u);
  for (size_t i = 0; i < error.size(); ++i)
    EXPECT_NEAR(std::stod(attribute(error[i], "y1")), scale.y(cell.points[i]->metrics.at("error")), half);
}

TEST(FunctionFigure, StacksFirstWhatTheExperimentAsksToPlot) {
  Results results = sample_results();
  results.info.plot = {"coverage_dark", "error", "acne", "shadow_ms"};
  const FunctionFigure figure = function_figure(results);
  ASSERT_GE(figure.causes.size(), 2u);
  EXPECT_EQ(figure.causes[0].name, "coverage") << "the whole cause";
  EXPECT_EQ(figure.causes[1].name, "acne");
  const nlohmann::json data = embedded_data(render_report(results, sample_picture));
  EXPECT_EQ(data["metrics"][0]["name"], "coverage_dark") << "and in the lists";
  EXPECT_EQ(data["metrics"][2]["name"], "acne");
  EXPECT_EQ(data["speed"]["costs"][1], "shadow_ms") << "behind the cost that ranks the answers";
}

TEST(FunctionFigure, HasAGridForEachPart) {
  Results results = sample_results();
  for (PointRecord& point : results.points) point.part = point.id < 2 ? "one" : "two";
  const FunctionFigure figure = function_figure(results);
  ASSERT_EQ(figure.switches.front(), "part");
  EXPECT_EQ(figure.grids.front().chosen.front(), "one");
  EXPECT_EQ(figure.grids.front().columns.size(), 2u) << "of its own values";
  EXPECT_EQ(figure.grids.back().chosen.front(), "two");
  EXPECT_EQ(figure.grids.back().cells.size(), 16u);
}

// A store can hold any numbers.
TEST(FunctionFigure, DrawsWhateverAStoreHolds) {
  const double no_number = std::nan(""), infinite = INFINITY;
  for (const double odd : {no_number, infinite, -1.0, 0.0, 1e-320, 1e308}) {
    Results results = sample_results();
    for (PointRecord& point : results.points) {
      BiasCurve& curve = *point.curve;
      switch (point.id % 8) {
        case 0:
          curve.m_per_depth = odd;
          break;
        case 1:
          curve.texels_per_depth = odd;
          break;
        case 2:
          curve.acne[5] = curve.error[6] = curve.acne_bound = odd;
          break;
        case 3:
          curve.bias_depth.back() = odd;
          break;
        case 4:
          curve.bias_depth.clear();
          break;
        case 5:
          curve.acne.resize(3), curve.error_band.worst = {odd};
          break;
        case 6:
          curve.window_min_depth = curve.window_max_depth = odd;
          break;
        case 7:
          curve.bias_depth.erase(curve.bias_depth.begin()), curve.error.erase(curve.error.begin());
          break;
      }
    }
    const std::string html = function_chart(shown_points(results)).html();
    EXPECT_EQ(elements(html, "[\"( ](-?nan|inf)[\") ]"), std::vector<std::string>()) << odd;
    EXPECT_EQ(elements(html, "[ \"-][0-9]{12}"), std::vector<std::string>()) << odd;
  }
}

TEST(FunctionFigure, IsLeftOutWhereNoCauseIsKnown) {
  Results results = sample_results();
  for (PointRecord& point : results.points) {
    point.curve.reset();
    point.metrics = {{"error", 0.1}};
  }
  EXPECT_TRUE(function_chart(shown_points(results)).empty());
}

}  // namespace
}  // namespace noonmark::report
