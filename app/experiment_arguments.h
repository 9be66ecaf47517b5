// Shared by run, check and render: the experiment with its overrides, and the folder of the results.
#pragma once
#include <filesystem>
#include <string>

#include "app/experiment.h"
#include "app/experiment_file.h"
#include "app/verbs.h"

namespace noonmark {

inline Experiment experiment_from(const std::string& path, const ExperimentArguments& arguments) {
  Experiment experiment = path.empty() ? Experiment{} : load_experiment(path);
  if (!arguments.parts.empty()) choose_parts(experiment, arguments.parts);
  for (const std::string& assignment : arguments.sets) apply_override(experiment, assignment);
  return experiment;
}

inline std::string out_folder(const std::string& path, const ExperimentArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  return "out/" + (path.empty() ? std::string("render") : std::filesystem::path(path).stem().string());
}

}  // namespace noonmark
