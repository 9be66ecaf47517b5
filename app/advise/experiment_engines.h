// What to type into other engines, for an experiment that has one choice of settings, such as recommended.toml.
#pragma once
#include <span>
#include <string>

#include "app/definition/experiment.h"
#include "measure/workbench.h"

namespace noonmark {

// The text that `recommend` writes as engines.txt, without the measured errors, for the settings of the first of the experiment's
// points; the lines reach what any of the points shows. Empty if the experiment has parts or sweeps choices, because then there
// is no one choice to type. points: at least one.
std::string experiment_engines(Workbench& bench, const Experiment& experiment, std::span<const Settings> points);

// How far the farthest is that any of these conditions shows, along the view. Throws Error.
double farthest_in_views_m(Workbench& bench, std::span<const Settings> conditions);

}  // namespace noonmark
