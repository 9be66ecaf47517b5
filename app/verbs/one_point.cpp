#include "app/verbs/one_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/verbs/option_values.h"
#include "base/error.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// "; point 0: map.resolution = 512; ..." of the first points.
std::string points_text(const Experiment& experiment, size_t count) {
  constexpr size_t most = 8;
  std::string text;
  for (size_t id = 0; id < std::min(count, most); ++id) {
    const std::string part = part_of_point(experiment, static_cast<int64_t>(id)).part;
    const std::string swept = swept_text(experiment, static_cast<int64_t>(id));
    text += fmt::format("; point {}: {}{}{}", id, part.empty() ? "" : fmt::format("part '{}'", part),
                        part.empty() || swept.empty() ? "" : ", ", swept);
  }
  return count > most ? text + "; ..." : text;
}

Experiment scene_or_experiment(const PointOptions& options) {
  const std::string& what = options.what;
  ExperimentArguments arguments = options.arguments;
  std::error_code none;
  const std::filesystem::path path(what);
  const bool experiment =
      what.empty() || path.extension() == ".toml" || (std::filesystem::exists(path, none) && !names_file(what));
  if (!experiment) take_scene(arguments, what);
  return experiment_from(experiment ? what : "", arguments);
}

}  // namespace

OnePoint chosen_point(const PointOptions& options, std::string_view verb) {
  OnePoint chosen{scene_or_experiment(options), std::max(options.point, 0L), {}};
  const std::vector<Settings> all = points(chosen.experiment);
  if (options.point < 0 && all.size() > 1)
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has {} points, but {} measures one; give --point 0 ... {}, or --set the swept settings{}",
                    chosen.experiment.path, all.size(), verb, all.size() - 1,
                    points_text(chosen.experiment, all.size())));
  if (options.point >= static_cast<long>(all.size()))
    throw Error(ErrorKind::usage,
                fmt::format("there is no point {}; the last one is {}", options.point, all.size() - 1));
  chosen.settings = all[static_cast<size_t>(chosen.id)];
  return chosen;
}

void add_point_options(CLI::App& verb, PointOptions& options, bool measured) {
  verb.add_option("what", options.what,
                  fmt::format("A built-in scene, a model, or an experiment's TOML file{}",
                              measured ? "; without one, the default settings" : ""))
      ->required(!measured)
      ->check(not_empty())
      ->type_name("SCENE|FILE.gltf|FILE.glb|FILE.vrm|FILE.toml");
  verb.add_option("--point", options.point, "Number of the point in the experiment's sweep, from 0")
      ->check(whole_number(0));
  add_sets(verb, options.arguments);
  if (!measured) return;
  add_parts(verb, options.arguments);
  add_threads(verb, options.arguments);
}

void require_room(Workbench& bench, const OnePoint& point, bool curve, bool pictures) {
  const MemoryEstimate memory =
      at_point(point.experiment, point.id, [&] { return bench.memory(point.settings, curve, pictures); });
  require_memory(memory, bench.memory_of_program(pictures), "this point");
}

void print_notes(const Scene& scene, const Settings& settings) {
  if (const std::string note = notes_line(scene); !note.empty()) fmt::print("  note: {}\n", printable(note));
  for (const std::string& note : light_notes(scene, settings)) fmt::print("  note: {}\n", printable(note));
}

}  // namespace noonmark
