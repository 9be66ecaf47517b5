// What follows from the stored points of an experiment: the verdict, and the files that show it. A sweep and a joined store
// use the same.
//
//   judge(experiment, results);
//   write_report(results, "out/cube-room");
//   require_sound(results);
#pragma once
#include <string>

#include "app/definition/experiment.h"
#include "compare/report/csv.h"
#include "compare/results/records.h"

namespace noonmark {

// Judges every part's bounds and laws on that part's points. earlier: the bounds of the run before (compare/judge/last_run.h).
void judge(const Experiment& experiment, Results& results, const std::vector<BoundResult>& earlier = {});

// "worse than the baseline in 1 of 2 values, 3 of 3 bounds held, 2 of 2 laws hold": what the verdict is made of.
std::string verdict_words(const Results& results);

// The bounds and laws, each with what was found, one or more lines each.
std::string findings_text(const Results& results);

// Of frames: a line for each that is refused, and what to do; empty if none is.
std::string refused_text(const Results& results);

// Throws Error(defect) at the first point with a metric beyond its limit in compare/judge/soundness.h. Points without a
// facing receiver are not checked.
void require_sound(const Results& results);

// Writes report.html and results.csv from the contents of the results' folder.
void write_report(const Results& results, const std::string& out, CsvColumns columns = CsvColumns::asked);

}  // namespace noonmark
