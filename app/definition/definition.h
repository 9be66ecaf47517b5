// An experiment as one text in the store, so that stores can be joined and judged without its file.
//
//   info.definition = definition_text(experiment);
//   Experiment experiment = experiment_of(info.definition, "out/x/results.sqlite");   // the same points, bounds and laws, and the same commands
#pragma once
#include <string>

#include "app/definition/experiment.h"

namespace noonmark {

// JSON: the experiment's path, the settings and parts that its options gave, and experiment_text(). Throws Error(usage) as
// that does.
std::string definition_text(const Experiment& experiment);

// The same with the file's name in place of an absolute path: what a joined store keeps, because the path is of one host.
std::string without_host_path(const std::string& definition);

// The experiment's path that a definition names; and the same definition with another one.
std::string definition_path(const std::string& definition);
std::string with_path(const std::string& definition, const std::string& path);

// The name that a scene of the experiment file `from` has in the same file at `to`. A path of a scene starts at the folder of
// the experiment, so the folder of `from` is replaced by that of `to`. The name of a built-in scene stays. An absolute path
// stays too if it has only the root in common with `from`.
std::string moved_scene(const std::string& scene, const std::string& from, const std::string& to);

// Throws Error(file) if the text is none of definition_text(). store: for the message.
Experiment experiment_of(const std::string& definition, const std::string& store);

// The command that measures one share of the experiment: "noonmark run x.toml --set ... --shard 2/4".
std::string share_command(const Experiment& experiment, const std::string& shard);

}  // namespace noonmark
