// What to type into other engines, for an experiment that has one choice of settings, such as recommended.toml.
#pragma once
#include <string>

#include "app/definition/experiment.h"
#include "measure/workbench.h"

namespace noonmark {

// The text that `recommend` writes as engines.txt, for the settings of the experiment's first point. Empty if the experiment
// has parts or sweeps choices, because then there is no one choice to type. first: the settings of its first point.
std::string experiment_engines(Workbench& bench, const Experiment& experiment, const Settings& first);

}  // namespace noonmark
