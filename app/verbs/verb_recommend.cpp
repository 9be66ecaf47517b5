#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "app/advise/answer_engines.h"
#include "app/advise/cascade_places.h"
#include "app/advise/engine_promise.h"
#include "app/advise/engine_trial.h"
#include "app/advise/recommend_about.h"
#include "app/advise/recommend_filtered.h"
#include "app/advise/recommend_text.h"
#include "app/definition/default_folder.h"
#include "app/pictures/image_file.h"
#include "app/pictures/pictures.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/recommend_output.h"
#include "app/verbs/recommend_texels.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/judge/choices.h"
#include "compare/results/number_text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/lookups.h"
#include "technique/setting_rules.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

constexpr const char* recommend_prefix = "recommend-";  // of the default folder

// What says where a map lies.
constexpr std::string_view settings_of_place[] = {
    "map.fit",          "map.extent_m",    "map.extent_scale", "map.near_m",         "map.far_m",
    "map.snap",         "map.depth_range", "map.reach_m",      "map.shift_u_texels", "map.shift_v_texels",
    "light.position_m", "light.target_m"};

bool is_experiment(const std::string& path) { return std::filesystem::path(path).extension() == ".toml"; }

// Whether [answer] choose of the experiment leaves a setting to the recommendation. What the command line gives stays.
bool leaves_open(const Experiment& experiment, const std::string& setting) {
  const auto is_of = [&](const std::string& group) {
    if (group == "map.fit")
      return std::find(std::begin(settings_of_place), std::end(settings_of_place), setting) !=
             std::end(settings_of_place);
    return setting == group || setting.starts_with(group + ".");
  };
  const std::vector<std::string>& given = experiment.overridden;
  return std::any_of(experiment.choose.begin(), experiment.choose.end(), is_of) &&
         std::find(given.begin(), given.end(), setting) == given.end();
}

// Whether the user said what a setting with this beginning is, fixed or swept. The unit of the bias is none of it.
bool gives(const Experiment& experiment, std::string_view begin) {
  return std::any_of(experiment.locations.begin(), experiment.locations.end(), [&](const auto& given) {
    return given.first.starts_with(begin) && given.first != "bias.unit" && !leaves_open(experiment, given.first);
  });
}

// The points of the conditions alone: each choice of the sweep has its first value.
std::vector<Settings> conditions_of(Experiment experiment) {
  std::erase_if(experiment.swept, [](const Swept& swept) { return !swept.condition; });
  const Settings unset;
  for (const auto& [name, location] : experiment.locations)
    if (name.starts_with("map.") && leaves_open(experiment, name)) {
      const Setting& row = find_setting(name);
      row.set(experiment.base, row.get(unset));
    }
  return points(experiment);
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

// Without --out the folder is named after the file or the scene alone. An answer for another scene of that name stays.
void require_own_advice(const std::string& folder, const std::string& subject) {
  constexpr uint64_t most_bytes = 1 << 28;
  const std::string file = folder + "/recommended.json";
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return;
  if (const std::string other = subject_in(read_file(file, most_bytes)); !other.empty() && other != subject)
    throw Error(ErrorKind::usage, fmt::format("{}: holds the recommendation for another scene ({}); give --out, or "
                                              "remove it",
                                              folder, other));
}

// A model's file is named after itself alone, as `noonmark init` names its experiment, so that both have one folder.
std::string folder_of_advice(const std::string& what) {
  return default_folder(is_experiment(what) ? what : std::filesystem::path(what).filename().string(), recommend_prefix);
}

struct RecommendOptions {
  std::string what;                           // an experiment's *.toml, a built-in scene, or a model's file
  std::optional<double> acne, peter_panning;  // bounds; empty: the experiment's
  std::optional<double> error, budget;        // AdviceRequest
  std::optional<double> edges, patch;         // bounds for the eye
  std::optional<int64_t> texels;              // recommend_texels() is asked for
  std::optional<AnswerKind> answer;           // empty: best with a budget, otherwise least
  int views = 5;                              // of a scene; 1: its own only
  std::vector<std::string> lookups;           // searched_lookups() to try; empty: those that compare
  bool cascades = false;                      // also tries cascade_counts
  std::vector<std::string> engines;           // to try the lines in
  std::vector<std::string> held_in;           // engine_words() in which the answer must hold
  std::optional<std::string> lines;  // the engine whose lines are printed; empty: the above, otherwise three.js
  std::string adapters;              // their folder; empty: the program's own
  ExperimentArguments arguments;
};

// The bounds for the eye: those of the experiment, the options' in their place, and the default of what neither gives.
std::vector<Bound> eye_bounds(const Experiment& experiment, const RecommendOptions& options) {
  std::vector<Bound> bounds;
  std::copy_if(experiment.bounds.begin(), experiment.bounds.end(), std::back_inserter(bounds), is_eye_bound);
  for (Bound& bound : bounds)  // which choices it is about is known only to an experiment that sweeps them
    std::erase_if(bound.where, [](const auto& one) { return !decides_what_is_seen(one.first); });
  for (const Bound& usual : default_eye_bounds()) {
    const std::optional<double> given = usual.metric == edge_metric ? options.edges : options.patch;
    const auto same = [&](const Bound& bound) { return bound.metric == usual.metric; };
    if (given) std::erase_if(bounds, same);
    if (std::any_of(bounds.begin(), bounds.end(), same)) continue;
    bounds.push_back(usual);
    if (given) bounds.back().max = *given;
  }
  return bounds;
}

// A setting of the map's place that the user gave; empty: none. How far cascades reach says nothing of one map.
std::string given_place(const Experiment& experiment) {
  for (const std::string_view name : settings_of_place)
    if (name != "map.reach_m" && gives(experiment, name)) return std::string(name);
  return "";
}

// Where the map may lie: if the user says nothing of it, also elsewhere than the settings lay it.
std::vector<MapPlace> places_of(const Experiment& experiment, const AdviceRequest& request, const Scene& scene,
                                std::span<const Settings> views) {
  if (request.conditions.front().cascades.count > 1) return {place_as_given(!gives(experiment, "bias."))};
  return given_place(experiment).empty() ? map_places(scene, request.conditions, views) : std::vector{place_as_given()};
}

// What was given that decides the answer, beside the scene: "scene.floor = true, map.resolution = 512 | 1024". Empty: nothing.
// Another answer for the same scene differs in one of these. What has its default decides nothing, but for what the search would choose.
std::string given_text(const Experiment& experiment, const AdviceRequest& request) {
  const Settings& first = request.conditions.front();
  const Settings unset;
  std::vector<std::string> parts;
  for (const Setting& row : settings_table()) {
    const std::string name(row.name), value = row.get(first);
    if (name == "scene.name" || !experiment.locations.contains(name) || leaves_open(experiment, name)) continue;
    const auto swept = std::find_if(experiment.swept.begin(), experiment.swept.end(),
                                    [&](const Swept& one) { return one.name == name; });
    std::vector<std::string> values;
    if (swept != experiment.swept.end())
      for (const std::string& one : swept->values) values.push_back(setting_text(one));
    else if (value != row.get(unset) || name == "map.resolution" || name == "map.fit" || name == "filter.kind")
      values.push_back(setting_text(value));
    if (!values.empty()) parts.push_back(fmt::format("{} = {}", name, fmt::join(values, " | ")));
  }
  const CurveOptions bounds;
  if (request.curve.acne_bound != bounds.acne_bound)
    parts.push_back("acne within " + percent_text(request.curve.acne_bound));
  if (request.curve.peter_panning_bound != bounds.peter_panning_bound)
    parts.push_back("Peter Panning within " + percent_text(request.curve.peter_panning_bound));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Where the bounds are from, for a sentence.
std::string source_of_bounds(const Experiment& experiment, const RecommendOptions& options) {
  const CurveOptions usual;
  std::vector<std::string> sources;
  if (options.acne || options.peter_panning || options.edges || options.patch) sources.emplace_back("the options");
  if (experiment.curve.acne_bound != usual.acne_bound ||
      experiment.curve.peter_panning_bound != usual.peter_panning_bound ||
      std::any_of(experiment.bounds.begin(), experiment.bounds.end(), is_eye_bound))
    sources.push_back(printable(experiment.path));
  return sources.empty() ? "the defaults of recommend" : fmt::format("{}", fmt::join(sources, ", then "));
}

// --cascades: beside one map, several counts of them.
void add_cascades(AdviceRequest& request, const Experiment& experiment, std::span<const std::string> engines,
                  Workbench& bench, const std::function<void(const std::string&)>& say) {
  const std::string given = gives(experiment, "cascades.count") ? "cascades.count" : given_place(experiment);
  if (!given.empty())
    throw Error(ErrorKind::usage,
                fmt::format("--cascades lays the maps itself, and {} is given too; leave one of them out", given));
  if (request.conditions.front().cascades.depths != CascadeDepths::planes)
    throw SettingConflict("cascades.depths",
                          "--cascades searches ends that are numbers, the same in every view; leave "
                          "cascades.depths = visible out, or leave out --cascades and give cascades.count");
  CascadePlaces cascades = cascade_places(bench, request.conditions, cascade_counts, engines, request.width_px, say);
  if (cascades.places.empty())
    throw Error(ErrorKind::usage, fmt::format("--cascades: {}; leave it out", cascades.why_not));
  for (MapPlace& place : cascades.places) request.places.push_back(std::move(place));
}

// --lookups: beside lookups that compare, or in their place, filtered maps.
void add_lookups(AdviceRequest& request, const Experiment& experiment, const std::vector<std::string>& lookups) {
  for (auto one = lookups.begin(); one != lookups.end(); ++one)
    if (std::find(lookups.begin(), one, *one) != one)
      throw Error(ErrorKind::usage, fmt::format("--lookups names '{}' twice; name each lookup once", *one));
  for (const char* group : {"lookup.", "bias.", "map.moments", "filter."})
    if (gives(experiment, group))
      throw Error(
          ErrorKind::usage,
          fmt::format(
              "--lookups chooses the lookup, its blur and its bias itself, and a setting {} is given; leave one of "
              "them out",
              std::string_view(group).ends_with('.') ? std::string(group) + "*" : group));
  if (request.conditions.front().cascades.count > 1)
    throw Error(ErrorKind::usage, "--lookups is of one map; set cascades.count = 1, or leave it out");
  if (std::find(lookups.begin(), lookups.end(), "compare") == lookups.end()) request.levels.clear();
  for (BiasLevel& level : filtered_levels(lookups, searched_bounds(request.curve))) {
    if (kind_of_light(request.light).map_shape() == MapShape::cube)
      throw Error(ErrorKind::usage,
                  fmt::format("--lookups {}: a point light's cube map has lookup.kind = compare alone; leave it out",
                              level.lookup));
    request.levels.push_back(std::move(level));
  }
}

// --for and --engine.
std::vector<WantedEngine> wanted_engines(const RecommendOptions& options) {
  std::vector<WantedEngine> wanted;
  const auto add = [&](std::string engine, bool is_run) {
    const auto same = [&](const WantedEngine& one) { return one.engine == engine; };
    if (std::none_of(wanted.begin(), wanted.end(), same)) wanted.push_back({std::move(engine), is_run});
  };
  for (const std::string& word : options.held_in) add(engine_of_word(word), false);
  for (const std::string& name : options.engines) add(std::string(engine_adapter(name).engine), true);
  return wanted;
}

// What is searched: the conditions, the settings to try, and the bounds.
AdviceRequest request_of(const Experiment& experiment, const RecommendOptions& options, Workbench& bench,
                         const std::function<void(const std::string&)>& say) {
  AdviceRequest request;
  request.conditions = conditions_of(experiment);
  for (const Settings& condition : request.conditions)
    if (!compares(condition))
      throw SettingConflict(
          "lookup.kind",
          fmt::format("recommend chooses the lookup: leave lookup.kind = {} out, and name it with --lookups",
                      condition.lookup.kind));
  const Settings first = request.conditions.front();
  const Scene& scene = bench.scene(first.scene);
  if (request.conditions.size() == 1 && options.views > 1) {
    request.conditions = turned_views(first, scene);
    request.conditions.resize(std::min(request.conditions.size(), static_cast<size_t>(options.views)));
  }
  const bool turned = request.conditions.size() > 1 && conditions_of(experiment).size() == 1;
  request.places = places_of(experiment, request, scene, turned ? views_between(first, scene) : request.conditions);
  const LightKind light = make_light_frame(scene, request.conditions.front()).kind;
  if (!gives(experiment, "bias.")) request.levels = bias_levels();
  request.filters = filters_to_try(light);
  for (int resolution = 256; resolution <= 8192; resolution *= 2) request.resolutions.push_back(resolution);
  request.light = light;
  request.between = light == LightKind::directional && !gives(experiment, "map.resolution");
  take_choices(request, experiment);
  request.width_px = searched_width_px(bench, request.conditions.front());
  request.curve = experiment.curve;
  if (options.acne) request.curve.acne_bound = *options.acne;
  if (options.peter_panning) request.curve.peter_panning_bound = *options.peter_panning;
  if (!options.lookups.empty()) add_lookups(request, experiment, options.lookups);
  if (options.cascades) {
    std::vector<std::string> engines;
    for (const WantedEngine& one : wanted_engines(options)) engines.push_back(one.engine);
    add_cascades(request, experiment, engines, bench, say);
  }
  request.eye = eye_bounds(experiment, options);
  request.accuracy = experiment.accuracy;
  request.error = options.error;
  request.budget = options.budget;
  request.about = about_text(experiment, request.conditions, scene);
  request.given = given_text(experiment, request);
  request.source_of_bounds = source_of_bounds(experiment, options);
  request.answer = options.answer.value_or(options.budget ? AnswerKind::best : AnswerKind::least);
  return request;
}

// The lines of an engine lay a square map along the light's own axes. Empty: so do the settings.
std::string why_no_engine_lines(std::span<const Settings> conditions) {
  for (const Settings& condition : conditions)
    for (const char* name : {"map.aspect", "map.roll_deg"})
      if (const Setting& row = find_setting(name); row.get(condition) != row.get(Settings()))
        return fmt::format(
            "no engine's lines can be given with {} = {}: they lay a square map along the light's own axes", name,
            row.get(condition));
  return "";
}

// The engines whose lines are printed. Without a wish it is the first of those that have the lookup of an engine, or of all.
std::vector<std::string> shown_engines(const RecommendOptions& options, const std::optional<TrialPlan>& plan,
                                       const std::vector<EngineAdvice>& engines) {
  std::vector<std::string> words;
  if (plan) words = plan->names;
  for (const std::string& word : options.held_in)
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  if (options.lines) words.push_back(*options.lines);
  const auto with_lines =
      std::find_if(engines.begin(), engines.end(), [](const EngineAdvice& engine) { return !engine.lines.empty(); });
  if (words.empty())
    words.push_back(with_lines == engines.end() ? engine_words().front() : engine_word(with_lines->engine));
  return words;
}

int recommend(const RecommendOptions& options) {
  const std::string& what = options.what;
  ExperimentArguments arguments = options.arguments;
  if (!is_experiment(what)) take_scene(arguments, what);
  const Experiment whole = experiment_from(is_experiment(what) ? what : "", arguments);
  const std::string out = arguments.out.empty() ? folder_of_advice(what) : arguments.out;
  if (options.texels && (options.acne || options.peter_panning || options.error || options.budget || options.edges ||
                         options.patch || options.answer || options.lines || options.cascades ||
                         !options.lookups.empty() || !options.engines.empty() || !options.held_in.empty()))
    throw Error(
        ErrorKind::usage,
        "--texels divides texels and searches nothing else; leave out the bounds, --budget, --answer, --cascades, "
        "--lookups, --lines, --for and --engine");
  if (options.texels) return recommend_texels(whole, *options.texels, arguments, out);
  // Before anything is measured.
  if (!options.lookups.empty() && options.cascades)
    throw Error(ErrorKind::usage, "--lookups searches one map; leave out --lookups or --cascades");
  const Experiment& experiment = only_part(whole);
  require_room_to_start(true);
  Workbench bench(gl::DebugMode::log);
  Progress progress(arguments.quiet);  // shows no remaining time, because each result decides what is tried next
  const auto say = [&](const std::string& step) { progress.say(printable(step)); };
  AdviceRequest request = request_of(experiment, options, bench, say);
  if (arguments.out.empty()) require_own_advice(out, subject_of(request.conditions.front()));
  const std::string no_lines = why_no_engine_lines(request.conditions);
  if (!no_lines.empty() && (options.lines || !options.engines.empty() || !options.held_in.empty()))
    throw Error(ErrorKind::usage, fmt::format("{}; leave it out, or leave out --lines, --for and --engine", no_lines));
  std::optional<TrialPlan> plan;
  if (!options.engines.empty()) {
    plan = plan_trial(bench, request.conditions, options.engines, options.adapters);
  }
  const std::vector<WantedEngine> wanted = wanted_engines(options);
  for (const WantedEngine& one : wanted)
    if (!one.is_run) request.held_in.push_back(one.engine);
  if (const std::string never = why_never_in_engines(bench, wanted, request.conditions.front()); !never.empty())
    throw Error(ErrorKind::usage,
                fmt::format("--for and --engine: {}; choose another engine, or change cascades.count", never));
  if (!wanted.empty())
    request.elsewhere = [&](const Tried& tried) { return in_engines(bench, wanted, tried, request); };

  OutputFolder folder(outputs_of("recommend", options.what, out));
  folder.make();
  Advice advice = search(bench, request, say);
  std::vector<EngineAdvice> engines;
  if (advice.answer() && no_lines.empty()) engines = measured_engines(bench, advice.answer()->tried, request, say);
  progress.end_line();
  const auto write_with_engines = [&] {
    write_file_atomically(out + "/recommended.json", advice_json(advice, engines));
    if (advice.answer() && no_lines.empty()) write_file_atomically(out + "/engines.txt", advice_engines(engines));
  };
  write_with_engines();
  if (!arguments.json)
    for (const std::string& line : advice_text(advice)) fmt::print("{}\n", printable(line));
  for (const Answer& answer : advice.answers) {
    const std::string stem =
        &answer == advice.answer() ? "recommended" : "recommended-" + answer_name(answer.kinds.front());
    write_file_atomically(out + "/" + stem + ".toml", advice_experiment(answer, advice, out));
    // Pictures show no metric, so none that costs a pass is computed.
    write_pictures(bench.measure(answer.tried.settings, std::nullopt, MetricSet::searched), out, ".", stem);
  }
  if (advice.answer()) write_file_atomically(out + "/recommended.txt", whole_text(advice));
  // The whole answer is written, so that it stays whatever happens in an engine.
  if (advice.answer() && plan) {
    std::fflush(stdout);
    for (Settings& view : plan->views) request.places[advice.answer()->tried.place].apply(view);
    try_engines(bench, *plan, engines, {request.curve, request.error, request.accuracy}, out, say);
    progress.end_line();
    write_with_engines();
  }
  if (arguments.json) fmt::print("{}", advice_json(advice, engines));
  if (!advice.answer()) return 1;
  if (!arguments.json) print_advice(advice, engines, shown_engines(options, plan, engines), no_lines, bench, out);
  require_frames(engines);
  return broken_in_engine(engines) ? 1 : 0;
}

// Of the search: the bounds, what the answer is to be, and the views.
void add_search_options(CLI::App& verb, RecommendOptions& options) {
  const CurveOptions bounds;  // of a scene, and of an experiment whose [curve] gives none
  const auto add_most = [&](std::optional<double>& most, const char* name, const char* help, const std::string& unset) {
    verb.add_option(name, most, help)->transform(as_share())->type_name(value_kind::share)->default_str(unset);
  };
  add_most(options.acne, "--acne", "The most acne, as a share of the counted receivers: 0.001 or 0.1%",
           percent_text(bounds.acne_bound) + ", or acne_bound of the experiment's [curve]");
  add_most(options.peter_panning, "--peter-panning", "The most Peter Panning",
           percent_text(bounds.peter_panning_bound) + ", or peter_panning_bound of the experiment's [curve]");
  add_most(options.error, "--error", "The most error", "no bound");
  verb.add_option("--budget", options.budget,
                  "The most texels written and texture instructions a frame (the metric texel_work) that an answer may "
                  "cost")
      ->check(above_zero())
      ->type_name(value_kind::number)
      ->default_str(fmt::format("{} times the cost of the cheapest answer", budget_of_least));
  verb.add_option(
          "--texels", options.texels,
          "Divide this many texels among the lights of the scene, so that the error of the frame that they make "
          "is least; nothing else is searched")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->type_name(value_kind::number);
  verb.add_option("--edges", options.edges,
                  "The most that 95% of the pixels at shadow edges lie off, in pixels of the picture at the given view")
      ->check(above_zero())
      ->type_name(value_kind::number)
      ->default_str(fmt::format("{}, or a bound of the experiment on {}", most_edge_pixels, edge_metric));
  add_most(options.patch, "--patch", "The largest patch of wrong pixels, as a share of the picture at the given view",
           fmt::format("{}, or a bound of the experiment on {}", percent_text(most_wrong_patch), patch_metric));
  std::vector<std::string> kinds;
  for (AnswerKind kind : answer_kinds) kinds.push_back(answer_name(kind));
  verb.add_option_function<std::string>(
          "--answer",
          [&options, kinds](const std::string& word) {
            options.answer = answer_kinds[std::find(kinds.begin(), kinds.end(), word) - kinds.begin()];
          },
          fmt::format("The answer to print the lines of: least, the cheapest that holds all bounds; balanced, the most "
                      "accurate one whose error no cheaper one comes within {} times of; best, the most accurate one "
                      "within --budget",
                      error_that_pays))
      ->check(one_of(kinds))
      ->type_name(joined(kinds))
      ->default_str("least, and best with --budget");
  verb.add_option("--views", options.views,
                  "Number of views without an [over]: the view that is given, and up to 4 turned ones")
      ->check(whole_number(1, 5))
      ->capture_default_str();
}

RunVerb add_recommend(CLI::App& verb) {
  const auto options = std::make_shared<RecommendOptions>();
  ExperimentArguments& arguments = options->arguments;
  verb.add_option("what", options->what,
                  "A built-in scene, the path of a .gltf, .glb or .vrm file, or an experiment whose [over] gives the "
                  "conditions")
      ->required()
      ->check(not_empty())
      ->type_name(std::string(value_kind::scene) + "|" + value_kind::experiment);
  add_sets(verb, arguments);
  add_search_options(verb, *options);
  verb.add_option("--part", arguments.parts, "The part of the experiment to answer for, if it has parts")
      ->expected(1)
      ->type_name(value_kind::part);
  verb.add_flag(
      "--cascades", options->cascades,
      fmt::format("Beside one map, also try {} cascades that reach to map.reach_m, or as far as the views show, "
                  "with practical splits and a bias in texels",
                  fmt::join(cascade_counts, ", ")));
  verb.add_option(
          "--lookups", options->lookups,
          "Also try filtered maps: lookups to choose among, compare and others (repeatable; or a list with commas)")
      ->take_all()
      ->expected(1)
      ->check(list_of(searched_lookups()))
      ->type_name(joined(searched_lookups()))
      ->default_str("compare");
  std::vector<std::string> names;
  for (const EngineAdapter& adapter : engine_adapters()) names.emplace_back(adapter.name);
  verb.add_option("--engine", options->engines,
                  "Also run the lines in this engine, in headless Chromium, and judge its own frames in each view "
                  "(repeatable; or a list with commas)")
      ->expected(1)
      ->take_all()
      ->delimiter(',')
      ->type_name(joined(names));
  const std::vector<std::string> words = engine_words();
  verb.add_option("--lines", options->lines, "The engine whose lines are printed; engines.txt has those of all")
      ->check(one_of(words))
      ->type_name(joined(words))
      ->default_str(fmt::format("those of --for and --engine, otherwise {}", words.front()));
  verb.add_option(
          "--for", options->held_in,
          "Search settings whose lines keep the bounds in this engine too, as far as Noonmark can measure what it "
          "does with them (repeatable; or a list with commas)")
      ->take_all()
      ->expected(1)
      ->check(list_of(words))
      ->type_name(joined(words));
  verb.add_option("--adapters", options->adapters,
                  "Folder of the pages that --engine runs (examples/engines); without it that of this program")
      ->check(not_empty())
      ->type_name(value_kind::folder);
  add_json(verb, arguments, "Print everything that was found as JSON");
  add_threads(verb, arguments);
  add_out(verb, arguments, "Folder for the files",
          folders_of({"plate", "checks/helmet.toml"}, [](const std::string& what) { return folder_of_advice(what); }));
  return [options](const std::string& command) {
    options->arguments.command = command;
    options->lookups = words_of(options->lookups);
    options->engines = words_of(options->engines);
    options->held_in = words_of(options->held_in);
    const ThreadLimit limit(options->arguments.threads);
    return recommend(*options);
  };
}

}  // namespace

Verb verb_recommend() {
  return {"recommend",
          "Search the cheapest settings that hold the bounds in every view and at every placement of the grid",
          add_recommend};
}

}  // namespace noonmark
