// Formulas, and the evaluation of a law over the points of a sweep.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "compare/judge/formula.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

double value(const std::string& text, double x = 2) {
  return Formula(text).value([&](const std::string&) { return x; });
}

TEST(Formula, ReadsWhatItsHeaderNames) {
  EXPECT_EQ(value("1 + 2 * 3 ^ 2"), 19);
  EXPECT_DOUBLE_EQ(value("tan_deg(45) + sin_deg(30) + cos_deg(60)"), 2);
  EXPECT_DOUBLE_EQ(value("atan_deg(1)"), 45);
  EXPECT_DOUBLE_EQ(value("hypot(3, 4) + atan2(0, 1) + sin(0) + cos(0) + tan(0) + asin(0) + acos(1) + atan(0)"), 6);
  EXPECT_DOUBLE_EQ(value("sqrt(4) + exp(0) + ln(1) + log2(8) + log10(100) + abs(-1) + floor(1.5)"), 10);
  EXPECT_EQ(value("min(3, 1, 2) + max(0, x)"), 3);
  EXPECT_EQ(value("x > 1 && x <= 2 ? 5 : 6"), 5);
  EXPECT_DOUBLE_EQ(value("pi"), 3.14159265358979323846);
  EXPECT_EQ(Formula("map.resolution * a + a").names(), (std::vector<std::string>{"a", "map.resolution"}));
}

TEST(Formula, RefusesWhatItCannotRead) {
  for (const char* bad : {"", "1 +", "(1", "nothing(1)", "1, 2", "x = 3", "a b", "\"s\"", "atan2(1)", "max()", "1;2"})
    EXPECT_THROW(Formula{bad}, Error) << bad;
}

TEST(Formula, WhatHasNoValueIsNotANumber) {
  for (const char* text : {"min(1, x)", "max(x, 1)", "x > 1 ? 2 : 3", "0 * x", "x == x"})
    EXPECT_TRUE(std::isnan(value(text, not_a_number))) << text;
  EXPECT_TRUE(std::isnan(value("0 / 0")));
  EXPECT_EQ(value("1 / 0"), infinity);
}

TEST(Formula, CanBeMoved) {
  Formula a("x + 1");
  const Formula b = std::move(a);
  EXPECT_EQ(b.value([](const std::string&) { return 1; }), 2);
}

PointRecord point(int64_t id, int resolution, const std::string& filter, double error) {
  PointRecord p;
  p.id = id;
  p.settings = {{"map.resolution", std::to_string(resolution)},
                {"filter.kind", filter},
                {"light.position_m", "1,-2.5,3e2"},
                {"view.eye_m", "auto"},
                {"map.lit_beyond_far", "true"}};
  p.metrics = {{"error", error}, {"acne", 0.25}};
  return p;
}

Law law(const std::string& measured, const std::string& predicted, LawRelation relation = LawRelation::equal) {
  Law l;
  l.name = "l";
  l.measured = measured;
  l.predicted = predicted;
  l.relation = relation;
  return l;
}

LawResult judge(const Law& l, const std::vector<PointRecord>& points) {
  return evaluate_laws(points, {&l, 1}, [](const PointRecord& p) { return "render " + std::to_string(p.id); }).at(0);
}

TEST(Laws, ReadWhatFollowsAnAt) {
  PointRecord one = point(0, 64, "none", 0.5);
  one.metrics["error_worst"] = 0.75;
  Law with = law("error@worst + wide", "1.5");
  with.let = {{"wide", "error_worst"}};
  EXPECT_TRUE(judge(with, {one}).held);
  EXPECT_EQ(metric_names(with), (std::vector<std::string>{"error_worst", "error_worst"}));
  EXPECT_EQ(curve_names(law("window_min_m@worst", "0")), (std::vector<std::string>{"window_min_worst_m"}));
  EXPECT_THROW(check_law(law("error@wurst", "0")), Error);
}

TEST(Laws, NamesAreSettingsMetricsAndDefinitions) {
  const std::vector<PointRecord> points = {point(0, 512, "none", 0.5)};
  Law l = law("error * map.resolution + acne", "two * 128 + 0.25");
  l.let = {{"one", "map.lit_beyond_far"}, {"two", "one + 1"}};
  EXPECT_TRUE(judge(l, points).held);
  for (const auto& [axis, number] : {std::pair("x", 1.0), std::pair("y", -2.5), std::pair("z", 300.0)})
    EXPECT_EQ(judge(law(std::string("light.position_m.") + axis, "1"), points).samples.at(0).measured, number) << axis;
  // A setting that is `auto` has no number.
  EXPECT_FALSE(judge(law("view.eye_m.x", "1", LawRelation::at_least), points).held);
}

// Cascades count from 1, as the tables of the report count them.
TEST(Laws, ReadTheNumbersOfOneCascade) {
  PointRecord two = point(0, 512, "none", 0.5);
  two.cascades = {{0.5, 2, {{"texel_m", 0.25}}, 0.75}, {2, 8, {{"texel_m", 1}}, std::nullopt}};
  const auto value_of = [&](const std::string& formula) {
    return judge(law(formula, "0"), {two}).samples.at(0).measured;
  };
  EXPECT_EQ(value_of("cascades.1.begin_m"), 0.5);
  EXPECT_EQ(value_of("cascades.2.end_m / cascades.1.end_m"), 4);
  EXPECT_EQ(value_of("cascades.2.texel_m - cascades.1.texel_m"), 0.75);
  EXPECT_EQ(value_of("cascades.1.bias_needed"), 0.75);
  // Nothing is enough in the second one, and there is no third one.
  EXPECT_TRUE(std::isnan(value_of("cascades.2.bias_needed")));
  EXPECT_TRUE(std::isnan(value_of("cascades.3.texel_m")));
  EXPECT_FALSE(judge(law("cascades.3.texel_m", "0", LawRelation::at_least), {two}).held);
  EXPECT_EQ(curve_names(law("cascades.2.bias_needed + cascades.2.texel_m", "0")),
            std::vector<std::string>{"cascades.2.bias_needed"});
  for (const char* unknown :
       {"cascades.0.texel_m", "cascades.9.texel_m", "cascades.1.texels", "cascades.1", "cascades.x.lit"})
    EXPECT_THROW(check_law(law(unknown, "0")), Error) << unknown;
}

TEST(Laws, HoldWithinTheirTolerance) {
  const std::vector<PointRecord> points = {point(0, 512, "none", 0.95), point(1, 512, "none", 1.05)};
  const auto held = [&](LawRelation relation, const std::string& predicted, double within, const std::string& slack) {
    Law l = law("error", predicted, relation);
    l.within = within;
    l.slack = slack;
    return judge(l, points).held;
  };
  EXPECT_TRUE(held(LawRelation::equal, "1", 0.051, ""));
  EXPECT_FALSE(held(LawRelation::equal, "1", 0.049, ""));
  EXPECT_TRUE(held(LawRelation::equal, "1", 0, "0.051"));
  EXPECT_TRUE(held(LawRelation::equal, "1", 0.03, "acne / 10"));
  EXPECT_FALSE(held(LawRelation::at_most, "1", 0, ""));
  EXPECT_TRUE(held(LawRelation::at_most, "1.05", 0, ""));
  EXPECT_FALSE(held(LawRelation::at_least, "1", 0, ""));
  EXPECT_TRUE(held(LawRelation::at_least, "0.95", 0, ""));
  EXPECT_FALSE(held(LawRelation::at_least, "-1 * 2", 0, "-4"));  // a negative slack makes the limit stricter
}

TEST(Laws, NameTheSampleFurthestOff) {
  const LawResult result = judge(law("error", "1", LawRelation::at_most),
                                 {point(0, 1, "none", 1.1), point(1, 1, "none", 1.3), point(2, 1, "none", 1.2)});
  EXPECT_FALSE(result.held);
  EXPECT_EQ(result.worst, 1);
  EXPECT_EQ(result.reproduce, "render 1");
  EXPECT_EQ(ratio_text(result), "") << "a limit has no ratio";
  EXPECT_EQ(ratio_text(judge(law("error", "1"), {point(0, 1, "none", 1.1), point(1, 1, "none", 1.3)})),
            "1.100 .. 1.300");
}

TEST(Laws, WhatIsNotFiniteBreaksThem) {
  for (double bad : {not_a_number, infinity, -infinity})
    for (LawRelation relation : {LawRelation::equal, LawRelation::at_most, LawRelation::at_least}) {
      Law l = law("error", "1", relation);
      l.within = 1e9;
      const LawResult result = judge(l, {point(0, 1, "none", 1), point(1, 1, "none", bad), point(2, 1, "none", 1)});
      EXPECT_FALSE(result.held);
      EXPECT_EQ(result.worst, 1);
      std::swap(l.measured, l.predicted);
      EXPECT_FALSE(judge(l, {point(0, 1, "none", bad)}).held);
    }
  EXPECT_FALSE(judge(law("error", "1"), {}).held) << "a law without points must be broken";
}

TEST(Laws, AToleranceWithoutEndOrBelowZeroBreaksThem) {
  for (const char* slack : {"1 / 0", "0 / 0", "-1"}) {
    Law l = law("error", "1");
    l.slack = slack;
    EXPECT_FALSE(judge(l, {point(0, 1, "none", 1)}).held) << slack;
  }
}

TEST(Laws, WhereAndAgainstPairPoints) {
  std::vector<PointRecord> points;
  for (int resolution : {256, 512})
    for (const char* filter : {"none", "box"})
      points.push_back(point(static_cast<int64_t>(points.size()), resolution, filter,
                             filter == std::string("box") ? 1 : resolution));
  Law l = law("error", "error / map.resolution", LawRelation::equal);
  l.where = {{"filter.kind", {"box"}}};
  l.against = {{"filter.kind", {"none"}}};
  const LawResult result = judge(l, points);
  EXPECT_TRUE(result.held);
  EXPECT_EQ(result.samples.size(), 2u);
  points.erase(points.begin());  // the partner point no longer exists
  EXPECT_FALSE(judge(l, points).held);
}

TEST(Laws, MeansAndSlopes) {
  std::vector<PointRecord> points;
  for (int resolution : {128, 256, 512})
    for (double shift : {0.5, 1.5})
      points.push_back(point(static_cast<int64_t>(points.size()), resolution, "none", shift / resolution));
  Law mean = law("error * map.resolution", "1");
  EXPECT_FALSE(judge(mean, points).held);
  mean.join = "mean";
  EXPECT_TRUE(judge(mean, points).held);
  EXPECT_EQ(judge(mean, points).samples.size(), 1u);

  Law slope = law("error", "-1");
  slope.join = "slope";
  slope.over = "map.resolution";
  slope.within = 1e-12;  // tolerance for the logarithms of three exact powers
  EXPECT_TRUE(judge(slope, points).held);
  slope.predicted = "-1.1";
  EXPECT_FALSE(judge(slope, points).held);
  points.resize(2);  // one resolution has no slope
  EXPECT_FALSE(judge(slope, points).held);
}

TEST(Laws, SayWhatWasFoundWithItsFigures) {
  std::vector<PointRecord> points = {point(0, 512, "none", 0.5), point(1, 512, "box", 0.125)};
  points[1].metrics["map_ms"] = 2.5;
  Law l = law("error", "error", LawRelation::at_most);
  l.where = {{"filter.kind", {"box"}}};
  l.against = {{"filter.kind", {"none"}}};
  l.let = {{"percent", "100"}};
  l.found = "{percent * error} % with a filter, {against:percent * error} % without; {map_ms} ms.";
  EXPECT_EQ(law_text(judge(l, points)), "error <= error at filter.kind = none where filter.kind = box");
  EXPECT_EQ(judge(l, points).found, "12.5 % with a filter, 50 % without; 2.5 ms.");
  l.found = "no figures";
  EXPECT_EQ(judge(l, points).found, "no figures");
  l.found = "";
  EXPECT_EQ(judge(l, points).found, "");
  for (const char* bad : {"{error", "{}", "{none_such}", "{against: none_such}"}) {
    l.found = bad;
    EXPECT_THROW(check_law(l), Error) << bad;
  }
  l = law("error", "1");
  l.found = "{against: error}";
  EXPECT_THROW(check_law(l), Error) << "`against:` needs a law with `against`";
}

TEST(Laws, TheTableTellsLawPredictedMeasuredAndVerdict) {
  Law good = law("error", "1"), bad = law("acne", "0.5");
  good.name = "good law";
  bad.name = "bad law";
  const Law both[] = {good, bad};
  const std::vector<PointRecord> points = {point(7, 1, "none", 1)};
  const std::string table =
      law_table(evaluate_laws(points, both, [](const PointRecord&) { return std::string("noonmark render x"); }));
  for (const char* text : {"good law", "bad law", "0.5", "0.25", "holds", "BROKEN", "acne = 0.5", "point 7",
                           "off by -0.25", "noonmark render x"})
    EXPECT_NE(table.find(text), std::string::npos) << text << "\n" << table;
}

// A law that reads what the ambiguous receivers may change is not known to hold.
TEST(Laws, WhatIsAmbiguousIsNotKnown) {
  const auto result = [](const Law& asked, double ambiguous) {
    PointRecord one = point(0, 512, "none", 0);
    one.metrics["ambiguous"] = ambiguous;
    one.metrics["facing"] = 1e6;
    return evaluate_laws({&one, 1}, {&asked, 1}, [](const PointRecord&) { return ""; }).at(0);
  };
  Law measured = law("error", "0.5", LawRelation::at_most), predicted = law("0", "error"), defined = law("0", "e");
  defined.let = {{"e", "2 * error"}};
  measured.found = "the error is {error}";
  for (const Law& one : {measured, predicted, defined}) {
    EXPECT_TRUE(result(one, 0.0005).held);
    EXPECT_FALSE(result(one, 0.142).held) << one.measured;
  }
  EXPECT_TRUE(std::isnan(result(measured, 0.142).samples.at(0).measured));
  EXPECT_NE(result(measured, 0.142).found.find("error is not known, because the truth of 14.2%"), std::string::npos)
      << result(measured, 0.142).found;
  EXPECT_TRUE(result(law("map.resolution", "512"), 0.142).held) << "a setting is known";
  EXPECT_TRUE(result(law("facing", "1e6"), 0.142).held) << "a number that does not depend on the truth is known";
}

}  // namespace
}  // namespace noonmark
