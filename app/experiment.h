// An experiment: what to measure and what to expect of it, as one TOML file says it.
//
//   Experiment experiment = load_experiment("experiments/cube-room.toml");
//   apply_override(experiment, "map.resolution=2048");            // --set
//   for (const Settings& settings : points(experiment)) measure(settings);
//
// docs/experiment.md is the reference of the file's keys; tests/experiment_docs_test.cpp reads its examples.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/judge/bounds.h"
#include "compare/judge/laws.h"
#include "compare/ladder/bias_curves.h"
#include "scenes/error.h"
#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

struct Swept {
  std::string name;
  std::vector<std::string> values;  // canonical texts, in the file's order, all different
};

struct Experiment {
  std::string path;  // as given
  std::string title;
  Settings base;             // the fixed settings
  std::vector<Swept> swept;  // outermost first
  std::vector<std::string> plot;
  std::vector<Bound> bounds;
  std::vector<std::pair<std::string, std::string>> let;  // definitions for the laws
  std::vector<Law> laws;
  bool curve_enabled = true;
  CurveOptions curve;
  std::string pictures = "first";       // which points get pictures: first | all | none | worst | extremes
  std::vector<std::string> overridden;  // settings given by apply_override, in order
  std::vector<std::string> chosen;      // parts given by choose_parts
  std::string part;                     // its name, where it is a part of another
  // Where each setting was given: "file:line:column", or "--set name=value"; and where [sweep] stands.
  std::map<std::string, std::string> places;
  std::string sweep_place;
  std::vector<Experiment> parts;  // where there are any, the points are theirs, one part after the other
};

// A sweep of more points than this is a mistake in the file, not a plan.
constexpr int64_t max_points = 100000;

// Throws Error(usage) with file:line:column, and the nearest name for an unknown one. A relative path of a scene file
// is taken from the experiment file's folder.
Experiment load_experiment(const std::string& path);
// The same from text; path is used for messages and for relative scene paths.
Experiment parse_experiment(std::string_view toml, const std::string& path);

// "name=value" as `--set` has it: one value, in the form that the setting's row takes ("2048", "auto", "1,2,3"). It
// replaces the file's value; a swept setting is swept no more. Relative paths stay relative to where the program runs.
// Bounds stay: one whose `where` no point meets any more is broken, not dropped. Throws Error(usage).
void apply_override(Experiment& experiment, std::string_view assignment);

// Leaves only the parts of these names (`--part`); points are numbered anew. Throws Error(usage) for a name that no
// part has, and where the experiment has no parts.
void choose_parts(Experiment& experiment, const std::vector<std::string>& names);

// The part that holds point `id`, or the experiment itself where it has no parts.
const Experiment& part_of_point(const Experiment& experiment, int64_t id);

// The names of everything swept, in any part, each once.
std::vector<std::string> swept_names(const Experiment& experiment);

// 1 without a sweep.
int64_t point_count(const Experiment& experiment);

// The points in order: the last swept setting changes fastest. Every one is validated as far as it can be without its
// scene; throws Error(usage) as at_point() does.
std::vector<Settings> points(const Experiment& experiment);

// What the point differs in from the others: "map.resolution = 512, filter.kind = box"; empty without a sweep.
std::string swept_text(const Experiment& experiment, int64_t id);

// The error of a point, with what a user needs to find it: the place of the setting at fault (of the sweep, where no
// setting is named), the point's part, number and swept settings.
Error error_of_point(const Experiment& experiment, int64_t id, const Error& error);

// Runs f; what it throws as Error(usage) is told of point `id`.
template <class F>
auto at_point(const Experiment& experiment, int64_t id, const F& f) {
  try {
    return f();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    throw error_of_point(experiment, id, error);
  }
}

// Every setting by its row's name, in canonical text: PointRecord::settings.
std::map<std::string, std::string> settings_map(const Settings& settings);

// A word as a shell reads it back: plain words stay as they are, anything else goes into single quotes, and what a
// terminal would not show as it is into $'...' (bash, zsh, ksh, POSIX 2024), so that what is printed can be pasted.
std::string shell_quoted(const std::string& word);

// The command that renders one point of the experiment, quoted for a shell: its overridden and swept settings as --set,
// or, of an experiment with parts, its number among the chosen ones.
std::string reproduce_command(const Experiment& experiment, const PointRecord& point);

// Everything that determines the results, as text of one "name = value" per line, for ResultStore. What the experiment
// cannot know comes in `more`: app/identity.h.
std::string fingerprint(const Experiment& experiment, std::span<const std::pair<std::string, std::string>> more);

}  // namespace noonmark
