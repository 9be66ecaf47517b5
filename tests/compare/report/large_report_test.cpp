// The report over many points: generated records, nothing is measured. Counted are candidates and bytes, not seconds,
// because seconds depend on the machine.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "compare/judge/recommendation.h"
#include "compare/report/cause_shares.h"
#include "compare/report/report.h"
#include "compare/report/shown.h"
#include "compare/results/quantities.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

// A grid of resolutions, extents and biases, with the metrics and curves of the sample in turn.
Results grid(int resolutions, int extents, int biases) {
  Results results = sample_results();
  const std::vector<PointRecord> sample = std::move(results.points);
  results.points.clear();
  results.bounds.clear();
  results.info.swept = {"map.resolution", "map.extent_m", "bias.constant"};
  for (int r = 0; r < resolutions; ++r)
    for (int e = 0; e < extents; ++e)
      for (int b = 0; b < biases; ++b) {
        const size_t id = results.points.size();
        PointRecord point = sample[id * 7 % sample.size()];
        point.id = static_cast<int64_t>(id);
        point.pictures.clear();
        point.settings["map.resolution"] = fmt::format("{}", 64 + 16 * r);
        point.settings["map.extent_m"] = fmt::format("{}", 4 + 0.25 * e);
        point.settings["bias.constant"] = fmt::format("{}", 0.001 * b);
        const double texel_m = (4 + 0.25 * e) / (64 + 16 * r);
        point.curve->texels_per_depth = point.curve->m_per_depth / texel_m;
        point.metrics["shadow_ms"] = 0.1 + 1e-3 * static_cast<double>(id * 7919 % 10007);
        results.points.push_back(std::move(point));
      }
  results.planned_points = static_cast<int64_t>(results.points.size());
  return results;
}

std::string page_of(const Results& results) {
  return render_report(results, [](const std::string&) { return std::string(); });
}

// Each link to a point leads to a row.
void expect_links_to_lead_somewhere(const std::string& page) {
  const auto all = [&](const char* pattern) {
    std::set<std::string> found;
    const std::regex regex(pattern);
    for (std::sregex_iterator i(page.begin(), page.end(), regex), end; i != end; ++i) found.insert((*i)[1]);
    return found;
  };
  const std::set<std::string> links = all("href=\"#(p[0-9]+)\""), rows = all("<tr id=\"(p[0-9]+)\"");
  EXPECT_GT(links.size(), 100u);
  for (const std::string& id : links) EXPECT_TRUE(rows.contains(id)) << id << " has no row";
}

TEST(LargeReport, OfTenThousandPointsStaysUnderTenMegabytes) {
  Results results = grid(10, 100, 10);
  BoundResult bound;
  bound.metric = "error";
  bound.max = 0.001;
  bound.point = 4711;  // not on the grid of the shown points
  bound.points = 10000;
  results.bounds.push_back(bound);
  const std::string page = page_of(results);
  EXPECT_LT(page.size(), 10'000'000u);
  EXPECT_NE(page.find("of 10000 points</b>"), std::string::npos) << "the page must say that it does not show all";
  EXPECT_NE(page.find("8 of the 100 values of extent"), std::string::npos);
  EXPECT_NE(page.find("results.csv"), std::string::npos);
  EXPECT_NE(page.find("<tr id=\"p4711\""), std::string::npos);
  const Recommendation found = recommend(results);
  if (found.outcome == Recommendation::Outcome::found) {
    EXPECT_NE(page.find(fmt::format("<tr id=\"p{}\"", found.choice.first().id)), std::string::npos);
  }
  expect_links_to_lead_somewhere(page);

  results.points.resize(results.points.size() - 2500);  // interrupted: the points are no grid
  const std::string interrupted = page_of(results);
  EXPECT_NE(interrupted.find("evenly chosen points of the sweep"), std::string::npos);
  EXPECT_LT(interrupted.size(), 10'000'000u);
  expect_links_to_lead_somewhere(interrupted);
}

// Four times as many points; both sweeps have several times the points that a page shows.
TEST(LargeReport, DoesNotGrowWithPointsThatItDoesNotShow) {
  const size_t some = page_of(grid(10, 25, 10)).size(), more = page_of(grid(10, 100, 10)).size();
  // The tables of means have a row for each value, also for 100 extents.
  EXPECT_LT(static_cast<double>(more), 1.1 * static_cast<double>(some));
}

TEST(LargeReport, UpToAThousandPointsAreShownWhole) {
  const Results results = grid(10, 10, 10);
  const report::ShownPoints shown = report::shown_points(results);
  EXPECT_EQ(shown.note, "");
  EXPECT_EQ(shown.results.points.size(), results.points.size());
  EXPECT_EQ(page_of(results).find("class=\"note thinned\""), std::string::npos);
}

TEST(LargeReport, KeepsWholeLinesOfAChart) {
  const Results results = grid(10, 200, 10);
  const report::ShownPoints shown = report::shown_points(results);
  std::map<std::string, size_t> line;  // by extent: how many combinations of the 7 resolutions and 8 biases
  for (const PointRecord& point : shown.results.points) ++line[setting_of(point, "map.extent_m")];
  EXPECT_EQ(std::count_if(line.begin(), line.end(), [](const auto& one) { return one.second >= 56; }), 8);
  EXPECT_EQ(line.count("4"), 1u);
  EXPECT_EQ(line.count("53.75"), 1u);
  EXPECT_LE(shown.results.points.size(), report::max_even_points + report::max_marked_points);
  for (const Recommendation& found : {recommend(results)})
    if (found.outcome == Recommendation::Outcome::found) {
      EXPECT_TRUE(std::any_of(shown.results.points.begin(), shown.results.points.end(),
                              [&](const PointRecord& point) { return point.id == found.choice.first().id; }));
    }
}

}  // namespace
}  // namespace noonmark
