// Shared by the verbs that measure: the experiment with its overrides.
#pragma once
#include <fmt/format.h>

#include <string>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "app/verbs/verbs.h"
#include "base/text.h"

namespace noonmark {

inline Experiment experiment_from(const std::string& path, const ExperimentArguments& arguments) {
  Experiment experiment = path.empty() ? Experiment{} : load_experiment(path);
  if (!arguments.parts.empty()) choose_parts(experiment, arguments.parts);
  for (const std::string& assignment : arguments.sets) apply_override(experiment, assignment);
  for (const std::string& note : experiment.notes) fmt::print(stderr, "warning: {}\n", printable(note));
  return experiment;
}

}  // namespace noonmark
