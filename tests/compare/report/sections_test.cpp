// Which sections the report has, what is folded in them, and how their tables are aligned.
#include <gtest/gtest.h>

#include <string>

#include "compare/judge/recommendation.h"
#include "compare/judge/tradeoff.h"
#include "compare/report/opening.h"
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
  for (PointRecord& point : results.points) point.metrics["ambiguous"] = 0, point.curve.reset();
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

// A row for each point with a curve over the reduction; columns for the placements only where one was placed.
TEST(Report, ListsTheWindowsOfTheReduction) {
  Results results = sample_results();
  EXPECT_EQ(render_report(results, sample_picture).find("<section id=\"reduction\""), std::string::npos);
  for (size_t k : {2u, 4u}) {
    for (const double r : {0.0, 0.25, 0.5})  // what OpenGL shows errs least at 0.25, and the exact map at 0.5
      results.points[k].lookup_curve.push_back(
          {"lookup.reduction", r, 0.01 - 0.01 * r, 0.002, 0, 0, 0, 0, 0, 0, r == 0.25 ? 0.004 : 0.008});
    results.points[k].metrics.insert({{"best_reduction", 0.5}, {"best_reduction_error", 0.005}});
  }
  results.points[2].metrics.insert({{"reduction_min", 0.125}, {"reduction_max", 0.375}});
  const auto section = [&] {
    const std::string page = render_report(results, sample_picture);
    const size_t from = page.find("<section id=\"reduction\"");
    EXPECT_NE(from, std::string::npos);
    return page.substr(from, page.find("</section>", from) - from);
  };
  const std::string without = section();
  EXPECT_NE(without.find("<td>0.125</td><td>0.375</td><td>0.25</td><td>0.4</td>"), std::string::npos) << without;
  EXPECT_NE(without.find("<td colspan=\"2\">none</td>"), std::string::npos) << without;
  EXPECT_EQ(without.find("placement"), std::string::npos) << without;
  results.points[2].metrics.insert(
      {{"error_mean", 0.01}, {"reduction_min_worst", 0.1875}, {"reduction_max_worst", 0.3125}});
  const std::string placed = section();
  EXPECT_NE(placed.find("<td>0.188</td><td>0.312</td>"), std::string::npos) << placed;
  EXPECT_NE(placed.find("<td colspan=\"2\">–</td>"), std::string::npos) << placed;
}

// A part that has a good choice says what to set; one whose windows are empty why, and what may help; one without a curve and
// without a bound that nothing was asked of it.
TEST(Report, SaysWhatToSetInEachPart) {
  Results results = filtered_sample_results();
  const char* const parts[] = {"leaks", "holds", "as it is"};
  for (size_t k = 0; k < 3; ++k) results.points[k].part = parts[k];
  results.points[2].lookup_curve.clear(), results.points[2].lookup_bounds.reset();
  results.points[2].settings["lookup.reduction_span"] = "0.65";
  for (const char* name : {"reduction_min", "reduction_max"}) results.points[2].metrics.erase(name);
  const std::string page = render_report(results, sample_picture);
  const size_t from = page.find("What to set in each part");
  ASSERT_NE(from, std::string::npos);
  const std::string table = page.substr(from, page.find("</table>", from) - from);
  const auto says = [&](const char* text) { EXPECT_NE(table.find(text), std::string::npos) << text << "\n" << table; };
  says("3 rows");
  says("lookup.reduction 0.19</td><td>0.15</td><td>0.2</td>");
  says("Without a reduction the leak is 1%");
  says("It is held to no bound");
  EXPECT_NE(page.find("<section id=\"reduction\""), std::string::npos) << "and the curves are there";
  // What breaks a bound is not held to none.
  results.points[2].metrics["error"] = 0.5;
  BoundResult bound;
  bound.metric = "error", bound.part = parts[2], bound.max = 0.1;
  bound.found = 0.5, bound.point = results.points[2].id, bound.points = 1;
  results.bounds.push_back(bound);
  const std::string bounded = render_report(results, sample_picture);
  EXPECT_NE(bounded.find("It breaks a bound."), std::string::npos);
  for (const char* unjudged : {"It is held to no bound", "held to no bound</small>", "\"judged\":false"}) {
    EXPECT_NE(page.find(unjudged), std::string::npos) << unjudged;
    EXPECT_EQ(bounded.find(unjudged), std::string::npos) << unjudged;
  }
  results.bounds.clear();
  results.laws.push_back(sample_law());
  EXPECT_EQ(render_report(results, sample_picture).find("What to set in each part"), std::string::npos)
      << "the parts of laws are no choices";
}

// The first picture is of the point that the answer names; of another one it says so.
TEST(Report, TheLivePictureIsTheAnswers) {
  Results results = filtered_sample_results();
  const auto picture = [](PointRecord& point) { point.images.push_back({"images/x-live.bin", ""}); };
  const auto opened = [&] { return report::opening(results).point->id; };
  picture(results.points[0]);
  ASSERT_EQ(recommend(results).choice.first().id, 1);
  EXPECT_EQ(opened(), 0) << "the answer has no picture";
  const auto read = [](const std::string&) {
    return std::string(R"({"kind":"stack","width":1,"height":1,"answers":0,"parameter":"lookup.reduction",)"
                       R"("values":[{"value":0}]})") +
           "\n";
  };
  EXPECT_NE(render_report(results, read).find(" The answer is <a href=\"#p1\">point 1</a>, which has no pictures"),
            std::string::npos);
  picture(results.points[1]);
  EXPECT_EQ(opened(), 1);
  EXPECT_EQ(render_report(results, read).find(" The answer is <a"), std::string::npos);
  for (size_t k = 0; k < 3; ++k) results.points[k].part = k < 2 ? "one" : "two";
  EXPECT_EQ(opened(), 1) << "the head of a report of parts names it too";
  results.points[1].images.clear();
  EXPECT_EQ(opened(), 0);
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
