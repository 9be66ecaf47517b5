#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "app/advise/recommend_around.h"
#include "app/advise/recommend_text.h"
#include "app/definition/default_folder.h"
#include "app/pictures/image_file.h"
#include "app/pictures/pictures.h"
#include "app/sweep/results_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// The points of the conditions alone: each choice of the sweep has its first value.
std::vector<Settings> conditions_of(Experiment experiment) {
  std::erase_if(experiment.swept, [](const Swept& swept) { return !swept.condition; });
  return points(experiment);
}

bool is_experiment(const std::string& path) { return std::filesystem::path(path).extension() == ".toml"; }

// Whether the user said what a setting with this beginning is, fixed or swept. The unit of the bias is none of it.
bool gives(const Experiment& experiment, std::string_view begin) {
  return std::any_of(experiment.locations.begin(), experiment.locations.end(),
                     [&](const auto& given) { return given.first.starts_with(begin) && given.first != "bias.unit"; });
}

// What the experiment fixes or sweeps of resolution and filter is what may be recommended.
void take_choices(AdviceRequest& request, const Experiment& experiment) {
  std::map<std::string, FilterSettings> filters;
  std::set<int> resolutions;
  for (const Settings& point : points(experiment)) {
    std::string key;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("filter.")) key += row.get(point) + '\n';
    filters.emplace(key, point.filter);
    resolutions.insert(point.map.resolution);
  }
  if (gives(experiment, "map.resolution")) request.resolutions.assign(resolutions.begin(), resolutions.end());
  if (!gives(experiment, "filter.")) return;
  request.filters.clear();
  for (const auto& [key, filter] : filters) request.filters.push_back(filter);
  const auto reach = [](const FilterSettings& filter) { return tap_pattern(filter).reach_texels(); };
  std::stable_sort(request.filters.begin(), request.filters.end(),
                   [&](const auto& a, const auto& b) { return reach(a) < reach(b); });
}

// The experiment, or the part that was chosen. Each part is an experiment of its own, with its own conditions and bounds, so
// one answer cannot hold for several.
const Experiment& only_part(const Experiment& experiment) {
  if (experiment.parts.empty()) return experiment;
  if (experiment.parts.size() == 1) return experiment.parts.front();
  std::string names;
  constexpr size_t most = 6;
  for (size_t i = 0; i < std::min(most, experiment.parts.size()); ++i)
    names += fmt::format("{}'{}'", i ? ", " : "", experiment.parts[i].part);
  if (experiment.parts.size() > most) names += " ...";
  throw Error(
      ErrorKind::usage,
      fmt::format("{} has {} parts, and recommend answers for one: give --part NAME ({}); noonmark run compares "
                  "parts and recommends one of their settings",
                  experiment.path, experiment.parts.size(), names));
}

// The files of an earlier run, which another answer, or none, would make stale. Before the search, because it can fail.
void remove_earlier_advice(const std::string& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "engines.txt" && !name.starts_with("recommended.") && !name.starts_with("recommended-")) continue;
    if (std::error_code error; !std::filesystem::remove(entry.path(), error))
      throw Error(ErrorKind::file,
                  fmt::format("{}: an earlier recommendation cannot be removed: {}; remove it, or give "
                              "another --out",
                              entry.path().string(), error.message()));
  }
}

}  // namespace

int verb_recommend(const std::string& what, const RecommendOptions& options, ExperimentArguments arguments) {
  if (!is_experiment(what)) arguments.sets.push_back("scene.name=" + what);
  const Experiment whole = experiment_from(is_experiment(what) ? what : "", arguments);
  const Experiment& experiment = only_part(whole);
  const std::string out = arguments.out.empty() ? default_folder(what, "recommend-") : arguments.out;
  require_room_to_start(true);
  Workbench bench(gl::DebugMode::log);
  require_image_files();
  AdviceRequest request;
  request.conditions = conditions_of(experiment);
  const Settings first = request.conditions.front();
  const Scene& scene = bench.scene(first.scene);
  if (request.conditions.size() == 1 && options.views > 1) {
    request.conditions = turned_views(first, scene);
    request.conditions.resize(std::min(request.conditions.size(), static_cast<size_t>(options.views)));
  }
  const LightKind light = make_light_frame(scene, request.conditions.front()).kind;
  if (!gives(experiment, "bias.")) request.levels = bias_levels();
  request.filters = filters_to_try(light);
  for (int resolution = 256; resolution <= 8192; resolution *= 2) request.resolutions.push_back(resolution);
  take_choices(request, experiment);
  request.curve = experiment.curve;
  if (options.acne) request.curve.acne_bound = *options.acne;
  if (options.peter_panning) request.curve.peter_panning_bound = *options.peter_panning;
  request.accuracy = experiment.accuracy;
  request.error = options.error;
  request.budget = options.budget;

  make_output_folder(out);
  clear_abandoned_files(out);
  remove_earlier_advice(out);
  Progress progress(arguments.quiet);  // shows no remaining time, because each result decides what is tried next
  const auto say = [&](const std::string& step) { progress.say(printable(step)); };
  Advice advice = search(bench, request, say);
  if (advice.answer && options.around)
    advice.around = settings_around(bench, answer_under_conditions(advice),
                                    {.bounds = request.curve, .accuracy = request.accuracy}, say);
  progress.end_line();
  std::vector<EngineAdvice> engines;
  if (advice.answer) {
    const Settings& settings = advice.answer->settings;
    const Scene& loaded = bench.scene(settings.scene);
    engines = engine_advice(settings, make_light_frame(loaded, settings), loaded);
  }
  write_file_atomically(out + "/recommended.json", advice_json(advice, engines));
  if (arguments.json)
    fmt::print("{}", advice_json(advice, engines));
  else
    for (const std::string& line : advice_text(advice)) fmt::print("{}\n", printable(line));
  if (!advice.answer) return 1;
  write_file_atomically(out + "/recommended.toml", advice_experiment(advice, out));
  write_file_atomically(out + "/engines.txt", advice_engines(engines));
  if (advice.around) write_file_atomically(out + "/recommended.html", to_tornado_page(*advice.around));
  const Measurement shown = bench.measure(advice.answer->settings, std::nullopt);
  write_pictures(shown, out, ".", "recommended");
  if (!arguments.json) {
    fmt::print("\nWhat to type (what each engine cannot express is in {}/engines.txt):\n", printable(out));
    for (const EngineAdvice& engine : engines) {
      fmt::print("  {} ({})\n", engine.engine, engine.version);
      for (const std::string& line : engine.lines) fmt::print("    {}\n", line);
    }
    if (const std::string note = notes_line(bench.scene(first.scene)); !note.empty())
      fmt::print("note: {}\n", printable(note));
    std::set<std::string> fitted;  // conditions may be lights that stand elsewhere
    for (const Settings& condition : request.conditions)
      fitted.insert(map_fit_note(bench.scene(condition.scene), condition));
    for (const std::string& note : fitted)
      if (!note.empty()) fmt::print("note: {}\n", printable(note));
    fmt::print(
        "\n{0}/recommended.toml (check it: noonmark check {0}/recommended.toml), {0}/recommended.json, {0}/engines.txt "
        "and "
        "{0}/recommended-*.png are written\n",
        printable(out));
    if (advice.around)
      fmt::print("{}/recommended.html shows what each setting does around the recommended ones\n", printable(out));
  }
  return 0;
}

}  // namespace noonmark
