// Progress counts the whole of a run: its remaining time is that of everything that is still to do.
#include "base/progress.h"

#include <gtest/gtest.h>

#include "app/definition/experiment_file.h"
#include "app/sweep/sweep_progress.h"

namespace noonmark {
namespace {

class ProgressOfWork : public testing::Test {
 protected:
  // A step that takes so long.
  void step(Progress::Work work, double seconds) {
    clock += seconds;
    progress.finished(work, "a step");
  }
  double clock = 100;
  Progress progress{true, [this] { return clock; }, false};
};

TEST_F(ProgressOfWork, WhatHasNotBegunIsInTheRemainingTime) {
  // What a run with a phase diagram is: the expected seconds have the right proportions, of a machine twice as fast.
  const Progress::Work rows = progress.add(25, 1.25), points = progress.add(16, 1.0), rounds = progress.add(9, 0.5),
                       report = progress.add(1, 5.0);
  EXPECT_EQ(progress.done_share(), 0);
  double whole = 25 * 2.5 + 16 * 2.0 + 9 * 1.0 + 10, done = 0, share = 0;
  const auto expect_right = [&](double seconds) {
    done += seconds;
    EXPECT_NEAR(progress.left_s(), whole - done, 1e-9);
    EXPECT_GT(progress.done_share(), share);
    share = progress.done_share();
  };
  for (int i = 0; i < 25; ++i) step(rows, 2.5), expect_right(2.5);
  for (int i = 0; i < 16; ++i) step(points, 2.0), expect_right(2.0);
  for (int i = 0; i < 9; ++i) step(rounds, 1.0), expect_right(1.0);
  EXPECT_NEAR(progress.left_s(), 10, 1e-9) << "the report is still to be written";
  step(report, 10);
  EXPECT_EQ(progress.left_s(), 0);
  EXPECT_EQ(progress.done_share(), 1);
}

TEST_F(ProgressOfWork, AWorkThatTakesLongerThanExpectedCorrectsItselfAlone) {
  const Progress::Work rows = progress.add(10, 1.0), points = progress.add(10, 1.0);
  step(points, 1);
  step(rows, 7);
  EXPECT_NEAR(progress.left_s(), 9 * 1 + 9 * 7, 1e-9);
  // Steps of other sizes, in proportion.
  const Progress::Work uneven = progress.add({1.0, 3.0, 6.0});
  const double others =
      progress.left_s() - 10 * 4;  // as much slower as the others were: 8 s for what was expected as 2
  step(uneven, 2);
  EXPECT_NEAR(progress.left_s(), others + 2 * (3 + 6), 1e-9);
}

TEST_F(ProgressOfWork, WhatIsLeftOfAWorkCanBecomeKnown) {
  const Progress::Work pictures = progress.add(2, 3.0);
  step(pictures, 3);
  progress.set_left(pictures, 5);
  EXPECT_NEAR(progress.left_s(), 15, 1e-9);
  progress.set_left(pictures, 0);
  EXPECT_EQ(progress.left_s(), 0);
  const Progress::Work more = progress.add(1, 1.0);
  step(more, 1);
  step(more, 1);  // more steps than expected
  EXPECT_EQ(progress.left_s(), 0);
}

// All of a sweep is work: nothing that takes long begins when the remaining time says 0.
TEST(ProgressOfASweep, CountsDiagramPointsTimesPicturesAndReport) {
  const Experiment experiment = parse_experiment(
      "scene = \"cube-room\"\npictures = \"worst\"\ntimes = true\n[view]\nwidth_px = 640\nheight_px = 360\n"
      "[sweep]\nmap.resolution = [512, 1024]\n[phase]\n",
      "x.toml");
  const std::vector<Settings> planned = points(experiment);
  const std::vector<PhasePlan> plans = phase_plans(experiment, planned);
  ASSERT_EQ(plans.size(), 1u);
  const auto left_with = [&](const SweepProgress::Ahead& ahead) {
    return SweepProgress(experiment, planned, ahead, true).shown.left_s();
  };
  const double report = left_with({}), points_alone = left_with({.unmeasured = {0, 1}});
  const double all = left_with({.unmeasured = {0, 1}, .timed = {0, 1}, .diagrams = {&plans[0]}, .drawn = 2});
  EXPECT_GT(report, 0);
  EXPECT_GT(points_alone, report);
  EXPECT_GT(left_with({.timed = {0, 1}}), report);
  EXPECT_GT(left_with({.diagrams = {&plans[0]}}), report);
  EXPECT_GT(left_with({.drawn = 2}), report);
  EXPECT_GT(all, points_alone + left_with({.diagrams = {&plans[0]}}) - report);
  EXPECT_EQ(drawn_after_points(experiment, planned), 2u);
}

}  // namespace
}  // namespace noonmark
