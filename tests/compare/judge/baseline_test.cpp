// What a baseline keeps of a point, and when a later value is worse than it.
#include "compare/judge/baseline.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "base/error.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

constexpr int usage = static_cast<int>(ErrorKind::usage);

Bound limit(const std::string& metric, std::optional<double> max, std::optional<double> min) {
  Bound bound;
  bound.metric = metric;
  bound.max = max;
  bound.min = min;
  return bound;
}

// One point with this acne, under a bound that says which side is better.
Baseline one(double acne, const Bound& bound = limit("acne", 1, {}), const std::string& scene = "") {
  PointRecord point = sample_point(0);
  point.metrics["acne"] = acne;
  return {"a renderer", {baseline_point(point, {&bound, 1}, {}, false, scene)}};
}

BaselineComparison compared(const Baseline& before, const Baseline& now) {
  return compare_with_baseline(parse_baseline(baseline_text(before), "file"), now, "file", {});
}

TEST(Baseline, TheBoundSaysWhichSideIsWorse) {
  const Bound max = limit("acne", 1, {}), min = limit("acne", {}, 0), both = limit("acne", 1, 0);
  EXPECT_FALSE(compared(one(0.1, max), one(0.2, max)).held());
  EXPECT_EQ(compared(one(0.2, max), one(0.1, max)).better.size(), 1u);
  EXPECT_FALSE(compared(one(0.2, min), one(0.1, min)).held());
  EXPECT_EQ(compared(one(0.1, min), one(0.2, min)).better.size(), 1u);
  for (const double now : {0.1, 0.3}) EXPECT_FALSE(compared(one(0.2, both), one(now, both)).held()) << now;
  EXPECT_TRUE(compared(one(0.2, both), one(0.2, both)).held());
}

TEST(Baseline, AValueThatWasPlottedOnlyHasNoBetterSide) {
  const std::vector<std::string> plot = {"acne"};
  PointRecord point = sample_point(0);
  const Baseline before{"r", {baseline_point(point, {}, plot, false, "")}};
  point.metrics["acne"] /= 2;
  const Baseline now{"r", {baseline_point(point, {}, plot, false, "")}};
  const BaselineComparison found = compared(before, now);
  ASSERT_EQ(found.worse.size(), 1u);
  EXPECT_NE(found.worse[0].find("no bound says which side is better"), std::string::npos) << found.worse[0];
}

// The rounding of the file alone is no change; two units of its last digit are one.
RC_GTEST_PROP(Baseline, ComparesToTheLastDigitOfTheFile, ()) {
  const double value =
      static_cast<double>(*rc::gen::inRange(100000000, 999999999)) * 1e-9 * std::pow(10.0, *rc::gen::inRange(-12, 12));
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - (baseline_digits - 1));
  const BaselineComparison same = compared(one(value), one(value));
  RC_ASSERT(same.held() && same.better.empty() && same.compared == 1);
  RC_ASSERT(compared(one(value), one(value + 0.4 * unit)).held());
  RC_ASSERT(!compared(one(value), one(value + 2 * unit)).held());
}

TEST(Baseline, AValueThatIsNoLongerMeasuredIsWorse) {
  EXPECT_FALSE(compared(one(0.1), one(nan_value)).held());
  EXPECT_EQ(compared(one(nan_value), one(0.1)).better.size(), 1u);
  EXPECT_TRUE(compared(one(nan_value), one(nan_value)).held());
  EXPECT_FALSE(compared(one(0), one(1e-30)).held()) << "from 0 every change is one";
}

TEST(Baseline, TheSameResultsGiveTheSameText) {
  const std::string text = baseline_text(one(1.0 / 3));
  EXPECT_EQ(text, baseline_text(parse_baseline(text, "file")));
  EXPECT_NE(text.find("\"acne\": 0.33333333\n"), std::string::npos) << text;
}

TEST(Baseline, NamesASceneWithoutItsFolder) {
  PointRecord point = sample_point(0);
  point.settings["scene.name"] = "/home/someone/street.glb";
  const Bound bound = limit("acne", 1, {});
  const std::string text = baseline_text({"r", {baseline_point(point, {&bound, 1}, {}, false, "digest")}});
  EXPECT_EQ(text.find("someone"), std::string::npos) << text;
  EXPECT_NE(text.find("\"scene.name\": \"street.glb\""), std::string::npos) << text;
}

TEST(Baseline, AChangedModelIsComparedAndSaid) {
  const Bound bound = limit("acne", 1, {});
  const BaselineComparison found = compared(one(0.1, bound, "a"), one(0.2, bound, "b"));
  EXPECT_EQ(found.worse.size(), 1u);
  ASSERT_EQ(found.changed.size(), 1u);
  EXPECT_NE(found.changed[0].find("has other contents"), std::string::npos) << found.changed[0];
}

// Points are named by their part and what is swept, so a fixed setting may change.
TEST(Baseline, AChangedSettingIsComparedAndSaid) {
  const Bound bound = limit("acne", 1, {});
  const auto of = [&](const char* bias, const char* wrap_of_second) {
    Baseline baseline{"r", {}};
    for (const int64_t id : {0, 1}) {
      PointRecord point = sample_point(id);  // they differ in map.resolution
      point.settings["bias.constant"] = bias;
      if (id == 1) point.settings["map.wrap"] = wrap_of_second;
      baseline.points.push_back(baseline_point(point, {&bound, 1}, {}, false, ""));
    }
    return baseline;
  };
  const std::string wrap = sample_point(1).settings.at("map.wrap");
  const BaselineComparison found = compared(of("2", wrap.c_str()), of("3", wrap.c_str()));
  EXPECT_TRUE(found.held());
  EXPECT_EQ(found.compared, 2u);
  EXPECT_EQ(found.changed, std::vector<std::string>{"changed: bias.constant is 3, in the baseline 2"});
  EXPECT_TRUE(compared(of("2", wrap.c_str()), of("2", wrap.c_str())).changed.empty());
}

TEST(Baseline, AMissingPointIsWorseAndNamesWhatDiffers) {
  const Bound bound = limit("acne", 1, {});
  const auto of = [&](std::initializer_list<int64_t> ids) {
    Baseline baseline{"r", {}};
    for (const int64_t id : ids)
      baseline.points.push_back(baseline_point(sample_point(id), {&bound, 1}, {}, false, ""));
    return baseline;
  };
  const BaselineComparison found = compared(of({0, 1}), of({0, 2}));
  ASSERT_EQ(found.worse.size(), 1u);
  EXPECT_NE(found.worse[0].find("map.resolution = 512 is in the baseline, but was not measured"), std::string::npos)
      << found.worse[0];
  EXPECT_EQ(found.notes.size(), 1u) << "the new point";
  EXPECT_EQ(kind_thrown([&] { compared(of({0, 1}), of({2, 3})); }), usage) << "no point is in both";
}

TEST(Baseline, ASettingThatTheFileDoesNotKnowHasItsDefaultThere) {
  Baseline before = one(0.1);
  before.points[0].settings.erase("map.wrap");
  EXPECT_TRUE(compared(before, one(0.1)).held());
  EXPECT_TRUE(compared(before, one(0.1)).changed.empty());
}

TEST(Baseline, TimesAreComparedOnlyIfAskedFor) {
  const Bound bound = limit("map_ms", 100, {});
  const auto of = [&](double time, bool times) {
    PointRecord point = sample_point(0);
    point.metrics["map_ms"] = time;
    return Baseline{"r", {baseline_point(point, {&bound, 1}, {}, times, "")}};
  };
  EXPECT_TRUE(of(1, false).points[0].values.empty());
  EXPECT_EQ(compare_with_baseline(of(1, true), of(2, true), "file", {}).compared, 0u);
  EXPECT_TRUE(compare_with_baseline(of(1, true), of(1.2, true), "file", 0.25).held());
  EXPECT_FALSE(compare_with_baseline(of(1, true), of(1.3, true), "file", 0.25).held());
}

TEST(Baseline, OtherTextIsRefused) {
  for (const char* text :
       {"", "{}", "[1]", R"({"format": 2, "opengl": "", "settings": {}, "points": []})",
        R"({"format": 1, "opengl": "", "settings": {}, "points": [{"settings": {}, "values": {"acne": "x"}}]})"})
    EXPECT_EQ(kind_thrown([&] { parse_baseline(text, "file"); }), usage) << text;
}

TEST(Baseline, StandsInJUnitAndInTheSummary) {
  BaselineComparison found = compared(one(0.1), one(0.2));
  Results results;
  results.baseline = found;
  EXPECT_NE(to_junit(results).find("tests=\"1\" failures=\"1\""), std::string::npos);
  EXPECT_NE(to_summary(results).find("**Worse.**"), std::string::npos);
  results.baseline->worse.clear();
  EXPECT_NE(to_junit(results).find("tests=\"1\" failures=\"0\""), std::string::npos);
  results.baseline.reset();
  EXPECT_EQ(to_summary(results).find("Baseline"), std::string::npos);
}

// What is left out may have become wrong: a value that becomes ambiguous is neither better nor as before.
TEST(Baseline, AValueThatBecomesAmbiguousIsWorse) {
  const auto with = [](double acne, double ambiguous, const Bound& bound = limit("acne", 1, {})) {
    PointRecord point = sample_point(0);
    point.metrics["acne"] = acne;
    point.metrics["ambiguous"] = ambiguous;
    point.metrics["facing"] = 1e6;
    return Baseline{"r", {baseline_point(point, {&bound, 1}, {}, false, "")}};
  };
  for (const double before : {0.0, 0.02}) {
    const BaselineComparison found = compared(with(before, 0), with(0, 0.142));
    ASSERT_EQ(found.worse.size(), 1u) << before;
    EXPECT_TRUE(found.better.empty());
    EXPECT_NE(found.worse[0].find("0% ± 14.2% now"), std::string::npos) << found.worse[0];
  }
  EXPECT_FALSE(compared(with(0.5, 0, limit("acne", {}, 0)), with(0.5, 0.1, limit("acne", {}, 0))).held());
  EXPECT_TRUE(compared(with(0, 0.142), with(0, 0.142)).held()) << "as before";
  EXPECT_FALSE(compared(with(0, 0.142), with(0.01, 0.142)).held()) << "what is counted became worse";
  EXPECT_EQ(compared(with(0, 0.142), with(0.02, 0)).better.size(), 1u) << "it is known to be less than it could be";
  EXPECT_TRUE(compared(with(0.02, 0), with(0.02, 0.0009)).held()) << "as few as in any scene";
}

}  // namespace
}  // namespace noonmark
