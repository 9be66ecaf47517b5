// The baseline that `noonmark check` compares with, or writes (--baseline, --update-baseline, --baseline-times).
#pragma once
#include <optional>

#include "app/experiment.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "compare/judge/baseline.h"

namespace noonmark {

class BaselineFile {
 public:
  // Reads the file, unless it is to be written. Without options.baseline this does nothing. Throws Error(usage): the
  // file is not there or is no baseline, the experiment names no value that could be kept, or a part alone would
  // replace the baseline of all parts.
  BaselineFile(const CheckOptions& options, const Experiment& experiment);

  // Compares a finished sweep with the file. If the file is to be written, writes it atomically, adds a line about it to `said`,
  // and returns nothing. Throws Error(usage) as compare_with_baseline() does, Error(file).
  std::optional<BaselineComparison> compare_or_update(const Experiment& experiment, const SweepOutcome& outcome,
                                                      std::string& said) const;

 private:
  CheckOptions options_;
  Baseline before_;
};

}  // namespace noonmark
