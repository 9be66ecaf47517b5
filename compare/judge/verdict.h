// The verdict on an experiment: one word, in one order, that the terminal, the exit code, the report, summary.md, junit.xml,
// JSON and the index all say.
//
//   const Verdict verdict = verdict_of(results);
//   fmt::print("{}\n", verdict_sentence(results));   // "Broken: 1 of 2 bounds."
//   return exit_code_of(verdict);
#pragma once
#include <string>
#include <string_view>

#include "compare/results/records.h"

namespace noonmark {

// The first that holds.
enum class Verdict {
  unsound,     // a measurement contradicts itself, so no number can be trusted
  incomplete,  // points are missing, or the run was stopped
  refused,     // a frame's delivery is not what it should be
  worse,       // a value is worse than in the baseline
  broken,      // a bound or a law is broken
  held,        // all bounds and laws hold, or warn; with a baseline also if none is set
  measured     // nothing is promised
};

Verdict verdict_of(const Results& results);

// Of a verb that measures and judges nothing: what does not depend on bounds, laws and a baseline.
Verdict verdict_without_promises(const Results& results);

// "unsound", "incomplete" ...
std::string_view word_of(Verdict verdict);

// Of a run with this verdict (docs/reference/exit-codes.md).
int exit_code_of(Verdict verdict);

inline bool passes(Verdict verdict) { return verdict == Verdict::held || verdict == Verdict::measured; }

// The verdict and what it is about, with a full stop: "Worse than the baseline in 1 of 2 values; broken: 1 of 2 bounds."
std::string verdict_sentence(const Results& results);

}  // namespace noonmark
