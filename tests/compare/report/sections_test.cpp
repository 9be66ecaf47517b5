// Which sections the report has, what is folded in them, and how their tables are aligned.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "compare/report/report.h"
#include "tests/compare/report/sample.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

TEST(Report, NamesTheAnswerOnlyWhereThereIsOne) {
  Results results = sample_results();
  std::string page = render_report(results, sample_picture);
  EXPECT_NE(page.find("<h2>The answer</h2>"), std::string::npos);
  EXPECT_NE(page.find("<a href=\"#answer\">Answer</a>"), std::string::npos);
  for (PointRecord& point : results.points) point.part = "a";  // parts have no answer in common
  page = render_report(results, sample_picture);
  EXPECT_EQ(page.find("The answer"), std::string::npos);
  EXPECT_NE(page.find("<h2>What was found</h2>"), std::string::npos);
  EXPECT_NE(page.find("<a href=\"#answer\">Findings</a>"), std::string::npos);
  results.bounds.clear();
  for (PointRecord& point : results.points) point.metrics["ambiguous"] = 0;
  page = render_report(results, sample_picture);
  EXPECT_EQ(page.find("<section id=\"answer\""), std::string::npos) << "nothing was found";
  results = sample_results();
  results.bounds[1] = {"error", 1e-9, {}, {}, "worst", false, 0.3, 4, 32, ""};  // no choice is good enough
  EXPECT_EQ(render_report(results, sample_picture).find("<h2>The answer</h2>"), std::string::npos);
}

TEST(Report, FoldsTheGlossary) {
  const std::string page = render_report(sample_results(), sample_picture);
  const std::string meaning = page.substr(page.find("<section id=\"meaning\""));
  const size_t folded = meaning.find("<details class=\"glossary\"><summary>Each of the "), terms = meaning.find("<dl");
  ASSERT_NE(folded, std::string::npos);
  EXPECT_LT(folded, terms);
  EXPECT_EQ(meaning.substr(0, meaning.find("</section>")).find("<details open"), std::string::npos);
}

TEST(Report, HasTheTextForTheEngines) {
  Results results = sample_results();
  EXPECT_EQ(render_report(results, sample_picture).find("<section id=\"engines\""), std::string::npos);
  results.info.engines = "three.js (r1)\n    bias = -0.001;  // a < b & c\n";
  const std::string page = render_report(results, sample_picture);
  EXPECT_NE(page.find("<pre class=\"engines\">three.js (r1)\n    bias = -0.001;  // a &lt; b &amp; c\n</pre>"),
            std::string::npos);
  EXPECT_NE(page.find("<a href=\"#engines\">Engines</a>"), std::string::npos);
}

// A row for each point with a curve over the reduction; columns for the placements only where one was placed.
TEST(Report, ListsTheWindowsOfTheReduction) {
  Results results = sample_results();
  EXPECT_EQ(render_report(results, sample_picture).find("<section id=\"reduction\""), std::string::npos);
  for (size_t k : {2u, 4u}) {
    results.points[k].lookup_curve = {{"lookup.reduction", 0, 0.01, 0.002, 0, 0, 0}};
    results.points[k].metrics.insert({{"best_reduction", 0.25}, {"best_reduction_error", 0.004}});
  }
  results.points[2].metrics.insert({{"reduction_min", 0.125}, {"reduction_max", 0.375}});
  const auto section = [&] {
    const std::string page = render_report(results, sample_picture);
    const size_t from = page.find("<section id=\"reduction\"");
    EXPECT_NE(from, std::string::npos);
    return page.substr(from, page.find("</section>", from) - from);
  };
  const std::string without = section();
  EXPECT_NE(without.find("<td>0.125</td><td>0.375</td><td>0.25</td>"), std::string::npos) << without;
  EXPECT_NE(without.find("<td colspan=\"2\">none</td>"), std::string::npos) << without;
  EXPECT_EQ(without.find("placement"), std::string::npos) << without;
  results.points[2].metrics.insert(
      {{"error_mean", 0.01}, {"reduction_min_worst", 0.1875}, {"reduction_max_worst", 0.3125}});
  const std::string placed = section();
  EXPECT_NE(placed.find("<td>0.188</td><td>0.312</td>"), std::string::npos) << placed;
  EXPECT_NE(placed.find("<td colspan=\"2\">–</td>"), std::string::npos) << placed;
}

// What all points share stands in no label of the budget, so that what differs is in it.
TEST(Report, TheBudgetsLabelsDiffer) {
  Results results = sample_results();
  results.info.swept.insert(results.info.swept.begin(), {"scene.name", "light.kind"});
  const std::string page = render_report(results, sample_picture);
  const std::string budget = page.substr(page.find("<section id=\"budget\""));
  std::set<std::string> labels;
  const std::string head = "<span class=\"name\">";
  for (size_t at = budget.find(head); at < budget.find("</section>"); at = budget.find(head, at + 1)) {
    const size_t from = budget.find("\">", at + head.size()) + 2;
    const std::string label = budget.substr(from, budget.find("</a>", from) - from);
    EXPECT_EQ(label.find("resolution "), 0u) << label;
    labels.insert(label);
  }
  EXPECT_EQ(labels.size(), results.points.size());
}

TEST(Report, TextIsLeftAndNumbersAreRight) {
  Results results = sample_results();
  results.laws.push_back(sample_law());
  const std::string page = render_report(results, sample_picture);
  for (const char* cell : {"<td class=\"text\">box</td>", "<th class=\"text\" title=\"filter.kind\">filter</th>",
                           "<td>2048</td>", "<th class=\"text\">Choice</th>", "<th class=\"number\">Samples</th>"})
    EXPECT_NE(page.find(cell), std::string::npos) << cell;
}

}  // namespace
}  // namespace noonmark
