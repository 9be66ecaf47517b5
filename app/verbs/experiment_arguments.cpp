#include "app/verbs/experiment_arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/definition/default_folder.h"
#include "app/definition/experiment_file.h"
#include "app/verbs/option_values.h"
#include "base/error.h"
#include "base/text.h"

namespace noonmark {

CLI::Option* add_experiment(CLI::App& verb, std::string& path, const char* what) {
  return verb.add_option("experiment", path, what)->check(not_empty())->type_name(value_kind::experiment);
}

void add_model(CLI::App& verb, std::string& path) {
  verb.add_option("model", path, "The path of a .gltf, .glb or .vrm file")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::model);
}

void add_sets(CLI::App& verb, ExperimentArguments& arguments) {
  verb.add_option("--set", arguments.sets,
                  "Override a setting: name=value (noonmark settings lists them). May be repeated")
      ->expected(1)
      ->take_all()
      ->type_name(value_kind::setting);
}

void take_scene(ExperimentArguments& arguments, const std::string& scene) {
  for (const std::string& set : arguments.sets)
    if (set.starts_with("scene.name=") || set.starts_with("scene="))
      throw Error(ErrorKind::usage, fmt::format("--set {}: the scene is {} already; give one of the two", set, scene));
  arguments.sets.push_back("scene.name=" + scene);
}

void add_parts(CLI::App& verb, ExperimentArguments& arguments) {
  verb.add_option("--part", arguments.parts,
                  "Measure only the part of the experiment with this name; points are counted from 0. May be repeated")
      ->expected(1)
      ->take_all()
      ->type_name(value_kind::part);
}

void add_threads(CLI::App& verb, ExperimentArguments& arguments) {
  verb.add_option("--threads", arguments.threads, "Number of threads; no result depends on it")
      ->check(whole_number(1, 1024))
      ->default_str("one for each core");
}

void add_json(CLI::App& verb, ExperimentArguments& arguments, const char* what) {
  verb.add_flag("--json", arguments.json, what);
  verb.add_flag("--quiet", arguments.quiet, "Print no progress; notes, warnings and errors stay");
}

void add_out(CLI::App& verb, ExperimentArguments& arguments, const char* what, const std::string& by_default) {
  verb.add_option("--out", arguments.out, what)
      ->check(not_empty())
      ->type_name(value_kind::folder)
      ->default_str(by_default);
}

void add_out_file(CLI::App& verb, ExperimentArguments& arguments, const char* what, const char* kind,
                  const std::string& by_default) {
  verb.add_option("--out", arguments.out, what)->check(not_empty())->type_name(kind)->default_str(by_default);
  verb.add_flag("--overwrite", arguments.overwrite, "Replace the file if it is there already");
}

void add_results_folder(CLI::App& verb, ExperimentArguments& arguments, const char* what) {
  add_out(verb, arguments, what, folders_of({"shadows.toml", "checks/shadows.toml"}, [](const std::string& file) {
            return default_folder(file);
          }));
}

void add_sweep_options(CLI::App& verb, ExperimentArguments& arguments, const char* dry_run) {
  verb.add_flag("--overwrite", arguments.overwrite,
                "Measure everything anew and replace the results in the folder; without it, points that are there "
                "already are kept");
  verb.add_option("--shard", arguments.shard_text,
                  "Measure only share I of N, into the subfolder share-I-of-N of the results' folder, and judge "
                  "nothing: noonmark merge joins the shares. In a task of a Slurm array the task's numbers are the "
                  "default; 1/1 measures all")
      ->check(not_empty())
      ->type_name("I/N");
  verb.add_flag("--dry-run", arguments.dry_run, dry_run);
  add_json(verb, arguments, "Print the results as JSON: verdict, bounds, laws, answer and every point");
  verb.add_flag("--print-config", arguments.print_config,
                "Only print the experiment as a file with every default written out");
}

void read_sweep_arguments(ExperimentArguments& arguments) {
  if (arguments.json + arguments.print_config + arguments.dry_run > 1)
    throw Error(ErrorKind::usage, "--json, --print-config and --dry-run each print something else; give one of them");
  if (!arguments.shard_text.empty())
    arguments.shard = shard_from(arguments.shard_text);
  else if ((arguments.shard = slurm_shard()))
    fmt::print(stderr,
               "note: this is a task of a Slurm array, so --shard {} is taken; --shard 1/1 measures all points\n",
               arguments.shard->text());
  if (arguments.shard && arguments.shard->of == 1) arguments.shard.reset();  // 1/1 is no share
}

std::string folders_of(std::initializer_list<const char*> subjects,
                       const std::function<std::string(const std::string&)>& folder_of) {
  std::string text;
  for (const char* subject : subjects)
    text += fmt::format("{}{} for {}", text.empty() ? "" : ", ", folder_of(subject), subject);
  return text;
}

namespace {

// bias.unit = m reads as if it were of all parts; offsets have a unit of their own. Empty if nothing is to be said.
std::string note_on_offsets(const Experiment& experiment) {
  for (const Experiment& part : experiment.parts)
    if (std::string note = note_on_offsets(part); !note.empty()) return note;
  const auto gives = [&](const std::string& name) { return experiment.locations.contains(name); };
  if (!gives("bias.unit") || experiment.base.bias.unit != BiasUnit::m || gives("bias.offset_unit")) return "";
  for (const BiasPart& part : bias_parts())
    if (const std::string name = "bias." + std::string(part.name); part.unit == "bias.offset_unit" && gives(name))
      return fmt::format(
          "bias.unit = m is not the unit of {0}, which moves a place: {0} is in texels; give "
          "bias.offset_unit = m for metres, or texel",
          name);
  return "";
}

}  // namespace

Experiment experiment_from(const std::string& path, const ExperimentArguments& arguments) {
  Experiment experiment = path.empty() ? Experiment{} : load_experiment(path, arguments.sets);
  // Also what a file says of one light or part alone, and the defaults where there is no file.
  for (const std::string& assignment : arguments.sets) apply_override(experiment, assignment);
  if (experiment.lights || experiment.all_lights)
    for (const char* chooses : {"light.name", "light.index", "light.kind"})
      if (std::find(experiment.overridden.begin(), experiment.overridden.end(), chooses) != experiment.overridden.end())
        throw Error(
            ErrorKind::usage,
            fmt::format("--set {}: {} measures the lights of one frame together, so none is chosen; --part NAME "
                        "measures one of them",
                        chooses, path));
  take_all_lights(experiment);
  if (!arguments.parts.empty()) choose_parts(experiment, arguments.parts);
  for (const std::string& note : experiment.notes) fmt::print(stderr, "warning: {}\n", printable(note));
  if (fits_cascades(experiment))
    fmt::print(stderr, "note: no map.fit is given, so each cascade is fitted to its slice of the view: map.fit = {}\n",
               fit_of_cascades);
  if (const std::string note = note_on_offsets(experiment); !note.empty()) fmt::print(stderr, "note: {}\n", note);
  return experiment;
}

}  // namespace noonmark
