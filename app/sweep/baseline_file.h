// The baseline that `noonmark check` compares with, or writes (--baseline, --update-baseline, --baseline-times).
#pragma once
#include <optional>
#include <string>

#include "app/definition/experiment.h"
#include "app/sweep/sweep.h"
#include "compare/judge/baseline.h"

namespace noonmark {

struct BaselineOptions {
  std::string file;             // compare/judge/baseline.h; empty: none
  bool update = false;          // write it instead of comparing with it
  std::optional<double> times;  // compare times too; the share by which they may differ
};

class BaselineFile {
 public:
  // Reads the file, unless it is to be written. Without options.file this does nothing. Throws Error(usage): the
  // file is not there or is no baseline, the experiment names no value that could be kept, or a part alone would
  // replace the baseline of all parts.
  BaselineFile(const BaselineOptions& options, const Experiment& experiment);

  // Compares a finished sweep with the file. If the file is to be written, writes it atomically, adds a line about it to `said`,
  // and returns nothing. Throws Error(usage) as compare_with_baseline() does, Error(file).
  std::optional<BaselineComparison> compare_or_update(const Experiment& experiment, const SweepOutcome& outcome,
                                                      std::string& said) const;

 private:
  BaselineOptions options_;
  Baseline before_;
};

}  // namespace noonmark
