// The report over many points: generated records, nothing is measured. Counted are candidates and bytes, not seconds,
// because seconds depend on the machine.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "compare/judge/recommendation.h"
#include "compare/report/findings.h"
#include "compare/report/report.h"
#include "compare/report/rules.h"
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

bool is_true(const Condition& c, const PointRecord& point) {
  const std::string value = rule_value(point, c.setting);
  return c.is == Condition::Is::equal     ? value == c.value
         : c.is == Condition::Is::at_most ? *number_of(value) <= *number_of(c.value)
                                          : *number_of(value) >= *number_of(c.value);
}
bool is_true(const Rule& rule, const PointRecord& point) {
  return std::all_of(rule.all.begin(), rule.all.end(), [&](const Condition& c) { return is_true(c, point); });
}
std::string text_of(const std::vector<Rule>& rules) {
  std::string text;
  for (const Rule& rule : rules) {
    for (const Condition& c : rule.all) text += fmt::format("{} {} {}, ", c.setting, static_cast<int>(c.is), c.value);
    text += fmt::format("{}\n", rule.points);
  }
  return text;
}

// Every rule of at most three conditions is written down and compared with every point. Only for small sweeps.
std::vector<Rule> rules_by_trying_all(const Results& results, const std::vector<bool>& chosen,
                                      const std::vector<bool>& allowed) {
  std::vector<std::string> axes = results.info.swept;
  axes.emplace_back(texel_size);
  std::vector<std::pair<size_t, Condition>> singles;
  for (size_t axis = 0; axis < axes.size(); ++axis) {
    const std::vector<std::string> values = values_of(results, axes[axis]);
    const bool derived = axes[axis] == texel_size;
    if (values.size() < 2) continue;
    for (const std::string& value : values)
      if (!derived) singles.push_back({axis, {Condition::Is::equal, axes[axis], value}});
    for (size_t i = 0; number_of(values[0]) && i < values.size(); ++i) {
      const bool first = i == 0, last = i + 1 == values.size();
      if (!last && (!first || derived)) singles.push_back({axis, {Condition::Is::at_most, axes[axis], values[i]}});
      if (!first && (!last || derived)) singles.push_back({axis, {Condition::Is::at_least, axes[axis], values[i]}});
    }
  }
  std::vector<std::vector<size_t>> open{{}}, found;
  for (int length = 1; length <= 3; ++length) {
    std::vector<std::vector<size_t>> next;
    for (const std::vector<size_t>& rule : open)
      for (size_t i = 0; i < singles.size(); ++i) {
        if (!rule.empty() && singles[i].first <= singles[rule.back()].first) continue;
        std::vector<size_t> grown = rule;
        grown.push_back(i);
        bool only_allowed = true;
        for (size_t p = 0; p < chosen.size() && only_allowed; ++p)
          only_allowed = allowed[p] || !std::all_of(grown.begin(), grown.end(), [&](size_t s) {
                           return is_true(singles[s].second, results.points[p]);
                         });
        (only_allowed ? found : next).push_back(grown);
      }
    open = std::move(next);
  }
  std::vector<bool> left = chosen;
  std::vector<Rule> out;
  while (true) {
    Rule best;
    size_t best_count = 0;
    for (const std::vector<size_t>& one : found) {
      Rule rule;
      for (size_t s : one) rule.all.push_back(singles[s].second);
      size_t covered = 0;
      for (size_t p = 0; p < chosen.size(); ++p) {
        if (!is_true(rule, results.points[p])) continue;
        covered += left[p];
        rule.points += chosen[p];
      }
      if (covered > best_count) best = rule, best_count = covered;
    }
    if (best_count == 0) return out;
    for (size_t p = 0; p < chosen.size(); ++p)
      if (is_true(best, results.points[p])) left[p] = false;
    out.push_back(best);
  }
}

TEST(DescribeManyPoints, GivesTheRulesThatTryingAllGives) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 25; ++trial) {
    const auto upto = [&](unsigned most) { return static_cast<int>(1 + random() % most); };
    const Results results = grid(upto(4), upto(4), upto(3));
    std::vector<bool> chosen, either_way, allowed;
    const unsigned share = 2 + static_cast<unsigned>(random() % 4);
    const double limit = 0.02 + 0.01 * static_cast<double>(random() % 8);
    for (const PointRecord& point : results.points) {
      // Points above a size of texel, and some at random.
      const bool coarse = *number_of(rule_value(point, std::string(texel_size))) > limit;
      chosen.push_back(coarse != (random() % (4 * share) == 0));
      either_way.push_back(random() % share == 0);
      allowed.push_back(chosen.back() || either_way.back());
    }
    EXPECT_EQ(text_of(describe_points(results, chosen, either_way)),
              text_of(rules_by_trying_all(results, chosen, allowed)))
        << "trial " << trial;
  }
}

TEST(DescribeManyPoints, TriesNoMoreCandidatesForMorePoints) {
  std::mt19937 random(5);
  for (const int extents : {10, 100, 300}) {
    Results results = grid(10, extents, 10);
    std::vector<bool> chosen;  // no rule describes many of these, so that hardly any candidate can be passed over
    for (size_t i = 0; i < results.points.size(); ++i) chosen.push_back(random() % 2 == 0);
    RuleSearch search{.most_rules = 5};
    const size_t rules = describe_points(results, chosen, {}, &search).size();
    EXPECT_LE(rules, 5u);
    // Rules of one, two and three conditions are tried in turn, and each turn passes the shorter ones again.
    EXPECT_LE(search.tried, 3 * max_rule_candidates * (rules + 1)) << results.points.size() << " points";
    EXPECT_GT(search.tried, 1000u);
  }
}

TEST(DescribeManyPoints, FindsALimitBetweenTheTriedOnes) {
  const Results results = grid(3, 300, 2);
  for (const double limit_m : {4.25, 11.75, 33.5, 78.5}) {
    for (const bool above : {false, true}) {
      std::vector<bool> chosen;
      for (const PointRecord& point : results.points) {
        const double extent_m = *number_of(setting_of(point, "map.extent_m"));
        chosen.push_back(above ? extent_m >= limit_m : extent_m <= limit_m);
      }
      const std::vector<Rule> rules = describe_points(results, chosen);
      ASSERT_EQ(rules.size(), 1u);
      ASSERT_EQ(rules[0].all.size(), 1u);
      EXPECT_EQ(rules[0].all[0].setting, "map.extent_m");
      EXPECT_EQ(rules[0].all[0].is, above ? Condition::Is::at_least : Condition::Is::at_most);
      EXPECT_EQ(*number_of(rules[0].all[0].value), limit_m);
    }
  }
}

TEST(DescribeManyPoints, NeverSaysARuleOfAPointThatWasNotChosen) {
  const Results results = grid(4, 100, 3);
  std::mt19937 random(9);
  for (const unsigned one_in : {2u, 9u, 200u}) {
    std::vector<bool> chosen, either_way;
    for (size_t i = 0; i < results.points.size(); ++i) {
      chosen.push_back((i / 40) % 3 == 0 || random() % one_in == 0);
      either_way.push_back(!chosen.back() && random() % 10 == 0);
    }
    RuleSearch search{.most_rules = 6};
    for (const Rule& rule : describe_points(results, chosen, either_way, &search)) {
      size_t points = 0, others = 0;
      for (size_t i = 0; i < chosen.size(); ++i) {
        if (!is_true(rule, results.points[i])) {
          ++others;
          continue;
        }
        EXPECT_TRUE(chosen[i] || either_way[i]) << "point " << i;
        points += chosen[i];
      }
      EXPECT_EQ(points, rule.points);
      EXPECT_GT(others, 0u) << "a rule that is always true says nothing";
    }
  }
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
  for (const Recommendation& found : {recommend(results), recommend_accurate(results)})
    if (found.outcome == Recommendation::Outcome::found) {
      EXPECT_TRUE(std::any_of(shown.results.points.begin(), shown.results.points.end(),
                              [&](const PointRecord& point) { return point.id == found.choice.first().id; }));
    }
}

}  // namespace
}  // namespace noonmark
