// The machines that measured the points of a store, and which verdicts join numbers of several of them.
//
//   for (const std::string& note : machine_notes(results).warnings) print(note);   // none if one machine measured all points
#pragma once
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

// Sentences without a full stop, for the report, summary.md and the terminal. First how many points each machine measured, if
// there is more than one. Then a warning for each bound and law whose verdict hangs on numbers of several machines: on
// times, if the hosts differ; on other metrics, if processor, driver or ray tracer differ, because these may round otherwise.
// results: with the verdicts. Points without a recorded machine count as of one machine.
struct MachineNotes {
  std::vector<std::string> machines, warnings;
};
MachineNotes machine_notes(const Results& results);

}  // namespace noonmark
