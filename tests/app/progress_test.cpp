// Progress counts the whole of a run: its remaining time is that of everything that is still to do, at the rate so far.
#include "base/progress.h"

#include <gtest/gtest.h>

#include "app/definition/experiment_file.h"
#include "app/sweep/sweep_progress.h"
#include "measure/pass_times.h"

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

TEST_F(ProgressOfWork, TheTimeLeftIsTheRateSoFar) {
  const Progress::Work rows = progress.add(3), points = progress.add(16), report = progress.add(1);
  progress.set_main(points);
  EXPECT_FALSE(progress.left_s());
  for (int i = 0; i < 3; ++i) step(rows, 1);
  EXPECT_FALSE(progress.left_s()) << "no point is done";
  step(points, 20);
  EXPECT_FALSE(progress.left_s()) << "the first point starts what the others use";
  EXPECT_EQ(progress.done_share(), 0);
  step(points, 4);
  // 14 points of 12 s; the report is a step as long as the mean of the five.
  EXPECT_NEAR(progress.left_s().value(), 14 * 12 + 27.0 / 5, 1e-9);
  EXPECT_NEAR(progress.done_share(), 27 / (27 + progress.left_s().value()), 1e-9);
  for (int i = 2; i < 16; ++i) step(points, 4);
  step(report, 10);
  EXPECT_EQ(progress.left_s(), 0);
  EXPECT_EQ(progress.done_share(), 1);
}

TEST_F(ProgressOfWork, EachWorkHasItsOwnRate) {
  const Progress::Work rows = progress.add(10), points = progress.add(10);
  step(points, 1);
  step(rows, 7);
  step(rows, 7);
  EXPECT_NEAR(progress.left_s().value(), 8 * 7 + 9 * 1, 1e-9);
}

TEST_F(ProgressOfWork, WhatIsLeftOfAWorkCanBecomeKnown) {
  const Progress::Work pictures = progress.add(2);
  step(pictures, 3);
  step(pictures, 3);
  progress.set_left(pictures, 5);
  EXPECT_NEAR(progress.left_s().value(), 15, 1e-9);
  progress.set_left(pictures, 0);
  EXPECT_EQ(progress.left_s(), 0);
  step(pictures, 1);  // more steps than expected
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
  // The steps of each kind, which are done until nothing is left.
  SweepProgress progress(planned, {.unmeasured = {0, 1}, .timed = {0, 1}, .diagrams = {&plans[0]}, .drawn = 2}, true);
  Progress& shown = progress.shown;
  const auto finish = [&](Progress::Work work, int steps) {
    for (int i = 0; i < steps; ++i) {
      EXPECT_NE(shown.left_s(), 0) << "something is left";
      shown.finished(work, "a step");
    }
  };
  finish(progress.rows, plans[0].request.texel_sizes);
  finish(progress.points, 2);
  finish(progress.rounds, time_rounds(planned));
  finish(progress.pictures, 2);
  finish(progress.report, 1);
  EXPECT_EQ(shown.left_s(), 0);
  EXPECT_EQ(drawn_after_points(experiment, planned), 2u);
}

}  // namespace
}  // namespace noonmark
