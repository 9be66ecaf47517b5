// Judges the frames of an experiment ([[frame]]): each is a point of the store, the report and the verdict, as the points of a
// sweep are. Only a frame's own shadow map needs OpenGL.
//
//   SweepOutcome outcome = run_frames(experiment, folder, options);
#pragma once
#include "app/definition/experiment.h"
#include "app/sweep/results_folder.h"
#include "app/sweep/sweep.h"

namespace noonmark {

// Frames are judged anew each time: a frame takes a second or two, and its pictures change without a change of their names.
// A frame that cannot be read, or of whose delivery a check failed, is refused: its record says why (PointRecord::Delivery),
// and the other frames are judged. Throws Error(usage) if the folder holds the results of another experiment, or if a bound
// needs the map of a frame that has none; Error(device) if a frame has a map and there is no OpenGL.
SweepOutcome run_frames(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

}  // namespace noonmark
