// The point that a verb for one point measures: a scene, a model, or the point of --point of an experiment.
//
//   add_point_options(verb, options, true);
//   const OnePoint point = chosen_point(options, "render");
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

#include "app/verbs/experiment_arguments.h"
#include "measure/workbench.h"

namespace noonmark {

struct PointOptions {
  std::string what;  // an experiment's *.toml, a built-in scene, or a model's file; empty: the default settings
  long point = -1;   // of the experiment's sweep; -1: the sweep must have one point only
  ExperimentArguments arguments;
};

// `what`, --point and --set; with measured also --part and --threads, and `what` may be left out.
void add_point_options(CLI::App& verb, PointOptions& options, bool measured);

struct OnePoint {
  Experiment experiment;
  int64_t id = 0;
  Settings settings;
};

// Throws Error(usage) if there is no such point, and if none is given and the experiment has several.
OnePoint chosen_point(const PointOptions& options, std::string_view verb);

// Throws Error(usage) if the point does not fit into memory.
void require_room(Workbench& bench, const OnePoint& point, bool curve, bool pictures);

// What a reader must know of the scene and its lights, a line for each.
void print_notes(const Scene& scene, const Settings& settings);

}  // namespace noonmark
