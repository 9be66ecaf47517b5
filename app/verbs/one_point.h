// The point of an experiment that a verb for one point measures: that of --point, or the only one.
//
//   add_point(verb, point);
//   const Experiment experiment = experiment_or_scene(path, arguments);
//   const Settings settings = the_point(experiment, point, "render");
#pragma once
#include <CLI/CLI.hpp>
#include <string_view>

#include "app/definition/experiment.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"

namespace noonmark {

// What such a verb takes.
namespace value_kind {
inline constexpr const char* experiment_or_scene = "SCENE|FILE.gltf|FILE.glb|FILE.vrm|FILE.toml";
}

// A file that ends in .toml, and any other that is no model, is an experiment; another word is a scene, as take_scene() takes it. Empty:
// the default settings. Throws Error(usage) as experiment_from() and take_scene() do.
Experiment experiment_or_scene(const std::string& path, ExperimentArguments arguments);

// point: the value of the option; -1 before it is given.
void add_point(CLI::App& verb, long& point);

// Throws Error(usage) if there is no such point, and if none is given and the experiment has several.
Settings the_point(const Experiment& experiment, long point, std::string_view verb);

}  // namespace noonmark
