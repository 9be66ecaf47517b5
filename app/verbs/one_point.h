// The point of an experiment that a verb for one point measures: that of --point, or the only one.
//
//   add_point(verb, point);
//   const Settings settings = the_point(experiment, point, "render");
#pragma once
#include <CLI/CLI.hpp>
#include <string_view>

#include "app/definition/experiment.h"

namespace noonmark {

// point: the value of the option; -1 before it is given.
void add_point(CLI::App& verb, long& point);

// Throws Error(usage) if there is no such point, and if none is given and the experiment has several.
Settings the_point(const Experiment& experiment, long point, std::string_view verb);

}  // namespace noonmark
