// The strip of a motion, as HTML that needs no script.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/report/flicker_section.h"
#include "compare/report/report.h"
#include "compare/report/text.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

bool holds_text(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

size_t times_of(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

PointRecord frame_record(int64_t id, const std::string& snap, double grid, double kernel) {
  PointRecord point;
  point.id = id;
  point.settings = {{"motion.frame", std::to_string(id % 3)}, {"map.snap", snap}};
  point.metrics = {{"flicker", grid + kernel}, {"flicker_changed", 2 * (grid + kernel)},
                   {"flicker_grid", grid},     {"flicker_depth", 0},
                   {"flicker_kernel", kernel}, {"flicker_coverage", 0},
                   {"flicker_truth", 0},       {"flicker_points", 1000}};
  return point;
}

Results walk() {
  Results results;
  results.info.swept = {"motion.frame", "map.snap"};
  for (int64_t id = 0; id < 3; ++id) results.points.push_back(frame_record(id, "true", 0, 0));
  results.points.push_back(frame_record(3, "false", 0.01, 0));
  results.points.push_back(frame_record(4, "false", 0.02, 0.02));
  results.points.push_back(frame_record(5, "false", 0.0, 0.01));
  return results;
}

TEST(FlickerSection, HasAStripForEachChoiceAndABarForEachFrame) {
  const std::string html = report::flicker_section(walk(), false).html();
  EXPECT_EQ(times_of(html, "<svg"), 2u);
  EXPECT_EQ(times_of(html, "<rect"), 4u);  // a part that is 0 has no bar
  // The worst frame fills the strip: two parts of half its height, one on the other.
  EXPECT_TRUE(holds_text(html, "y=\"30.000\" width=\"300.00\" height=\"30.000\" fill=\"rgb(230,159,0)\"")) << html;
  EXPECT_TRUE(holds_text(html, "y=\"0.000\" width=\"300.00\" height=\"30.000\" fill=\"rgb(0,114,178)\"")) << html;
  EXPECT_TRUE(holds_text(html, "no point of the world changes in any frame"));
  EXPECT_TRUE(holds_text(html, "at most " + report::quantity(0.04, "fraction") + ", at frame 1")) << html;
  EXPECT_EQ(times_of(html, "<tr><th class=\"text\" scope=\"row\">"),
            2u + 6u);  // a row for each choice, and one for each frame
  EXPECT_FALSE(holds_text(html, "<script"));
  EXPECT_FALSE(holds_text(html, "nan"));
}

TEST(FlickerSection, ShowsWhatIsNotFinite) {
  Results results = walk();
  results.points[5].metrics["flicker"] = results.points[5].metrics["flicker_grid"] = std::nan("");
  const std::string html = report::flicker_section(results, false).html();
  EXPECT_TRUE(holds_text(html, "at most not finite, at frame 2")) << html;
}

// The chart of cost against error would lead with what flickers and is cheap.
TEST(FlickerSection, LeadsAReportWithoutALivePictureAndADiagram) {
  Results results = walk();
  results.planned_points = 6;
  for (PointRecord& point : results.points)
    point.metrics.insert({{"error", 0.1},
                          {"facing", 100},
                          {"counted", 100},
                          {"residual", 0},
                          {"tap_residual", 0},
                          {"contract", 0},
                          {"rounding_excess", 0},
                          {"map_excess", 0}});
  const std::string html = render_report(results, sample_picture);
  const size_t strips = html.find("chart strip"), section = html.find("id=\"motion\"");
  ASSERT_NE(strips, std::string::npos);
  EXPECT_LT(strips, section) << "the strips are on the first screen";
  EXPECT_EQ(html.find("chart strip", section), std::string::npos) << "the section has them a second time";
  EXPECT_TRUE(holds_text(html, "Of 2 choices 1 does not flicker in any frame: ")) << html.substr(strips - 900, 900);
  EXPECT_TRUE(holds_text(html, "flickers most: " + report::quantity(0.04, "fraction")))
      << html.substr(strips - 900, 900);
}

TEST(FlickerSection, IsInTheReportOfAMotionOnly) {
  EXPECT_FALSE(holds_text(render_report(sample_results(), sample_picture), "id=\"motion\""));
  Results results = sample_results();
  for (PointRecord& point : results.points) point.metrics.insert({{"flicker", 0.5}, {"flicker_grid", 0.5}});
  EXPECT_TRUE(holds_text(render_report(results, sample_picture), "id=\"motion\""));
}

}  // namespace
}  // namespace noonmark
