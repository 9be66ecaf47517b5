#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/report/phase.h"
#include "measure/phase_diagram.h"
#include "measure/workbench.h"
#include "scenes/library.h"
#include "technique/placements.h"
#include "technique/setting_json.h"

namespace noonmark {
namespace {

// What the page and the CSV say of each texel size, and where they are. docs/reference/command-line.md describes the keys.
std::string map_json(const PhaseDiagram& diagram, const std::string& out) {
  using Json = nlohmann::ordered_json;
  Json rows = Json::array();
  for (const PhaseRow& row : diagram.rows) {
    const Interval usable = diagram.usable(row);
    Json one{{"resolution", row.resolution},
             {"texel_m", number_json(row.texel_m)},
             {"last_acne_m", number_json(row.last_acne_m)}};
    one["usable_m"] = usable.empty() ? Json() : Json{number_json(usable.low), number_json(usable.high)};
    rows.push_back(std::move(one));
  }
  const Json all{{"noonmark", diagram.version},
                 {"command", diagram.command},
                 {"exit_code", 0},
                 {"scene", diagram.scene},
                 {"light", diagram.light},
                 {"technique", diagram.technique},
                 {"placements", diagram.placements},
                 {"acne_bound", diagram.acne_bound},
                 {"peter_panning_bound", diagram.peter_panning_bound},
                 {"text", phase_words(diagram)},
                 {"texel_sizes", std::move(rows)},
                 {"notes", diagram.notes.empty() ? Json::array() : Json{diagram.notes}},
                 {"page", out + "/phase.html"},
                 {"csv", out + "/phase.csv"}};
  return readable_json(all) + "\n";
}

int draw_map(const std::string& scene, const PhaseOptions& options, ExperimentArguments arguments) {
  const VerbOutputs outputs = outputs_of("map", scene, arguments.out);
  OutputFolder folder(outputs);
  if (options.coarsest >= options.finest)
    throw Error(ErrorKind::usage, fmt::format("the coarsest resolution ({}) is not below the finest ({}); set --from "
                                              "and --to",
                                              options.coarsest, options.finest));
  // A smaller picture than a point's: the diagram has hundreds of points' worth of texel sizes and placements.
  arguments.sets.insert(arguments.sets.begin(), {"view.width_px=640", "view.height_px=360"});
  take_scene(arguments, scene);
  const Settings given = points(experiment_from("", arguments)).at(0);
  const std::string& out = outputs.folder;
  Workbench bench(gl::DebugMode::log);
  const Scene& loaded = bench.scene(given.scene);
  const Settings settings = phase_settings(given, loaded);
  Settings coarse = settings;
  coarse.map.resolution = options.coarsest;  // no map is drawn, and none is kept
  coarse.map.placements = options.placements;
  require_memory(bench.memory(coarse, false, false), bench.memory_of_program(false), "this diagram");
  Progress progress(arguments.quiet);
  const Progress::Work rows = progress.add(static_cast<size_t>(options.rows));
  progress.say(fmt::format("the phase diagram of {}", loaded.name));
  PhaseDiagram diagram = bench.phase(settings, options, nullptr, [&](int done) {
    progress.finished_small(rows, fmt::format("{} of {} texel sizes", done, options.rows));
  });
  progress.end_line();
  describe_phase(diagram, settings, loaded);
  diagram.command = arguments.command;
  diagram.version = build_facts().version;
  diagram.notes = notes_line(loaded);
  for (const std::string& note : light_notes(loaded, settings))
    diagram.notes += (diagram.notes.empty() ? "" : "; ") + note;
  folder.make();
  write_file_atomically(out + "/phase.html", render_phase(diagram));
  write_file_atomically(out + "/phase.csv", phase_csv(diagram));
  if (arguments.json) {
    fmt::print("{}", map_json(diagram, out));
    return 0;
  }
  for (const std::string& sentence : phase_words(diagram)) fmt::print("{}\n", sentence);
  if (!diagram.notes.empty()) fmt::print("note: {}\n", printable(diagram.notes));
  fmt::print("\n{0}/phase.html and {0}/phase.csv are written\n", printable(out));
  return 0;
}

struct MapOptions {
  std::string scene;
  PhaseOptions phase;
  ExperimentArguments arguments;
};

// Of the diagram: the bounds of a usable pair, the texel sizes and the placements.
void add_phase_options(CLI::App& verb, PhaseOptions& phase) {
  add_share(verb, "--acne", phase.acne_bound,
            "The most acne of a usable pair, as a share of the counted receivers: 0.001 or 0.1%",
            percent_text(phase.acne_bound));
  add_share(verb, "--peter-panning", phase.peter_panning_bound, "The most Peter Panning of a usable pair",
            percent_text(phase.peter_panning_bound));
  verb.add_option("--from", phase.coarsest, "The coarsest texels: resolution at the present extent")
      ->check(whole_number(4, 16384))
      ->capture_default_str();
  verb.add_option("--to", phase.finest, "The finest texels")->check(whole_number(4, 16384))->capture_default_str();
  verb.add_option("--rows", phase.rows, "Number of texel sizes")->check(whole_number(2, 200))->capture_default_str();
  verb.add_option("--placements", phase.placements, "S: each texel size is measured at S x S placements of its grid")
      ->check(whole_number(1, Placements::most))
      ->capture_default_str();
}

RunVerb add_map(CLI::App& verb) {
  const auto options = std::make_shared<MapOptions>();
  ExperimentArguments& arguments = options->arguments;
  verb.add_option("scene", options->scene, "A built-in scene, or the path of a .gltf, .glb or .vrm file")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::scene);
  add_sets(verb, arguments);
  add_phase_options(verb, options->phase);
  add_threads(verb, arguments);
  add_json(verb, arguments, "Print the usable biases of each texel size as JSON");
  add_out(verb, arguments, "Folder for the files",
          folders_of({"plate", "checks/helmet.glb"},
                     [](const std::string& scene) { return outputs_of("map", scene, "").folder; }));
  return [options](const std::string& command) {
    options->arguments.command = command;
    const ThreadLimit limit(options->arguments.threads);
    return draw_map(options->scene, options->phase, options->arguments);
  };
}

}  // namespace

Verb verb_map() {
  return {"map", "Draw which texel sizes and biases of a scene are usable: its phase diagram", "noonmark map cube-room",
          add_map};
}

}  // namespace noonmark
