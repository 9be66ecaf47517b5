#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/build_facts.h"
#include "app/experiment_arguments.h"
#include "app/phase_diagram.h"
#include "app/results_folder.h"
#include "app/verbs.h"
#include "app/workbench.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/library.h"
#include "scenes/text.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// The settings of a point of the diagram, as the words of a command; without texel size and bias.
std::string render_command(const Settings& settings) {
  const Settings defaults;
  std::string command = "noonmark render";
  for (const Setting& row : settings_table()) {
    const std::string value = row.get(settings);
    if (row.name == "map.resolution" || row.name == "bias.constant" || value == row.get(defaults)) continue;
    command += " --set " + shell_quoted(std::string(row.name) + "=" + value);
  }
  return command;
}

std::string technique_text(const Settings& settings) {
  std::string text = "constant bias in metres";
  const Settings defaults;
  for (const Setting& row : settings_table()) {
    const bool of_technique =
        row.name.starts_with("filter.") || row.name.starts_with("bias.") || row.name.starts_with("map.");
    if (!of_technique || row.name == "bias.unit" || row.name == "map.resolution" || row.name == "map.placements")
      continue;
    if (const std::string value = row.get(settings); value != row.get(defaults))
      text += fmt::format(", {} = {}", row.name, value);
  }
  return text;
}

}  // namespace

int verb_map(const std::string& scene, const PhaseOptions& options, ExperimentArguments arguments) {
  if (options.coarsest >= options.finest)
    throw Error(ErrorKind::usage, fmt::format("the coarsest resolution ({}) is not below the finest ({}); set --from "
                                              "and --to",
                                              options.coarsest, options.finest));
  // A smaller picture than a point's: the diagram has hundreds of points' worth of texel sizes and placements.
  arguments.sets.insert(arguments.sets.begin(), {"view.width_px=640", "view.height_px=360"});
  arguments.sets.push_back("scene.name=" + scene);
  const Settings given = points(experiment_from("", arguments)).at(0);
  const std::string out =
      arguments.out.empty() ? "out/map-" + std::filesystem::path(scene).stem().string() : arguments.out;
  Workbench bench(gl::DebugMode::log);
  const Scene& loaded = bench.scene(given.scene);
  const Settings settings = phase_settings(given, loaded);
  Settings coarse = settings;
  coarse.map.resolution = options.coarsest;  // no map is drawn, and none is kept
  coarse.map.placements = options.placements;
  require_memory(bench.memory(coarse, false, false), bench.memory_of_program(false), "this diagram");
  PhaseDiagram diagram = bench.phase(settings, options);
  diagram.scene = loaded.name;
  diagram.light = kind_of_light(effective_light(loaded, settings).kind).name();
  diagram.technique = technique_text(settings);
  diagram.command = arguments.command;
  diagram.render = render_command(settings);
  diagram.version = build_facts().version;
  diagram.notes = notes_line(loaded);
  make_output_folder(out);
  clear_abandoned_files(out);
  write_file_atomically(out + "/phase.html", render_phase(diagram));
  write_file_atomically(out + "/phase.csv", phase_csv(diagram));
  for (const std::string& sentence : phase_words(diagram)) fmt::print("{}\n", sentence);
  if (!diagram.notes.empty()) fmt::print("note: {}\n", printable(diagram.notes));
  fmt::print("\n{0}/phase.html and {0}/phase.csv are written\n", printable(out));
  return 0;
}

}  // namespace noonmark
