#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

#include "app/definition/experiment.h"
#include "app/definition/share_text.h"
#include "app/sweep/retract.h"
#include "app/verbs/command_line_error.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/failure.h"
#include "base/terminal.h"
#include "base/text.h"
#include "base/threads.h"
#include "measure/phase_diagram.h"
#include "technique/placements.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 done, all held; 1 a bound or a law is broken, or a value is worse than in the baseline;\n"
    "otherwise what has to change:\n"
    "2 the command line or the experiment (wrong usage; a point too large for memory; a results' folder that\n"
    "  cannot be used); 3 a file (a bad scene or picture, or one too large for memory; damaged results; a full disk);\n"
    "4 the machine (no usable OpenGL, ray tracer or picture library, no memory, threads or open files left);\n"
    "5 Noonmark: a defect; 6 nothing: the sweep is incomplete. Of several experiments, the largest code is returned.";

std::string joined(int argc, char** argv) {
  std::string command = "noonmark";
  for (int i = 1; i < argc; ++i) command += " " + shell_quoted(argv[i]);
  return command;
}

// For CLI::Option::check: returns the mistake in the text, or an empty string.
auto whole_number(long least, long most, const char* range) {
  return [=](const std::string& text) -> std::string {
    long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && value >= least && value <= most) return "";
    return fmt::format("'{}' is not a whole number {}", text, range);
  };
}

template <class Holds>
auto number(const char* range, Holds holds) {
  return [=](const std::string& text) -> std::string {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && holds(value)) return "";
    return fmt::format("'{}' is not a number {}", text, range);
  };
}
// For CLI::Option::transform: a share as "0.005" or "0.5%" becomes its number.
const auto as_share = CLI::Validator(
    [](std::string& text) -> std::string {
      const std::optional<double> value = share_from(text);
      if (!value || *value < 0)
        return fmt::format("'{}' is not a share: a number from 0 to 1, or a percentage such as 0.5%", text);
      if (*value > 1) return above_every_share(*value, text);
      text = fmt::format("{}", *value);
      return "";
    },
    "");
const auto above_zero = number("above 0", [](double value) { return value > 0 && std::isfinite(value); });

std::string not_empty(const std::string& path) { return path.empty() ? "the path is empty" : ""; }

// What was asked for, help or the version. CLI11 writes to C++ streams; this writes its text through stdio, like all other
// output.
int say(const CLI::App& app, const CLI::Success& asked) {
  std::ostringstream output, errors;
  const int exit_code = app.exit(asked, output, errors);
  std::fputs(output.str().c_str(), stdout);
  return exit_code;
}

// The terminate handler. A library may stop an exception on its way, and then main cannot catch it. If memory or
// threads have run out, this handler prints one line and ends the program with the exit code of the machine. Any other
// exception ends the program as usual.
[[noreturn]] void give_up() {
  try {
    if (const std::exception_ptr exception = std::current_exception()) std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
  } catch (const std::system_error&) {
  } catch (...) {
    std::abort();
  }
  write_to_terminal("noonmark: a library ended the program; most likely memory or threads have run out\n");
  std::_Exit(static_cast<int>(ErrorKind::device));
}

// Without arguments: what to do first. It is an error, because nothing was asked for.
int first_steps() {
  std::fputs(
      "noonmark: no verb is given. First steps with a model of your own:\n"
      "  noonmark init MODEL.glb            writes MODEL.toml, a first experiment (inspect MODEL.glb shows the model)\n"
      "  noonmark recommend MODEL.toml      searches the settings to use, and writes them for other engines too\n"
      "  noonmark check out/recommend-MODEL/recommended.toml   judges them; the report shows every wrong pixel\n"
      "noonmark --help lists all verbs.\n",
      stderr);
  return static_cast<int>(ErrorKind::usage);
}

// Needed because CLI11 would first report a missing verb.
void refuse_unknown(const std::string& first, const std::vector<std::string_view>& verbs) {
  const std::vector<std::string_view> options = {"--help", "--version"};
  const bool option = first.starts_with('-');
  const std::vector<std::string_view>& known = option ? options : verbs;
  if (first == "-h" || std::find(known.begin(), known.end(), first) != known.end()) return;
  const std::string near = nearest_name(first, known);
  throw Error(ErrorKind::usage,
              fmt::format("there is no {} '{}'{}{} (noonmark --help lists them)", option ? "option" : "verb", first,
                          option ? " before the verb" : "", near.empty() ? "" : "; did you mean '" + near + "'?"));
}

// The share that is to be measured: that of --shard, else that of the task of a Slurm array. 1/1 is no share.
std::optional<Shard> asked_shard(const std::string& option) {
  std::optional<Shard> shard;
  if (!option.empty())
    shard = shard_from(option);
  else if ((shard = slurm_shard()))
    fmt::print(stderr,
               "note: this is a task of a Slurm array, so --shard {} is taken; --shard 1/1 measures all points\n",
               shard->text());
  if (shard && shard->of == 1) shard.reset();
  return shard;
}

void require_one_output(const ExperimentArguments& arguments, bool dry_run) {
  if (arguments.json + arguments.print_config + dry_run > 1)
    throw Error(ErrorKind::usage, "--json, --print-config and --dry-run each print something else; give one of them");
}

int run(int argc, char** argv) {
  CLI::App app(
      "Noonmark measures whether a shadow map is right. It renders a scene's shadows with OpenGL shadow maps\n"
      "and with Embree shadow rays, and reports for every wrong pixel why it is wrong.");
  app.footer(exit_codes);
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       std::string(build_facts().version) + " (" + std::string(build_facts().commit) + ")");

  ExperimentArguments arguments;
  arguments.command = joined(argc, argv);
  std::string experiment, folder, picture, scene;
  std::vector<std::string> paths;
  bool dry_run = false;
  long point = -1;
  const auto with_set = [&](CLI::App* verb) {
    verb->add_option("--set", arguments.sets,
                     "Override a setting: name=value (noonmark settings lists them). May be repeated")
        ->expected(1)
        ->take_all()
        ->type_name("NAME=VALUE");
  };
  const auto with_choices = [&](CLI::App* verb) {
    with_set(verb);
    verb->add_option(
            "--part", arguments.parts,
            "Measure only the part of the experiment with this name; points are counted from 0. May be repeated")
        ->expected(1)
        ->take_all()
        ->type_name("NAME");
    verb->add_option("--threads", arguments.threads,
                     "Number of threads (default: one for each core); no result depends on it")
        ->check(whole_number(1, 1024, "from 1 to 1024"));
    verb->footer(exit_codes);
  };
  const auto with_out = [&](CLI::App* verb, const char* what) {
    verb->add_option("--out", arguments.out, what)->check(not_empty)->type_name("FOLDER");
  };
  const auto with_overwrite = [&](CLI::App* verb) {
    verb->add_flag("--overwrite", arguments.overwrite,
                   "Measure everything anew and replace the results in the folder; without it, points that are there "
                   "already are kept");
  };

  CLI::App* run = app.add_subcommand("run", "Measure every point of an experiment and write its report");
  run->add_option("experiment", experiment, "The experiment's TOML file")->required()->check(not_empty);
  with_choices(run);
  with_out(
      run,
      "Folder for the results (default: out/shadows for shadows.toml, out/checks/shadows for checks/shadows.toml)");
  with_overwrite(run);
  std::string shard;
  const auto with_shard = [&](CLI::App* verb) {
    verb->add_option(
            "--shard", shard,
            "Measure only share I of N, into the subfolder share-I-of-N of the results' folder, and judge nothing: "
            "noonmark merge joins the shares. In a task of a Slurm array the task's numbers are the default; 1/1 "
            "measures all")
        ->check(not_empty)
        ->type_name("I/N");
  };
  with_shard(run);
  run->add_flag("--dry-run", dry_run, "Only print the points, the memory that each takes, and an estimate of the time");

  const auto with_json = [&](CLI::App* verb, const char* what) {
    verb->add_flag("--json", arguments.json, what);
    verb->add_flag("--quiet", arguments.quiet, "Print no progress; notes, warnings and errors stay");
  };
  const auto with_output = [&](CLI::App* verb) {
    with_json(verb, "Print the results as JSON: verdict, bounds, laws, answer and every point");
    verb->add_flag("--print-config", arguments.print_config,
                   "Only print the experiment as a file with every default written out");
  };
  with_output(run);

  CLI::App* check =
      app.add_subcommand("check", "Run experiments and judge their bounds and laws: the exit code is the verdict");
  check->add_option("experiments", paths, "TOML files, or folders of them")->required()->check(not_empty);
  with_choices(check);
  with_out(
      check,
      "Folder for the results (default: out/shadows for shadows.toml, out/checks/shadows for checks/shadows.toml); "
      "several "
      "experiments get a subfolder each");
  with_overwrite(check);
  with_shard(check);
  CheckOptions checking;
  check->add_flag("--dry-run", checking.dry_run,
                  "Only print each experiment's points, the memory that each takes, and an estimate of the time");
  with_output(check);
  check
      ->add_option("--baseline", checking.baseline.file,
                   "Compare the values that bounds and [plot] name with this file: exit code 1 if one is worse")
      ->check(not_empty)
      ->type_name("FILE");
  check->add_flag("--update-baseline", checking.baseline.update,
                  "Write the values of this run to the baseline, instead of comparing with it");
  check
      ->add_option("--baseline-times", checking.baseline.times,
                   "Keep and compare times too: a time may differ by this share of the time before (0.2 or 20%)")
      ->transform(as_share)
      ->type_name("SHARE");

  CLI::App* render =
      app.add_subcommand("render", "Measure one point and write its pictures, its ladder and all numbers behind it");
  render->add_option("experiment", experiment, "The experiment's TOML file; without one, the default settings")
      ->check(not_empty);
  render->add_option("--point", point, "Number of the point in the experiment's sweep, from 0")
      ->check(whole_number(0, std::numeric_limits<long>::max(), "from 0 on"));
  render
      ->add_option(
          "--picture", picture,
          "Judge this picture in place of the shadow map's: an EXR or PNG file of the view's size, the top row "
          "first; one grey channel, linear, from 0 (shadowed) to 1 (lit); one sample at each pixel's centre, "
          "without antialiasing, jitter and tone mapping")
      ->check(not_empty)
      ->type_name("FILE");
  with_choices(render);
  with_out(render, "Folder for the files (default: out/render)");

  PhaseOptions phase;
  CLI::App* map = app.add_subcommand(
      "map", "Draw a scene's phase diagram: which texel sizes and biases are usable, and what is wrong elsewhere");
  map->add_option("scene", scene, "A built-in scene, or the path of a .gltf or .glb file")
      ->required()
      ->check(not_empty);
  with_set(map);
  const auto share = [](double& to, const char* name, const char* what, CLI::App* verb) {
    verb->add_option(name, to, what)->transform(as_share)->type_name("SHARE");
  };
  share(phase.acne_bound, "--acne",
        "The most acne of a usable pair, as a share of the counted receivers: 0.001 or 0.1% (default: 0.1%)", map);
  share(phase.peter_panning_bound, "--peter-panning", "The most Peter Panning of a usable pair (default: 0.1%)", map);
  map->add_option("--from", phase.coarsest, "The coarsest texels: resolution at the present extent (default: 128)")
      ->check(whole_number(4, 16384, "from 4 to 16384"));
  map->add_option("--to", phase.finest, "The finest texels (default: 8192)")
      ->check(whole_number(4, 16384, "from 4 to 16384"));
  map->add_option("--rows", phase.rows, "Number of texel sizes (default: 25)")
      ->check(whole_number(2, 200, "from 2 to 200"));
  map->add_option("--placements", phase.placements,
                  "S: each texel size is measured at S x S placements of its grid (default: 8)")
      ->check(whole_number(1, Placements::most, "from 1 to 64"));
  map->add_option("--threads", arguments.threads,
                  "Number of threads (default: one for each core); no result depends on it")
      ->check(whole_number(1, 1024, "from 1 to 1024"));
  with_json(map, "Print the usable biases of each texel size as JSON");
  map->footer(exit_codes);
  with_out(
      map,
      "Folder for the files (default: out/map-<name of the scene>, or out/checks/map-helmet for checks/helmet.glb)");

  RecommendOptions recommending;
  CLI::App* recommend = app.add_subcommand(
      "recommend",
      "Search the cheapest settings that hold the bounds in every view and at every placement of the grid");
  recommend
      ->add_option(
          "what", scene,
          "A built-in scene, the path of a .gltf or .glb file, or an experiment whose [over] gives the conditions")
      ->required()
      ->check(not_empty);
  with_set(recommend);
  const auto limit_of = [&](std::optional<double>& to, const char* name, const char* help) {
    recommend->add_option(name, to, help)->transform(as_share)->type_name("SHARE");
  };
  limit_of(recommending.acne, "--acne",
           "The most acne, as a share of the counted receivers: 0.001 or 0.1% (default: 0.1%)");
  limit_of(recommending.peter_panning, "--peter-panning", "The most Peter Panning (default: 0.1%)");
  limit_of(
      recommending.error, "--error",
      "The most error (default: what pays: the least product of cost and error). The cheapest settings are sought");
  recommend
      ->add_option(
          "--budget", recommending.budget,
          "The most texels written and texture instructions a frame (the metric texel_work). The most accurate "
          "settings are sought")
      ->check(above_zero)
      ->type_name("NUMBER");
  recommend
      ->add_option("--views", recommending.views,
                   "Without an [over]: the view that is given, and up to 4 turned ones (default: 5 views)")
      ->check(whole_number(1, 5, "from 1 to 5"));
  recommend->add_option("--part", arguments.parts, "The part of the experiment to answer for, if it has parts")
      ->expected(1)
      ->type_name("NAME");
  recommend->add_flag(
      "--around", recommending.around,
      "Also measure what each setting does around the answer: the error at its half and its double, and the "
      "range in which the bounds hold");
  with_json(recommend, "Print everything that was found as JSON");
  recommend
      ->add_option("--threads", arguments.threads,
                   "Number of threads (default: one for each core); no result depends on it")
      ->check(whole_number(1, 1024, "from 1 to 1024"));
  recommend->footer(exit_codes);
  with_out(
      recommend,
      "Folder for the files (default: out/recommend-<name>, or out/checks/recommend-helmet for checks/helmet.toml)");

  std::string model;
  const auto with_model = [&](CLI::App* verb) {
    verb->add_option("model", model, "The path of a .gltf or .glb file")->required()->check(not_empty);
    verb->footer(exit_codes);
  };
  CLI::App* init = app.add_subcommand("init", "Write a first experiment for a model of your own, ready to run");
  with_model(init);
  init->add_option("--out", arguments.out, "The experiment's file (default: <name of the model>.toml in this folder)")
      ->check(not_empty)
      ->type_name("FILE");
  init->add_flag("--overwrite", arguments.overwrite, "Replace the file if it is there already");

  CLI::App* inspect = app.add_subcommand(
      "inspect", "Say what a model holds, how large it is and what is not modelled, and draw it with its shadow");
  with_model(inspect);
  with_json(inspect, "Print the same as JSON");
  with_set(inspect);
  with_out(inspect,
           "Folder for the picture (default: out/inspect-<name>, or out/checks/inspect-helmet for checks/helmet.glb)");

  CLI::App* report = app.add_subcommand("report", "Write report.html and results.csv again from stored results");
  report->add_option("folder", folder, "The results' folder")->required()->check(not_empty);

  MergeOptions merging;
  CLI::App* merge = app.add_subcommand(
      "merge", "Join the results of an experiment's shares (--shard) and judge the whole, as check does");
  merge->add_option("out", merging.out, "Folder for the joined results")->required()->check(not_empty);
  merge->add_option("shares", merging.shares, "The shares' folders (OUT/share-*)")->check(not_empty);
  merge->add_flag("--overwrite", merging.overwrite, "Replace results that were measured in the folder, not joined");
  merge->add_flag("--json", merging.json, "Print the results as JSON: verdict, bounds, laws, answer and every point");
  merge->footer(exit_codes);

  CLI::App* scenes = app.add_subcommand("scenes", "List the built-in scenes and the artefacts that each provokes");
  CLI::App* settings =
      app.add_subcommand("settings", "List every setting, metric and quantity: unit, range, default, meaning");
  CLI::App* schema = app.add_subcommand(
      "schema", "Print the JSON schema of the experiment file, with which editors complete and check it");
  CLI::App* doctor =
      app.add_subcommand("doctor", "Print which OpenGL, ray tracer and libraries are used, or what is missing");

  std::vector<std::string_view> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  const auto retract = [&](const Failure& failure) {
    retract_verdicts(meant_folders(words, verbs), failure, arguments.command);
  };
  try {
    if (argc < 2) return first_steps();
    refuse_unknown(argv[1], verbs);
    refuse_empty_values(words);
    app.parse(argc, argv);
    require_one_output(arguments, dry_run || checking.dry_run);
    std::optional<ThreadLimit> limit;
    if (*run || *check || *render || *map || *recommend || *inspect) limit.emplace(arguments.threads);
    if (*run || *check) arguments.shard = asked_shard(shard);
    if (*run) return verb_run(experiment, arguments, dry_run);
    if (*check) return verb_check(paths, arguments, checking);
    if (*render) return verb_render(experiment, point, picture, arguments);
    if (*map) return verb_map(scene, phase, arguments);
    if (*recommend) return verb_recommend(scene, recommending, arguments);
    if (*init) return verb_init(model, arguments);
    if (*inspect) return verb_inspect(model, arguments);
    if (*report) return verb_report(folder);
    if (*merge) {
      merging.command = arguments.command;
      return verb_merge(merging);
    }
    if (*scenes) return verb_scenes();
    if (*settings) return verb_settings();
    if (*schema) return verb_schema();
    if (*doctor) return verb_doctor();
    return static_cast<int>(ErrorKind::usage);
  } catch (const CLI::Success& asked) {
    return say(app, asked);
  } catch (const CLI::ParseError& error) {
    const Failure failure{static_cast<int>(ErrorKind::usage), printable(command_line_error(app, error))};
    retract(failure);
    return tell(failure);
  } catch (...) {
    retract(current_failure());
    throw;
  }
}

}  // namespace
}  // namespace noonmark

int main(int argc, char** argv) {
  using namespace noonmark;
  const Terminal terminal;
  std::set_terminate(give_up);
  int exit_code = 0;
  try {
    exit_code = run(argc, argv);
  } catch (...) {
    exit_code = tell(current_failure());
  }
  if (const int error = terminal.lost(); error != 0) {
    tell({static_cast<int>(ErrorKind::file),
          fmt::format("standard output cannot be written: {}; its text is lost, but the files are written",
                      std::strerror(error))});
    exit_code = std::max(exit_code, static_cast<int>(ErrorKind::file));
  }
  return exit_code;
}
