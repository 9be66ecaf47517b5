#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>

#include "app/build_facts.h"
#include "app/experiment.h"
#include "app/threads.h"
#include "app/verbs.h"
#include "scenes/error.h"
#include "scenes/settings.h"

namespace noonmark {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 held; 1 a bound or a law is broken; 2 wrong usage or experiment; 3 bad scene or file;\n"
    "4 no usable OpenGL, ray tracer or picture library; 5 a defect of Noonmark; 6 the sweep is incomplete.";

std::string joined(int argc, char** argv) {
  std::string command = "noonmark";
  for (int i = 1; i < argc; ++i) command += " " + shell_quoted(argv[i]);
  return command;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Noonmark says whether a shadow map is right: it renders a scene's shadows with OpenGL shadow maps and,\n"
      "beside them, with Embree shadow rays, and says of every wrong pixel why it is wrong.");
  app.footer(exit_codes);
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       std::string(build_facts().version) + " (" + std::string(build_facts().commit) + ")");

  ExperimentArguments arguments;
  arguments.command = joined(argc, argv);
  std::string experiment, folder;
  std::vector<std::string> paths;
  bool dry_run = false;
  long point = -1;
  const auto with_sets = [&](CLI::App* verb) {
    verb->add_option("--set", arguments.sets,
                     "Override a setting: name=value (noonmark settings lists them). May be repeated")
        ->expected(1)
        ->take_all()
        ->type_name("NAME=VALUE");
    verb->add_option("--threads", arguments.threads,
                     "How many threads to use (default: all cores); no result depends on it")
        ->check(CLI::Range(1, 1024));
    verb->footer(exit_codes);
  };
  const auto with_out = [&](CLI::App* verb, const char* what) {
    verb->add_option("--out", arguments.out, what)->type_name("FOLDER");
  };
  const auto with_overwrite = [&](CLI::App* verb) {
    verb->add_flag("--overwrite", arguments.overwrite,
                   "Measure anew, whatever the results' folder holds; without it a killed sweep resumes");
  };

  CLI::App* run = app.add_subcommand("run", "Measure every point of an experiment and write its report");
  run->add_option("experiment", experiment, "The experiment's TOML file")->required();
  with_sets(run);
  with_out(run, "Where the results go (default: out/<name of the experiment>)");
  with_overwrite(run);
  run->add_flag("--dry-run", dry_run, "Only print the points and an estimate of the time");

  CLI::App* check =
      app.add_subcommand("check", "Run experiments and judge their bounds and laws: the exit code is the verdict");
  check->add_option("experiments", paths, "TOML files, or folders of them")->required();
  with_sets(check);
  with_out(check,
           "Where the results go (default: out/<name of the experiment>); of several experiments, in a folder each");
  with_overwrite(check);

  CLI::App* render = app.add_subcommand("render", "Measure one point: pictures, its ladder, and all numbers behind it");
  render->add_option("experiment", experiment, "The experiment's TOML file; without one, the default settings");
  render->add_option("--point", point, "Which point of the experiment's sweep, counted from 0")
      ->check(CLI::NonNegativeNumber);
  with_sets(render);
  with_out(render, "Where the files go (default: out/render)");

  CLI::App* report = app.add_subcommand("report", "Write report.html and results.csv again from stored results");
  report->add_option("folder", folder, "The results' folder")->required();

  CLI::App* scenes = app.add_subcommand("scenes", "List the built-in scenes and what each provokes");
  CLI::App* settings =
      app.add_subcommand("settings", "List every setting, metric and quantity: unit, range, default, meaning");
  CLI::App* doctor = app.add_subcommand("doctor", "Say which OpenGL, ray tracer and libraries are at work");

  if (argc > 1 && argv[1][0] != '-') {
    std::vector<std::string_view> verbs;
    for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
    if (std::find(verbs.begin(), verbs.end(), argv[1]) == verbs.end()) {
      const std::string near = nearest_name(argv[1], verbs);
      throw Error(ErrorKind::usage, "there is no verb '" + std::string(argv[1]) + "'" +
                                        (near.empty() ? "" : "; did you mean '" + near + "'?") +
                                        " (noonmark --help lists them)");
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return static_cast<int>(ErrorKind::usage);
  }
  const ThreadLimit limit(arguments.threads);
  if (*run) return verb_run(experiment, arguments, dry_run);
  if (*check) return verb_check(paths, arguments);
  if (*render) return verb_render(experiment, point, arguments);
  if (*report) return verb_report(folder);
  if (*scenes) return verb_scenes();
  if (*settings) return verb_settings();
  if (*doctor) return verb_doctor();
  return static_cast<int>(ErrorKind::usage);
}

}  // namespace
}  // namespace noonmark

int main(int argc, char** argv) {
  try {
    return noonmark::run(argc, argv);
  } catch (const noonmark::Error& error) {
    std::fprintf(stderr, "noonmark: %s\n", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    std::fprintf(
        stderr, "noonmark: a defect of ours: %s; please report it with the command and the output of noonmark doctor\n",
        error.what());
    return static_cast<int>(noonmark::ErrorKind::defect);
  }
}
