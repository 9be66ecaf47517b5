// What a bound found in the run before, and which changes of times are noise.
#include "compare/judge/last_run.h"

#include <gtest/gtest.h>

#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

BoundResult found(const std::string& metric, double value) {
  BoundResult bound;
  bound.metric = metric;
  bound.max = 1;
  bound.join = "worst";
  bound.found = value;
  bound.point = 0;
  bound.points = 1;
  return bound;
}

TEST(LastRun, NamesWhatChanged) {
  Results results;
  results.points = {sample_point(0)};
  results.bounds = {found("acne", 0.003), found("peter_panning", 0.001), found("aliasing", 0.02)};
  add_last_run(results.bounds, {found("peter_panning", 0.001), found("acne", 0.001)});
  EXPECT_EQ(last_run_text(results), "since the last run: acne 0.1% -> 0.3%; 1 value as before");
  EXPECT_EQ(since_last_run(results.bounds[0], results), "0.1% before");
  EXPECT_EQ(since_last_run(results.bounds[1], results), "as before");
  EXPECT_EQ(since_last_run(results.bounds[2], results), "") << "the run before did not have it";
  results.bounds[2].before.reset();
  add_last_run(results.bounds, {});
  Results fresh;
  fresh.bounds = {found("acne", 0.003)};
  EXPECT_EQ(last_run_text(fresh), "");
}

TEST(LastRun, ABoundOfOtherPointsIsAnotherOne) {
  BoundResult other = found("acne", 0.001);
  other.where = {{"map.resolution", {"512"}}};
  std::vector<BoundResult> now = {found("acne", 0.003)};
  add_last_run(now, {other});
  EXPECT_FALSE(now[0].before);
  other.where.clear();
  other.max = 0.5;  // another limit, the same value
  add_last_run(now, {other});
  EXPECT_EQ(now[0].before, 0.001);
}

TEST(LastRun, ATimeChangesOnlyBeyondItsNoise) {
  Results results;
  results.points = {sample_point(0)};
  results.points[0].metrics["map_low_ms"] = 0.5;
  results.points[0].metrics["map_high_ms"] = 0.7;
  results.bounds = {found("map_ms", 0.6)};
  add_last_run(results.bounds, {found("map_ms", 0.52)});
  EXPECT_EQ(last_run_text(results), "since the last run: 1 value as before");
  EXPECT_NE(since_last_run(results.bounds[0], results).find("within the noise (0.5 to 0.7 ms)"), std::string::npos)
      << since_last_run(results.bounds[0], results);
  add_last_run(results.bounds, {found("map_ms", 0.4)});
  EXPECT_NE(last_run_text(results).find("map_ms 0.4"), std::string::npos) << last_run_text(results);
  EXPECT_NE(since_last_run(results.bounds[0], results).find("beyond the noise"), std::string::npos);
}

TEST(LastRun, NothingIsAsBeforeWhereTheAmbiguousMayHaveChangedIt) {
  Results results;
  results.points = {sample_point(0)};
  results.points[0].metrics["ambiguous"] = 0.142;
  results.points[0].metrics["facing"] = 1e6;
  results.bounds = {found("acne", 0)};
  for (const double before : {0.0, 0.01}) {
    add_last_run(results.bounds, {found("acne", before)});
    EXPECT_NE(last_run_text(results).find("-> 0% ± 14.2%"), std::string::npos) << last_run_text(results);
    EXPECT_EQ(since_last_run(results.bounds[0], results).find("as before"), std::string::npos);
  }
}

}  // namespace
}  // namespace noonmark
