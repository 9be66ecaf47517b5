// An experiment as the text of a file, with every default written out: noonmark run --print-config.
//
//   std::string toml = experiment_text(load_experiment("x.toml"));
#pragma once
#include <string>

#include "app/definition/experiment.h"

namespace noonmark {

// The text gives the same points, bounds and laws when it is read as a file in the folder of experiment.path; the paths
// of scenes start there. Overrides (--set, --part) are in it. Throws Error(usage) if no file can say this: an override
// leaves a `where` without a point that can meet it.
std::string experiment_text(const Experiment& experiment);

// The path of a scene as the experiment file `file` names it: from the file's folder. A scene that has no more in common with
// an absolute path of the file than the root keeps its absolute path.
std::string scene_path_in(const std::string& scene, const std::string& file);

}  // namespace noonmark
