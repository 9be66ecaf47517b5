// app/definition/: what an experiment file says: its keys, their schema, sweeps and conditions, bounds and laws that it
// promises. May include base, scenes, technique and what judges; measures nothing.
//
// An experiment: what to measure and which results to assert, read from one TOML file.
//
//   Experiment experiment = load_experiment("experiments/cube-room.toml");
//   apply_override(experiment, "map.resolution=2048");            // --set
//   for (const Settings& settings : points(experiment)) measure(settings);
//
// docs/reference/experiment.md is the reference of the file's keys; tests/app/experiment_docs_test.cpp reads its examples.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/shell_words.h"
#include "compare/judge/bounds.h"
#include "compare/judge/laws.h"
#include "compare/ladder/bias_curves.h"
#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

struct Swept {
  std::string name;
  std::vector<std::string> values;  // canonical texts, in the file's order, all different
  bool condition = false;           // of [over]: not a choice of the user
};

// The phase diagram that an experiment, or a part of it, asks for (app/sweep/sweep_phase.h).
inline constexpr int most_phase_rows = 200;
struct PhaseRequest {
  bool enabled = false;
  std::optional<double> acne_bound, peter_panning_bound;  // empty: those of the bias curve
  int placements = 8;                                     // S, along each axis
  int texel_sizes = 25;
  int width_px = 640;  // of its picture, at most that of the view; its height follows from the view's
};

// The frame of another renderer that an experiment judges (frames/frame_file.h).
struct FrameRequest {
  std::string name;                   // different for each
  std::string file;                   // frame.json; a relative path starts at the working directory
  std::vector<std::string> accepted;  // names of checks
  bool without_map = false;           // judged by place, though its file names a shadow map
};

struct Experiment {
  std::string path;  // as given
  std::string title;
  Settings base;             // the fixed settings
  std::vector<Swept> swept;  // outermost first; conditions come before choices
  std::vector<std::string> plot;
  std::string cost = RunInfo().cost, accuracy = RunInfo().accuracy;  // of [answer]
  // Of [answer], too: what recommend may choose although the file gives it. "bias" and "filter" are groups of settings.
  std::vector<std::string> choose;
  std::vector<Bound> bounds;
  std::vector<std::pair<std::string, std::string>> let;  // definitions for the laws
  std::vector<Law> laws;
  bool curve_enabled = true;
  CurveOptions curve;
  PhaseRequest phase;
  std::vector<FrameRequest> frames;     // then each is a point, given.frame is swept, and nothing else is measured
  std::optional<bool> times;            // the key `times`; empty: as time_asked_for() says
  std::string pictures = "first";       // which points get pictures: a word of the key `pictures`
  bool pictures_given = false;          // the file has the key; without it check takes "broken"
  bool exr = false;                     // their numbers as OpenEXR files
  std::vector<std::string> overridden;  // settings given by apply_override, in order
  std::vector<std::string> chosen;      // parts given by choose_parts
  std::string part;                     // its name, if it is a part of another experiment
  // Where each setting was given: "file:line:column", or "--set name=value". sweep_location: the same of
  // [sweep].
  std::map<std::string, std::string> locations;
  std::string sweep_location;
  std::vector<std::string> notes;  // what is most likely a mistake of the file, one sentence each; of the parts too
  std::vector<Experiment> parts;   // if there are parts, all points belong to them, one part after the other
  // The parts are the lights of one frame: the first points of all parts are one frame, and so on (compare/results/metrics.cpp,
  // lights_error). Every part has as many points.
  bool lights = false;
  bool all_lights = false;  // lights = "all": the parts are made when the scene is known (take_all_lights)
};

// A sweep with more points than this is taken for a mistake in the file.
constexpr int64_t max_points = 100000;

// assignment: "name=value" as in `--set`, with one value in the form that the setting's row reads ("2048", "auto",
// "1,2,3"). It replaces the file's value; if the setting was swept, it is no longer swept. Relative paths start at the
// working directory of the program. Bounds stay: a bound whose `where` no longer matches a point is broken and not
// dropped. Throws Error(usage).
void apply_override(Experiment& experiment, std::string_view assignment);

// Keeps only the parts with these names (`--part`) and numbers their points anew. Throws Error(usage) for a name that
// no part has, and if the experiment has no parts.
void choose_parts(Experiment& experiment, const std::vector<std::string>& names);

// Of an experiment with lights = "all": makes a part of each light of the scene, with its name, or with its number where it has no
// name of its own. Does nothing for others. Throws Error(usage) if the scene is swept, and what loading it throws.
void take_all_lights(Experiment& experiment);

// Makes the part of one light: the experiment without its parts, whose points have this light. light: light.name.
Experiment part_of_light(const Experiment& experiment, const std::string& light);

// Whether a setting is one for all lights of a frame: of the scene, the view and the motion.
bool is_of_frame(std::string_view setting);

// Of an experiment whose parts are the lights of frames: throws Error(usage) if the lights of a frame differ in what is one for all of
// them, or if two of them are the same light.
void require_one_frame(const Experiment& experiment);

// Puts the parts of lights into the experiment, which keeps no sweep, bound and diagram of its own.
void give_lights(Experiment& experiment, std::vector<Experiment> lights);

// The part that holds point `id`, or the experiment itself if it has no parts.
const Experiment& part_of_point(const Experiment& experiment, int64_t id);

// The first metric that is a time (unit "ms") among those that the experiment plots, bounds, counts as cost or reads in
// a law, in its parts too. Empty if it asks for none.
std::string time_asked_for(const Experiment& experiment);

// Whether the points' map and lookup are timed. All points of an experiment are, or none.
bool times_measured(const Experiment& experiment);

// The names of all swept settings of all parts, each once.
std::vector<std::string> swept_names(const Experiment& experiment);

// Those of them that are conditions.
std::vector<std::string> condition_names(const Experiment& experiment);

// The number of points. 1 without a sweep.
int64_t point_count(const Experiment& experiment);

// The points in order: the last swept setting changes fastest. Each point is checked as far as that is possible without
// its scene. A point with several cascades has this map.fit where the experiment gives none: of the fits that cascades
// can have, it is the one whose size does not change with the camera. Throws Error(usage) as at_point() does.
std::vector<Settings> points(const Experiment& experiment);
constexpr std::string_view fit_of_cascades = "sphere";

// Whether points() chooses that fit for some point, whose experiment or part then does not give map.fit.
bool fits_cascades(const Experiment& experiment);

// The settings that distinguish the point, for people: "map.resolution = 512, filter.kind = box". Empty without a sweep.
std::string swept_text(const Experiment& experiment, int64_t id);

// The error of a point, with the information that a user needs to find it: the place of the setting at fault (or of the
// sweep, if no setting is named), and the point's part, number and swept settings.
Error error_of_point(const Experiment& experiment, int64_t id, const Error& error);

// Runs f. If it throws an Error(usage), the error gets the information on point `id`.
template <class F>
auto at_point(const Experiment& experiment, int64_t id, const F& f) {
  try {
    return f();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    throw error_of_point(experiment, id, error);
  }
}

// The command that renders one point of the experiment, quoted for a shell. It passes overridden and swept settings as
// --set. If the experiment has parts, it passes the point's number among the chosen parts.
std::string reproduce_command(const Experiment& experiment, const PointRecord& point);

// Everything that determines the points' results, as text with one "name = value" per line: two experiments with the same
// text have the same points. more: what the experiment does not contain itself (app/sweep/identity.h).
std::string fingerprint(const Experiment& experiment, std::span<const std::pair<std::string, std::string>> more);

}  // namespace noonmark
