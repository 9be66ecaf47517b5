// The page that `check FOLDER` leaves.
#include "compare/report/index_page.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/report/text.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

IndexEntry entry(std::optional<Verdict> verdict, const std::string& name) {
  IndexEntry one;
  one.verdict = verdict;
  one.experiment = "experiments/" + name + ".toml";
  one.title = name;
  one.report = name + "/report.html";
  one.words = "1 of 2 bounds held";
  one.numbers = "Error at most 3 %";
  return one;
}

TEST(IndexPage, PutsTheBrokenFirstAndLinksEachReport) {
  const std::vector<IndexEntry> entries = {entry(Verdict::held, "alpha"), entry(Verdict::broken, "beta"),
                                           entry({}, "gamma")};
  EXPECT_EQ(index_words(entries), "3 experiments: 1 broken, 1 held, 1 not judged");
  const std::string page = index_page(entries, "0.1.0");
  EXPECT_LT(page.find("beta/report.html"), page.find("gamma/report.html"));
  EXPECT_LT(page.find("gamma/report.html"), page.find("alpha/report.html"));
  for (const char* text :
       {"✓ held", "✗ broken", "! not judged", "1 of 2 bounds held", "Error at most 3 %", "pill broken"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(index_page({entry(Verdict::held, "alpha")}, "0.1.0").find("pill held"), std::string::npos);
}

TEST(IndexPage, EscapesNamesOfFilesAndTitles) {
  IndexEntry evil = entry(Verdict::held, "a b\"><script>x</script>");
  const std::string page = index_page({evil}, "0.1.0");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("href=\"a%20b%22%3E%3Cscript%3Ex%3C/script%3E/report.html\""), std::string::npos);
  evil.report.clear();
  EXPECT_EQ(index_page({evil}, "0.1.0").find("<a href"), std::string::npos) << "there is no report to open";
}

TEST(IndexPage, SaysTheWorstNumbersAndWhatIsNotFinite) {
  Results results = sample_results();
  for (PointRecord& point : results.points) point.metrics["error"] = 0.01;
  results.points[3].metrics["error"] = 0.25;
  results.points[4].metrics["acne"] = std::nan("");
  const std::string words = worst_numbers(results);
  EXPECT_EQ(words.find("Error at most 25\u202f%, Acne not finite, Peter Panning at most "), 0u) << words;
  EXPECT_EQ(worst_numbers(Results{}), "");
}

TEST(IndexPage, NamesTheBrokenBoundAndItsValue) {
  Results results = sample_results();
  results.bounds = {
      {.metric = "error", .max = 1, .join = "worst", .held = true, .found = 0.5, .point = 0, .points = 32},
      {.metric = "acne", .max = 0.005, .join = "worst", .found = 0.0083, .point = 3, .points = 32}};
  EXPECT_EQ(broken_in_words(results), "Acne is 0.83\u202f% where at most 0.5\u202f% is allowed, at " +
                                          report::settings_phrase(results.points[3], results.info.swept) +
                                          ", with a bias of 0 as set.");
  results.bounds[1].held = true;
  EXPECT_EQ(broken_in_words(results), "");
}

}  // namespace
}  // namespace noonmark
