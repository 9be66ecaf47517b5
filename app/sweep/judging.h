// What follows from the stored points of an experiment: the verdict, and the files that show it. A sweep and a joined store
// use the same.
//
//   judge(experiment, results);
//   write_report(results, "out/cube-room");
//   require_sound(results);
#pragma once
#include <string>

#include "app/definition/experiment.h"
#include "compare/judge/findings.h"
#include "compare/report/csv.h"
#include "compare/results/records.h"

namespace noonmark {

// Judges every part's bounds and laws on that part's points. earlier: the bounds of the run before (compare/judge/last_run.h).
void judge(const Experiment& experiment, Results& results, const std::vector<BoundResult>& earlier = {});

// Of frames: a line for each that is refused, and what to do; empty if none is.
std::string refused_text(const Findings& found);

// What a terminal shows before the verdict: refused frames and what to do, the bounds and laws, each with what was found.
std::string findings_text(const Findings& found);

// The last line of it: "x.toml: Held: all 2 bounds at these 3 points; 3 points measured; the report is out/x/report.html".
std::string verdict_line(const Findings& found, const std::string& file, const std::string& counts,
                         const std::string& folder);

// Throws Error(defect) at the first point with a metric beyond its limit in compare/judge/soundness.h. Points without a
// facing receiver are not checked.
void require_sound(const Results& results);

// Writes report.html and results.csv from the contents of the results' folder.
void write_report(const Results& results, const std::string& out, CsvColumns columns = CsvColumns::asked);

}  // namespace noonmark
