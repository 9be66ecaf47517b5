// The verdict on an experiment: one word, in one order, and its sentence, that the terminal, the exit code, the report, summary.md,
// junit.xml, JSON, the annotations and the index all say. They decide nothing themselves.
//
//   const Verdict verdict = verdict_of(results);
//   fmt::print("{}\n", verdict_sentence(results));   // "Broken: 1 of 2 bounds"
//   return exit_code_of(verdict);
#pragma once
#include <span>
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

// "unsound", "incomplete" ...
std::string_view word_of(Verdict verdict);

// Of a run with this verdict (docs/reference/exit-codes.md).
int exit_code_of(Verdict verdict);
// The same of a verb that was not asked to judge (`run`): what is broken or worse is told, and is no failure of it.
int exit_code_of_run(Verdict verdict);

inline bool passes(Verdict verdict) { return verdict == Verdict::held || verdict == Verdict::measured; }

// The verdict and what it is about, without a full stop; it begins with the verdict's word. "Worse than the baseline in 1 of 2 values;
// broken: 1 of 2 bounds", "Held: your bias of 2 texels holds all 4 bounds at these 12 points".
std::string verdict_sentence(const Results& results);

// "your bias of 2 texels": where every point was rendered with this one, and its curve says what others would do. Otherwise empty.
std::string your_bias(std::span<const PointRecord> points);
// "these 12 points", "this frame"
std::string these_points(std::span<const PointRecord> points);

}  // namespace noonmark
