// Times are measured if the key `times` says so, or if a plot, a bound, an answer or a law names a time.
#include <gtest/gtest.h>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

Experiment parse_times(const std::string& toml) { return parse_experiment(toml, "x.toml"); }

TEST(ExperimentTimes, AreNotMeasuredIfNothingAsks) {
  const Experiment experiment = parse_times("[plot]\nmetrics = [\"error\"]\n[[bound]]\nmetric = \"acne\"\nmax = 1");
  EXPECT_EQ(time_asked_for(experiment), "");
  EXPECT_FALSE(times_measured(experiment));
}

TEST(ExperimentTimes, AreAskedForByEachPlaceThatNamesAMetric) {
  const char* const law = "[[law]]\nname = \"a\"\nequals = \"0\"\n";
  for (const std::string& text :
       {std::string("[plot]\nmetrics = [\"error\", \"map_ms\"]"), std::string("[answer]\ncost = \"map_ms\""),
        std::string("[answer]\naccuracy = \"map_ms\""), std::string("[[bound]]\nmetric = \"map_ms\"\nmax = 1"),
        law + std::string("measured = \"2 * map_ms\""), law + std::string("measured = \"0\"\nslack = \"map_ms\""),
        law + std::string("measured = \"0\"\nfound = \"It takes {map_ms} ms.\""),
        "[let]\nt = \"map_ms + 1\"\n" + (law + std::string("measured = \"t\"")),
        std::string("[[part]]\nname = \"p\"\n[[part.bound]]\nmetric = \"map_ms\"\nmax = 1")}) {
    const Experiment experiment = parse_times(text);
    EXPECT_EQ(time_asked_for(experiment), "map_ms") << text;
    EXPECT_TRUE(times_measured(experiment)) << text;
  }
}

TEST(ExperimentTimes, FollowTheKey) {
  EXPECT_TRUE(times_measured(parse_times("times = true")));
  EXPECT_FALSE(times_measured(parse_times("times = false")));
  EXPECT_NE(fingerprint(parse_times("times = true"), {}), fingerprint(parse_times(""), {}))
      << "the points have other metrics";
  EXPECT_EQ(fingerprint(parse_times("times = false"), {}), fingerprint(parse_times(""), {}));
}

TEST(ExperimentTimes, CannotBeAskedForAndOff) {
  expect_refused(ErrorKind::usage, {"x.toml:1:9: times = false, but the experiment asks for shadow_ms"},
                 [] { parse_times("times = false\n[plot]\nmetrics = [\"shadow_ms\"]"); });
}

}  // namespace
}  // namespace noonmark
