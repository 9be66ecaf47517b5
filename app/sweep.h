// Runs an experiment: measures and stores every point once, and writes the files for people and programs.
//
//   SweepOutcome outcome = run_sweep(experiment, ResultsFolder("out/cube-room"), {.command = "noonmark run ..."});
#pragma once
#include <string>
#include <vector>

#include "app/experiment.h"
#include "app/results_folder.h"
#include "compare/store/records.h"

namespace noonmark {

struct SweepOptions {
  bool overwrite = false;  // start anew; the results in the folder's store are lost
  std::string command;     // for the record
};

struct SweepOutcome {
  Results results;
  bool interrupted = false;  // by SIGINT or SIGTERM; the finished points are stored
  // For each planned point: the digest of the contents of its scene's file. Empty if the scene is built in.
  std::vector<std::string> scenes;
};

// Points that do not fit into memory are refused before any point is measured. The sweep resumes where an earlier run
// of the same experiment stopped. Damaged parts of the store are reported and measured anew. Writes results.sqlite
// point by point, then results.csv, report.html and, if pictures are asked for, images/. Throws Error: usage, scene,
// device; and defect if a measurement is not sound, after everything is stored.
SweepOutcome run_sweep(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

// Throws Error(defect) at the first point with a metric beyond its limit in compare/judge/soundness.h. Points without a
// facing receiver are not checked.
void require_sound(const Results& results);

// Writes report.html and results.csv from the contents of the results' folder.
void write_report(const Results& results, const std::string& out);

// Prints what a run would do: every point with its memory, and an estimate of the time from small pictures of the first
// point. Throws Error(usage) for a point that does not fit into memory.
void print_plan(const Experiment& experiment);

}  // namespace noonmark
