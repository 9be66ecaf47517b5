// Residuals are not shares. The report and the summary show them as plain numbers, which can be compared with the limit
// of 1e-6.
#include <gtest/gtest.h>

#include "compare/report/report.h"
#include "compare/report/summary.h"
#include "compare/report/text.h"
#include "compare/results/metrics.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(ReportUnits, ShowResidualsPlainly) {
  const Results results = sample_results();  // residual 2.4e-7, and a bound of 1e-6 on it
  const std::string page = render_report(results, sample_picture);
  EXPECT_TRUE(contains(page, "2.4×10⁻⁷"));
  EXPECT_FALSE(contains(page, "2.4×10⁻⁵")) << "a residual must not be a percentage";
  const std::string summary = to_summary(results);
  EXPECT_TRUE(contains(summary, "2.4e-07") || contains(summary, "2.4e-7")) << summary;
  EXPECT_FALSE(contains(summary, "2.4e-05"));
}

TEST(ReportUnits, FollowTheMetricsTable) {
  for (const Metric& metric : metrics_table()) {
    const std::string shown = report::quantity(0.25, metric.unit);
    EXPECT_EQ(shown.ends_with('%'), metric.unit == "fraction") << metric.name << ": " << shown;
    if (metric.unit.empty()) {
      EXPECT_EQ(shown, "0.25") << metric.name;
    }
  }
}

TEST(ReportUnits, AreInTheSingularBehindOne) {
  EXPECT_EQ(report::bias_in_unit(1, "texel"), "1\u202ftexel");
  EXPECT_EQ(report::bias_in_unit(0.5, "texel"), "0.5\u202ftexels");
  EXPECT_EQ(report::quantity(1, "texels"), "1\u202ftexel");
  PointRecord point;
  point.settings = {{"bias.constant", "4"}, {"bias.unit", "texel"}, {"map.resolution", "1"}};
  EXPECT_EQ(report::settings_phrase(point, {"bias.constant", "map.resolution"}),
            "bias constant 4\u202ftexels, resolution 1\u202ftexel");
}

// A table's head says the unit of a bias, not the name of the setting that holds it.
TEST(ReportUnits, OfABiasAreThoseOfThePoints) {
  Results results;
  results.points.resize(2);
  for (PointRecord& point : results.points) point.settings = {{"bias.unit", "texel"}};
  EXPECT_EQ(report::swept_unit("bias.constant", results), "texels");
  EXPECT_EQ(report::swept_unit("map.extent_m", results), "m");
  results.points[1].settings["bias.unit"] = "m";
  EXPECT_EQ(report::swept_unit("bias.constant", results), "") << "they differ";
  results.info.swept = {"bias.constant"};
  EXPECT_FALSE(contains(render_report(results, sample_picture), "bias.unit</small>"));
}

}  // namespace
}  // namespace noonmark
