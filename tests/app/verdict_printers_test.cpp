// Every printer says the one verdict, with its one sentence, whatever is wrong at once.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sweep/judging.h"
#include "app/sweep/results_json.h"
#include "compare/judge/bounds.h"
#include "compare/report/annotations.h"
#include "compare/report/element.h"
#include "compare/report/escape.h"
#include "compare/report/index_page.h"
#include "compare/report/junit.h"
#include "compare/report/report.h"
#include "compare/report/summary.h"
#include "compare/results/quantities.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

struct Situation {
  const char* name;
  Verdict verdict;
  std::function<void(Results&)> make;
};

Results plain() {
  Results results = sample_results();
  results.info.experiment = "x.toml";
  results.bounds.clear();
  results.laws.clear();
  results.planned_points = static_cast<int64_t>(results.points.size());
  for (PointRecord& point : results.points) point.settings["bias.constant"] = "0.005";
  return results;
}
void add_bound(Results& results, bool held, bool warns = false) {
  BoundResult one;
  one.metric = "acne", one.max = 0.01, one.join = "worst", one.point = 3, one.points = 32;
  one.held = held, one.warns = warns, one.found = held ? 0.001 : 0.02;
  results.bounds.push_back(one);
}
void add_law(Results& results, bool held) {
  LawResult one;
  one.name = "a law", one.measured = "acne", one.predicted = "0.1", one.join = "each", one.held = held, one.worst = 0;
  one.samples = {{3, 0.1, held ? 0.1 : 0.3, 0.01}};
  results.laws.push_back(one);
}
void add_baseline(Results& results, bool held) {
  results.baseline.emplace();
  results.baseline->compared = 2;
  if (!held) results.baseline->worse = {"worse: acne at point 3"};
}
void refused(Results& results) {
  results.points.resize(3);
  results.planned_points = 3;
  for (PointRecord& frame : results.points) {
    frame.curve.reset();
    frame.metrics = {{"frame_error", 0.02}, {"frame_acne", 0.02}};
    frame.causes = {{"frame_acne", "Acne", "", {1, 2, 3}, std::string(frame_rung)}};
    frame.settings["given.frame"] = fmt::format("f{}.toml", frame.id);
  }
  results.points[1].delivery.refused = "inverted: 0 is lit";
}
void unsound(Results& results) { results.points[1].metrics["contract"] = 1; }

const std::vector<Situation>& situations() {
  static const std::vector<Situation> all = {
      {"nothing is promised", Verdict::measured, [](Results&) {}},
      {"a bound holds", Verdict::held, [](Results& r) { add_bound(r, true); }},
      {"a bound warns", Verdict::held, [](Results& r) { add_bound(r, false, true); }},
      {"a law holds", Verdict::held, [](Results& r) { add_law(r, true); }},
      {"no worse, and nothing is promised", Verdict::held, [](Results& r) { add_baseline(r, true); }},
      {"a bound is broken, another holds", Verdict::broken,
       [](Results& r) { add_bound(r, true), add_bound(r, false); }},
      {"a law is broken, the bound holds", Verdict::broken, [](Results& r) { add_bound(r, true), add_law(r, false); }},
      {"broken, and no worse", Verdict::broken, [](Results& r) { add_bound(r, false), add_baseline(r, true); }},
      {"worse, and all bounds hold", Verdict::worse, [](Results& r) { add_bound(r, true), add_baseline(r, false); }},
      {"worse and broken", Verdict::worse, [](Results& r) { add_bound(r, false), add_baseline(r, false); }},
      {"refused, and the others hold", Verdict::refused, [](Results& r) { refused(r), add_bound(r, true); }},
      {"refused, broken and worse", Verdict::refused,
       [](Results& r) { refused(r), add_bound(r, false), add_baseline(r, false); }},
      {"incomplete, and what is there holds", Verdict::incomplete,
       [](Results& r) { add_bound(r, true), r.planned_points = 40; }},
      {"stopped and broken", Verdict::incomplete, [](Results& r) { add_bound(r, false), r.stopped = true; }},
      {"incomplete and refused", Verdict::incomplete, [](Results& r) { refused(r), r.stopped = true; }},
      {"unsound, and all bounds hold", Verdict::unsound, [](Results& r) { add_bound(r, true), unsound(r); }},
      {"unsound, incomplete, worse and broken", Verdict::unsound,
       [](Results& r) { add_bound(r, false), add_baseline(r, false), r.stopped = true, unsound(r); }},
  };
  return all;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from), begin = at + from.size();
  return at == text.npos ? "'" + from + "' is missing" : text.substr(begin, text.find(to, begin) - begin);
}

// What each printer says: the verdict's word and its sentence, as it writes texts; an empty word where it says none.
struct Said {
  std::string word, sentence, wanted_sentence;
};
std::map<std::string, Said> said_of(const Results& results) {
  const Findings found(results);
  std::map<std::string, Said> said;
  const std::string page = render_report(results, sample_picture), junit = to_junit(found);
  const std::string pill = between(page, "<p class=\"verdict\"><span class=\"pill ", "</span>");
  said["page"] = {"", pill.substr(pill.find('>') + 1), report::Markup(found.sentence).html()};
  said["summary"] = {"", between(to_summary(found), "**", ".**"), markdown(found.sentence)};
  said["junit"] = {between(junit, "name=\"verdict\" value=\"", "\""),
                   between(junit, "name=\"verdict_text\" value=\"", "\""), xml_text(found.sentence)};
  SweepOutcome outcome;
  outcome.results = results;
  const nlohmann::ordered_json json = results_json(outcome, found, {"x.toml", "out", exit_code_of(found.verdict)});
  EXPECT_EQ(json["exit_code"], exit_code_of(found.verdict));
  said["json"] = {json["verdict"], json["verdict_text"], found.sentence};
  said["terminal"] = {
      "", between(verdict_line(found, "x.toml", "1 point measured", "out"), "x.toml: ", "; 1 point measured"),
      found.sentence};
  IndexEntry entry;
  entry.verdict = found.verdict;
  said["index"] = {between(index_page({entry}, "0"), passes(found.verdict) ? "<td>✓ " : "<td>✗ ", "</td>"), "", ""};
  if (!passes(found.verdict)) {
    const std::string first = to_annotations("x.toml", found);
    said["annotations"] = {between(first, "::error file=x.toml,title=", "::"),
                           between(first, "::error file=x.toml,title=", "\n"),
                           std::string(word_of(found.verdict)) + "::" + found.sentence};
  }
  return said;
}

TEST(Verdict, EveryPrinterSaysTheOneVerdict) {
  for (const Situation& one : situations()) {
    Results results = plain();
    one.make(results);
    const Findings found(results);
    EXPECT_EQ(found.verdict, one.verdict) << one.name << ": " << found.sentence;
    std::string first = found.sentence.substr(0, word_of(one.verdict).size());
    first.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(first.front())));
    EXPECT_EQ(first, word_of(one.verdict)) << one.name;
    for (const auto& [printer, said] : said_of(results)) {
      EXPECT_EQ(said.word, said.word.empty() ? "" : word_of(one.verdict)) << one.name << ", " << printer;
      EXPECT_EQ(said.sentence, said.wanted_sentence) << one.name << ", " << printer;
    }
  }
}

// A server counts what JUnit says, GitHub what the annotations say, and the colour of the page is its own word.
TEST(Verdict, NoPrinterIsGreenWhereTheVerdictDoesNotPass) {
  for (const Situation& one : situations()) {
    Results results = plain();
    one.make(results);
    const Findings found(results);
    const bool passes_it = passes(one.verdict);
    const std::string junit = to_junit(found), page = render_report(results, sample_picture),
                      annotations = to_annotations("x.toml", found);
    EXPECT_EQ(junit.find("<failure ") == junit.npos && junit.find("<error ") == junit.npos, passes_it) << one.name;
    EXPECT_EQ(annotations.find("::error ") == annotations.npos, passes_it) << one.name << "\n" << annotations;
    EXPECT_EQ(page.find("pill broken") == page.npos, passes_it) << one.name;
    EXPECT_EQ(page.find("pill held") != page.npos, one.verdict == Verdict::held) << one.name;
    EXPECT_TRUE(passes_it || page.find("recommend held") == page.npos) << one.name;
  }
}

}  // namespace
}  // namespace noonmark
