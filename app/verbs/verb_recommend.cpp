#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>

#include "app/advise/answer_engines.h"
#include "app/advise/cascade_places.h"
#include "app/advise/engine_trial.h"
#include "app/advise/recommend_filtered.h"
#include "app/advise/recommend_request.h"
#include "app/advise/recommend_text.h"
#include "app/advise/texel_budget.h"
#include "app/definition/default_folder.h"
#include "app/pictures/pictures.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/shell_words.h"
#include "base/text.h"
#include "base/threads.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// Without --out the folder is named after the file or the scene alone. An answer for another scene of that name stays.
void require_own(const std::string& folder, const char* name, const char* what, const std::string& subject) {
  constexpr uint64_t most_bytes = 1 << 28;
  const std::string file = folder + "/" + name;
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return;
  if (const std::string other = subject_in(read_file(file, most_bytes)); other != subject)
    throw Error(ErrorKind::usage, other.empty()
                                      ? fmt::format("{}: is no file of noonmark; give --out, or remove it", file)
                                      : fmt::format("{}: holds {} for another scene ({}); give --out, or remove it",
                                                    folder, what, other));
}

// The lights of a frame, each with its settings, in a picture that is quick to measure.
std::vector<std::pair<std::string, Settings>> lights_of(const Experiment& experiment) {
  constexpr int most_width_px = 480;
  const std::vector<Settings> all = points(experiment);
  if (all.size() != experiment.parts.size())
    throw Error(ErrorKind::usage,
                "--texels divides the texels of one frame, and the experiment sweeps; fix its settings");
  std::vector<std::pair<std::string, Settings>> lights;
  for (size_t i = 0; i < all.size(); ++i) {
    Settings light = all[i];
    if (light.view.width_px > most_width_px) {
      light.view.height_px = std::max(1, light.view.height_px * most_width_px / light.view.width_px);
      light.view.width_px = most_width_px;
    }
    lights.emplace_back(experiment.parts[i].part, std::move(light));
  }
  return lights;
}

// whole: with the lights of one frame as its parts, or without parts: then all lights of its scene. Writes texels.toml and
// texels.json into `out` and prints the answer. Returns the exit code. Throws Error.
int recommend_texels(Experiment whole, int64_t texels, const ExperimentArguments& arguments, const std::string& out) {
  if (whole.parts.empty()) {
    whole.all_lights = true;
    take_all_lights(whole);
  } else if (!whole.lights) {
    throw Error(
        ErrorKind::usage,
        fmt::format("--texels: the parts of {} are not the lights of one frame; write lights = \"parts\"", whole.path));
  }
  const std::vector<std::pair<std::string, Settings>> lights = lights_of(whole);
  if (arguments.out.empty()) require_own(out, "texels.json", "a division of texels", subject_of(lights.front().second));
  OutputFolder folder(outputs_of("texels", "", out));
  Workbench bench(gl::DebugMode::log);
  Progress progress(arguments.quiet);
  const TexelBudget found =
      divide_texels(bench, lights, texels, [&](const std::string& step) { progress.say(printable(step)); });
  progress.end_line();
  folder.make();
  write_file_atomically(out + "/texels.toml", budget_experiment(found, out));
  write_file_atomically(out + "/texels.json", budget_json(found));
  if (arguments.json) {
    fmt::print("{}", budget_json(found));
    return 0;
  }
  for (const std::string& line : budget_text(found)) fmt::print("{}\n", printable(line));
  fmt::print("\n{0}/texels.toml (measure it: noonmark run {0}/texels.toml) and {0}/texels.json are written\n",
             printable(out));
  return 0;
}

// Of recommended.txt: the whole text of an answer, also why what is simpler does not do.
std::string whole_text(const Advice& advice) {
  std::string text;
  for (const auto& lines : {answer_text(advice), reasons_text(advice), rejected_text(advice)})
    for (const std::string& line : lines) text += printable(line) + "\n";
  return text;
}

// The lines of the engines that are shown, what each gave in the engine itself, and where the lines of the others are.
void print_lines(const std::vector<EngineAdvice>& engines, std::span<const std::string> shown, const std::string& out) {
  std::vector<std::string> others;
  for (const EngineAdvice& engine : engines) {
    const std::string word = engine_word(engine.engine);
    if (std::find(shown.begin(), shown.end(), word) == shown.end()) {
      others.push_back(fmt::format("{} ({})", engine.engine, word));
      continue;
    }
    fmt::print("\nWhat to type into {} ({}):\n", engine.engine, engine.version);
    for (const std::string& line : engine_lines(engine)) fmt::print("  {}\n", line);
    for (const std::string& line : trial_text(engine)) fmt::print("{}\n", printable(line));
  }
  if (!others.empty())
    fmt::print("\nLines for {}: {}/engines.txt, or --lines NAME\n", fmt::join(others, ", "), printable(out));
}

// Prints, for each engine in `shown`, the lines to type into it, and the error that the engine itself had with them if it was
// run. Then it prints where the lines of the other engines are, notes about the scenes, and the files that are written.
// shown: names as engine_word() gives them. no_lines: the reason if there are no lines; otherwise empty.
void print_advice(const Advice& advice, const std::vector<EngineAdvice>& engines, std::span<const std::string> shown,
                  const std::string& no_lines, Workbench& bench, const std::string& out) {
  const AdviceRequest& request = advice.request;
  if (no_lines.empty())
    print_lines(engines, shown, out);
  else
    fmt::print("\n{}.\n", printable(no_lines));
  if (const std::string note = notes_line(bench.scene(request.conditions.front().scene)); !note.empty())
    fmt::print("note: {}\n", printable(note));
  std::set<std::string> of_lights;  // conditions may be lights that stand elsewhere
  for (const Settings& condition : request.conditions)
    for (const std::string& note : light_notes(bench.scene(condition.scene), condition)) of_lights.insert(note);
  for (const std::string& note : of_lights) fmt::print("note: {}\n", printable(note));
  fmt::print("Why, and what simpler settings miss: {0}/recommended.txt; pictures: {0}/recommended-*.png\n",
             printable(out));
  for (const Answer& answer : advice.answers)
    if (&answer != advice.answer())
      fmt::print("The answer \"{0}\": {1}/recommended-{0}.toml; --answer {0} makes it the first\n",
                 answer_name(answer.kinds.front()), printable(out));
  fmt::print("Next: noonmark check {}/recommended.toml\n", printable(shell_quoted(out)));
}

constexpr const char* recommend_prefix = "recommend-";  // of the default folder

bool is_experiment(const std::string& path) { return std::filesystem::path(path).extension() == ".toml"; }

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

// A model's file is named after itself alone, as `noonmark init` names its experiment, so that both have one folder.
std::string folder_of_advice(const std::string& what) {
  return default_folder(is_experiment(what) ? what : std::filesystem::path(what).filename().string(), recommend_prefix);
}

struct RecommendOptions : AdviceWishes {
  std::string what;                  // an experiment's *.toml, a built-in scene, or a model's file
  std::optional<int64_t> texels;     // recommend_texels() is asked for
  std::vector<std::string> run_in;   // engine_adapters() to try the lines in
  std::vector<std::string> held_in;  // engine_words() in which the answer must hold
  std::optional<std::string> lines;  // the engine whose lines are printed; empty: the above, otherwise three.js
  std::string adapters;              // their folder; empty: the program's own
  ExperimentArguments arguments;
};

// --for and --engine.
std::vector<WantedEngine> wanted_engines(const RecommendOptions& options) {
  std::vector<WantedEngine> wanted;
  const auto add = [&](std::string engine, bool is_run) {
    const auto same = [&](const WantedEngine& one) { return one.engine == engine; };
    if (std::none_of(wanted.begin(), wanted.end(), same)) wanted.push_back({std::move(engine), is_run});
  };
  for (const std::string& word : options.held_in) add(engine_of_word(word), false);
  for (const std::string& name : options.run_in) add(std::string(engine_adapter(name).engine), true);
  return wanted;
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

// The engines whose lines are asked for.
std::vector<std::string> shown_engines(const RecommendOptions& options, const std::optional<TrialPlan>& plan) {
  std::vector<std::string> words;
  if (plan) words = plan->names;
  for (const std::string& word : options.held_in)
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  if (options.lines) words.push_back(*options.lines);
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
                         !options.lookups.empty() || !options.run_in.empty() || !options.held_in.empty()))
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
  const std::vector<WantedEngine> wanted = wanted_engines(options);
  AdviceWishes wishes = options;
  for (const WantedEngine& one : wanted) wishes.engines.push_back(one.engine);
  AdviceRequest request = request_of(experiment, wishes, bench, say);
  if (arguments.out.empty())
    require_own(out, "recommended.json", "the recommendation", subject_of(request.conditions.front()));
  const std::string no_lines = why_no_engine_lines(request.conditions);
  if (!no_lines.empty() && (options.lines || !options.run_in.empty() || !options.held_in.empty()))
    throw Error(ErrorKind::usage, fmt::format("{}; leave it out, or leave out --lines, --for and --engine", no_lines));
  std::optional<TrialPlan> plan;
  if (!options.run_in.empty()) plan = plan_trial(bench, request.conditions, options.run_in, options.adapters);
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
    for (const std::string& line : answer_text(advice)) fmt::print("{}\n", printable(line));
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
  if (!arguments.json) print_advice(advice, engines, shown_engines(options, plan), no_lines, bench, out);
  require_frames(engines);
  return broken_in_engine(engines) ? 1 : 0;
}

// Of the search: the bounds, what the answer is to be, and the views.
void add_search_options(CLI::App& verb, RecommendOptions& options) {
  const CurveOptions bounds;  // of a scene, and of an experiment whose [curve] gives none
  add_share(verb, "--acne", options.acne, "The most acne, as a share of the counted receivers: 0.001 or 0.1%",
            percent_text(bounds.acne_bound) + ", or acne_bound of the experiment's [curve]");
  add_share(verb, "--peter-panning", options.peter_panning, "The most Peter Panning",
            percent_text(bounds.peter_panning_bound) + ", or peter_panning_bound of the experiment's [curve]");
  add_share(verb, "--error", options.error, "The most error", "no bound");
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
  add_share(verb, "--patch", options.patch,
            "The largest patch of wrong pixels, as a share of the picture at the given view",
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
      ->default_str("least, and best with --budget; if that is fragile, the nearest that is not");
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
  verb.add_option("--engine", options->run_in,
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
      ->default_str("those of --for and --engine");
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
    options->run_in = words_of(options->run_in);
    options->held_in = words_of(options->held_in);
    const ThreadLimit limit(options->arguments.threads);
    return recommend(*options);
  };
}

}  // namespace

Verb verb_recommend() {
  return {"recommend", "Search the cheapest settings that hold the bounds in every view",
          "noonmark recommend model.glb --lines three", add_recommend};
}

}  // namespace noonmark
