// What each bound found in the run before into the same folder, so that a person sees at once what a change did.
//
//   const std::vector<BoundResult> earlier = ResultStore::bounds_of("out/x/results.sqlite");   // before the run judges
//   add_last_run(results.bounds, earlier);
//   print(last_run_text(results));
#pragma once
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

// Sets BoundResult::before of each bound that the run before had too: of the same part, metric, conditions, join and placement.
// Its limits may be others, because what was found does not depend on them.
void add_last_run(std::vector<BoundResult>& bounds, const std::vector<BoundResult>& earlier);

// Of a time whose value before lies within the interval of its samples now, the change is noise.
bool is_noise(const BoundResult& bound, const Results& results);

// "0.247% before", "as before", "0.52 ms before, within the noise (0.5 to 0.61 ms)"; empty if the run before did not have it.
std::string since_last_run(const BoundResult& bound, const Results& results);

// One line: "since the last run: acne 0.1% -> 0.3%; 2 values as before". Empty if there was no run before.
std::string last_run_text(const Results& results);

}  // namespace noonmark
