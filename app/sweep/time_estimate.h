// How long a sweep takes on this machine, from a short calibration: some of its points are measured in small pictures, and
// a linear model of the work of each stage is fitted to their times.
//
//   const TimeEstimate time = estimate_time(bench, experiment, points(experiment), phase_plans(experiment, points(experiment)));
#pragma once
#include <span>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/sweep_phase.h"
#include "measure/workbench.h"

namespace noonmark {

struct TimeEstimate {
  double cpu_s = 0;          // processor time of all threads
  double wall_s = 0;         // if the machine stays as busy as it is now
  double calibration_s = 0;  // processor time that the estimate itself took
  int measured = 0;          // small pictures
};

// bench: before its first measurement, so that what starting takes counts once. Nothing is written that stays.
TimeEstimate estimate_time(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& planned,
                           const std::vector<PhasePlan>& diagrams);

// The x with the least sum of squares of A x - b, where no element of x is negative. rows: those of A, all of one length.
// Where several x are as good, one of them.
std::vector<double> least_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& b);

}  // namespace noonmark
