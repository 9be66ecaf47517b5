// Runs an experiment: every point measured once, stored as it goes, and the files for people and programs written.
//
//   SweepOutcome outcome = run_sweep(experiment, ResultsFolder("out/cube-room"), {.command = "noonmark run ..."});
#pragma once
#include <string>

#include "app/experiment.h"
#include "app/results_folder.h"
#include "compare/store/records.h"

namespace noonmark {

struct SweepOptions {
  bool overwrite = false;  // start anew, whatever the folder's store holds
  std::string command;     // for the record
};

struct SweepOutcome {
  Results results;
  bool interrupted = false;  // by SIGINT or SIGTERM; the finished points are stored
};

// Points that would not fit into memory are refused before any is measured. Resumes where an earlier run of the same
// experiment stopped; what no longer holds together in its store is told and measured anew. Writes results.sqlite point
// by point; then results.csv, report.html and, when pictures are asked for, images/. Throws Error: usage, scene,
// device; defect when a measurement is not sound (after everything is stored).
SweepOutcome run_sweep(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

// Throws Error(defect) at the first point with a metric beyond its limit in compare/judge/soundness.h. Points without a
// facing receiver have nothing to contradict.
void require_sound(const Results& results);

// report.html and results.csv from what is in the results' directory.
void write_report(const Results& results, const std::string& out);

// What a run would do: every point and how much memory it takes, and about how long it would take, judged from small
// pictures of the first point. Throws Error(usage) for a point that does not fit into memory.
void print_plan(const Experiment& experiment);

}  // namespace noonmark
