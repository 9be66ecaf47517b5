// Reads an experiment file (docs/reference/experiment.md).
//
//   Experiment experiment = load_experiment("experiments/cube-room.toml");
#pragma once
#include <string>
#include <string_view>

#include "app/definition/experiment.h"

namespace noonmark {

// Throws Error(usage) with file:line:column, and for an unknown name with the nearest known one. A relative path of a
// scene file starts at the experiment file's folder.
Experiment load_experiment(const std::string& path);
// The same from text; path is used for messages and for relative scene paths.
Experiment parse_experiment(std::string_view toml, const std::string& path);

}  // namespace noonmark
