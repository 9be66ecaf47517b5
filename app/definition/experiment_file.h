// Reads an experiment file (docs/reference/experiment.md).
//
//   Experiment experiment = load_experiment("experiments/cube-room.toml");
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/definition/experiment.h"

namespace noonmark {

// Throws Error(usage) with file:line:column, and for an unknown name with the nearest known one. A relative path of a
// scene file starts at the experiment file's folder. sets: what apply_override() takes, of `--set`: they replace the file's values
// before it is checked which values go together.
Experiment load_experiment(const std::string& path, const std::vector<std::string>& sets = {});
// The same from text; path is used for messages and for relative scene paths.
Experiment parse_experiment(std::string_view toml, const std::string& path, const std::vector<std::string>& sets = {});

}  // namespace noonmark
