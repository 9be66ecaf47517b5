// Judges the frames of an experiment ([[frame]]): each is a point of the store, the report and the verdict, as the points of a
// sweep are. Nothing is measured with OpenGL.
//
//   SweepOutcome outcome = run_frames(experiment, folder, options);
#pragma once
#include "app/definition/experiment.h"
#include "app/sweep/results_folder.h"
#include "app/sweep/sweep.h"

namespace noonmark {

// Frames are judged anew each time: a frame takes a second or two, and its pictures change without a change of their names.
// Throws Error: usage if the folder holds the results of another experiment; file if a frame cannot be read, and, after
// everything is written, if a check of a delivery failed.
SweepOutcome run_frames(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

}  // namespace noonmark
