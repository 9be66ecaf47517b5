// app/sweep/: an experiment carried out: plan, shares, resuming, the results' folder, merging, the verdict. May include
// every room but app/verbs.
//
// Runs an experiment: measures and stores every point once, and writes the files for people and programs.
//
//   SweepOutcome outcome = run_sweep(experiment, ResultsFolder("out/cube-room", "cube-room.toml"), {.command = "noonmark run ..."});
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/results_folder.h"
#include "app/sweep/shares.h"
#include "compare/report/summary.h"
#include "compare/results/records.h"
#include "compare/store/store.h"

namespace noonmark::gl {
struct DeviceInfo;
}
namespace noonmark::raytrace {
struct TracerInfo;
}

namespace noonmark {

struct SweepOutcome;

struct SweepOptions {
  bool overwrite = false;         // start anew; the results in the folder's store are lost
  std::string command;            // for the record
  bool quiet = false;             // no progress
  std::optional<Shard> shard{};   // measure only this share of the points, and judge nothing
  std::vector<int64_t> points{};  // the share's, in the order to measure them (split); at least one
  bool worst_pixels = false;      // draw what fails where a bound or a law is broken, for summary.md
  // Compares the judged results with a baseline, or writes one, before the report is written. Called only of a whole and sound
  // measurement.
  std::function<std::optional<BaselineComparison>(const SweepOutcome&)> baseline{};
};

struct SweepOutcome {
  Results results;
  bool interrupted = false;        // by SIGINT or SIGTERM; the finished points are stored
  int64_t measured = 0, kept = 0;  // points: by this run, and from earlier runs
  std::string counts() const;      // "1 point measured, 2 kept"
  std::vector<SummaryPicture> worst_pixels;
  // For each planned point: the digest of the contents of its scene's file. Empty if the scene is built in.
  std::vector<std::string> scenes;
};

// Points that do not fit into memory are refused before any point is measured. Stored points that the experiment has are
// kept and judged anew (app/sweep/kept_points.h), only the others are measured. Damaged parts of the store are reported and measured anew. Writes results.sqlite
// point by point, then results.csv, report.html and, if pictures are asked for, images/. Throws Error: usage, scene,
// device; and defect if a measurement is not sound, after everything is stored.
//
// Of a share only its points are measured, timed and reported. No bound and no law is judged, and pictures that are chosen by
// their errors (worst, extremes, answers) are not drawn: both need all points (app/sweep/merge.h). Its store continues on any machine; each
// point keeps the machine that measured it.
SweepOutcome run_sweep(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

// The same of an experiment with frames ([[frame]]), which run_sweep() hands on: each is a point of the store, the report and the
// verdict. Only a frame's own shadow map needs OpenGL. Frames are judged anew each time: a frame takes a second or two, and its
// pictures change without a change of their names. A frame that cannot be read, or of whose delivery a check failed, is refused:
// its record says why (PointRecord::Delivery), and the other frames are judged. Throws Error(usage) if the folder holds the
// results of another experiment, or if a bound needs the map of a frame that has none; Error(device) if a frame has a map and
// there is no OpenGL.
SweepOutcome run_frames(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

// Sets the comparison with the baseline, and keeps it in the store.
void compare_with_baseline(const SweepOptions& options, SweepOutcome& outcome, ResultStore& store);

// "stopped after 3 of 8 points; the same command continues from there"
std::string stopped_text(const SweepOutcome& outcome);

// What is recorded of a run beside its points: the experiment, the program and the machine. Without what the scene and its notes say. folder: of the results. Throws Error(usage) if a share's experiment can be said by
// no file (app/definition/definition.h).
RunInfo run_info(const Experiment& experiment, const std::string& folder, const SweepOptions& options,
                 const gl::DeviceInfo& device, const raytrace::TracerInfo& tracer);

}  // namespace noonmark
