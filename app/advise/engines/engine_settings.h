// Recommended settings as numbers to type into other engines, and what is typed there as settings. Each engine is one file of rows
// (app/advise/engines/engine.h).
//
//   for (const EngineAdvice& advice : engine_advice(settings, make_light_frame(scene, settings), scene))
//     print(advice.engine, advice.lines, advice.cannot);
//
// Every setting of the bias that is not 0, a reference other than own_depth and the filter stand in `lines`, in `cannot`
// or in both. What a part gives along the light on a plane is law 35 of experiments/laws.toml. A part without a field of its
// form is replaced by the least amounts of other fields that give at least its depth at every slope and azimuth. A filter
// that reaches further, or a coarser texel, multiplies the bias as law 1 says. The numbers hold all of that.
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/advise/filtered_shares.h"
#include "scenes/scene.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

// What lines give, measured: the largest over conditions and placements.
struct EnginePromise {
  double error = 0, acne = 0, peter_panning = 0;  // shares
  std::optional<FilteredShares> filtered = {};    // of a filtered map that Noonmark drew
  bool all_views = true;                          // false: the first condition alone, because the map is large
};

// A frame of the engine itself with these lines, under one condition.
struct TrialView {
  std::string name;                           // "given", "turned by 30 deg"
  std::optional<EnginePromise> promise = {};  // at the frame's own receivers, judged as the frame is; empty: not known
  EnginePromise measured = {};                // by place (frames/judge.h); only if `refused` is empty
  size_t counted = 0;                         // pixels that `measured` is a share of
  std::vector<std::string> broken = {};       // bounds: "acne 0.51% (bound 0.1%)"
  std::string refused = {};                   // why the frame is not judged
};

struct EngineTrial {
  std::string folder;  // of the frames, from the recommendation's folder
  std::vector<TrialView> views = {};
  std::string no_frame = {};         // why the adapter gave none
  std::set<std::string> notes = {};  // what the adapter said to the user: sentences
};

struct EngineAdvice {
  std::string engine, version;
  // Code, or fields of an inspector with their values, in the engine's own language. Empty if nothing of the engine
  // suffices: then the first sentence of `cannot` says why.
  std::vector<std::string> lines;
  std::vector<std::string> cannot;  // sentences: what the engine cannot express, or expresses otherwise, and what to do
  std::string source;               // the document or the source files of the engine that define the units
  std::string comment;              // what begins a comment in the engine's language
  // The settings that do what the engine does with these lines; empty if no settings can. Then why_not_emulated says why.
  std::optional<Settings> emulated = {};
  std::string why_not_emulated = {};
  std::optional<EnginePromise> promise = {};  // of `emulated`; app/advise/engine_promise.h measures it
  std::string promised = {};                  // `promise` as a sentence for people; empty: not measured
  std::string broken = {};                    // which bounds the lines break, a sentence for people; empty: none
  std::optional<EngineTrial> trial =
      {};  // in the engine itself, if it was asked for; app/advise/engine_trial.h makes it
};

// What several views show, along each view: the nearest near plane, and the farthest that is in view.
struct SeenDepths {
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0;
};

// One piece of advice for each engine, in the order of the table. frame: of these settings in this scene.
//
// Numbers are computed in double and written with 6 significant digits. A spot or point light has no single conversion
// from depth or texels to metres. For these lights the numbers hold at one distance from the light, that of the point
// at which the camera looks, held between near and far. A sentence in `cannot` says so.
// in_views: of all views that the lines are for; the settings' own view is one of them in any case.
std::vector<EngineAdvice> engine_advice(const Settings& settings, const LightFrame& frame, const Scene& scene,
                                        const SeenDepths& in_views = {});

// The same for one engine. word: of engine_words().
EngineAdvice advice_for_engine(std::string_view word, const Settings& settings, const LightFrame& frame,
                               const Scene& scene, const SeenDepths& in_views = {});

// What people type for each engine of the table, in its order: "three", "babylon"; and for one of them.
std::vector<std::string> engine_words();
std::string engine_word(std::string_view engine);
// EngineAdvice::engine of one of the words.
std::string engine_of_word(std::string_view word);

// How far from the camera along its view the farthest is that the settings' picture can show.
double farthest_in_view_m(const Settings& settings, const Scene& scene);

// The settings as the engine does them under another condition: view, light and scene of the condition, map, bias and filter of
// advice.emulated, which must not be empty.
Settings as_engine(const EngineAdvice& advice, Settings condition);

// What is typed into an engine: its fields by what a user types for them, "bias" of LightShadow.bias, and their values. "filter" is one of
// its filters, by the number of its row from 0; "lookup" is the lookup.kind of a filtered map.
using EngineValues = std::map<std::string, std::string>;

// The values of lines that are as engine_advice() writes them, with any numbers. word: of engine_words(). Comments, lines that hold no
// value and those of cascades are passed over. unread: gets the lines that no row of the engine has.
EngineValues read_values(std::string_view word, const std::vector<std::string>& lines, LightKind kind,
                         std::vector<std::string>* unread = nullptr);

// The settings that do what the engine does with these values under a condition, as EngineAdvice::emulated: one map of a directional
// light. Fields that are not given are as in the condition; a bias is 0. Throws Error(usage) if the engine has no such field or does not
// take the value, and if no settings do what it does.
Settings settings_of_values(std::string_view word, const EngineValues& values, const Settings& condition,
                            const Scene& scene);

// A bias field of an engine, for the table in docs/reference/engines.md.
struct EngineField {
  std::string engine, version, light;  // light: its kinds, such as "spot, point"
  std::string field, unit, place;
  std::string source;  // where its law was read: "PATH:LINE"; empty: not known
};
std::vector<EngineField> engine_fields();

// A line of an engine's source that its row states. scripts/engine-sources reads them again, from the table in
// docs/reference/engine-sources.md.
struct EngineSource {
  std::string repository;  // of github.com: "mrdoob/three.js"
  std::string commit;      // or the tag of a release, or a branch
  std::string path;
  int line;          // 0: not known
  std::string text;  // of the line, what tells it from others; white space does not count
};
// Each engine of the table with its sources.
std::vector<std::pair<std::string, std::vector<EngineSource>>> engine_sources();

}  // namespace noonmark
