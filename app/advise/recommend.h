// app/advise/: what to type: the search for the cheapest settings that hold, and their text for other engines. May include
// raytrace, frames, measure, compare, app/definition and app/pictures.
//
// Searches for the settings to recommend: techniques that hold the bounds under all conditions and at every placement of the
// map's grid, and of them three answers between cost and error (compare/judge/answers.h).
//
//   const Advice advice = search(bench, request, [](const std::string& step) { print(step); });
//   for (const std::string& line : answer_text(advice)) print(line);          // app/advise/recommend_text.h
//
// The search:
// 1. Screening (app/advise/recommend_screening.h), under the first condition and at one placement: each technique, from the
//    least, at doubling resolutions. Settings that fail here fail for good, because the window at every placement lies
//    within it.
// 2. The three answers among what holds so far, from the cheapest. Each is looked at in full size at the given view (bounds for
//    the eye), and then measured under all conditions at 8 x 8 placements. What breaks a bound is no answer, and
//    the three are chosen anew.
// 3. Between the cheapest resolution that holds and its half, one more is tried: its half times the root of 2.
// 4. Verification at 64 other placements (app/advise/recommend_verify.h). OpenGL renders the answer that was asked for at some of
//    them; otherwise the exact map is judged.
// If filtered maps are asked for, their lookup.reduction is chosen in place of a bias. They are measured at 4 x 4 placements,
// and verified at 16 others (app/advise/recommend_filtered.h).
// Screening and confirmation ask for a share of the bounds on acne and Peter Panning (searched_bounds), because other views than
// the searched ones are a little worse.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/advise/map_places.h"
#include "app/advise/recommend_bias.h"
#include "app/advise/recommend_eye.h"
#include "app/advise/recommend_space.h"
#include "app/advise/recommend_verify.h"
#include "compare/judge/answers.h"
#include "compare/judge/recommendation.h"
#include "compare/ladder/bias_curves.h"
#include "measure/workbench.h"

namespace noonmark {

enum class AnswerKind { least, balanced, best };
inline constexpr AnswerKind answer_kinds[] = {AnswerKind::least, AnswerKind::balanced, AnswerKind::best};
std::string answer_name(AnswerKind kind);  // "least"
// The answer that is printed where none was asked for by name: `usual`, or if that is fragile the nearest kind that is not, the dearer
// one first. `usual` if all are.
AnswerKind printed_answer(AnswerKind usual, const std::function<bool(AnswerKind)>& is_fragile);

struct Tried;

// Of a filtered map: the lookup.reduction that was chosen, and from where to where it keeps the bounds of the search under every
// condition, at every placement that was searched.
struct ReductionChoice {
  double value = 0, low = 0, high = 0;
};

struct Elsewhere {
  std::string why_not = {};         // why they are no answer, as a sentence without a full stop; empty: they are one
  std::vector<Settings> does = {};  // what engines do that keep the bounds, in full size: the costliest is the cost
};

struct AdviceRequest {
  std::vector<Settings> conditions;  // of full size; the first is searched on. They differ in conditions only
  LightKind light = LightKind::directional;
  std::vector<MapPlace> places;         // of the map; at least the settings' own
  std::vector<BiasLevel> levels;        // empty: the bias as the conditions give it
  std::vector<FilterSettings> filters;  // of levels that compare
  std::vector<int> resolutions;         // ascending
  bool between = false;                 // whether a resolution between two of them may be the answer
  CurveOptions curve;                   // the bounds on acne and Peter Panning
  std::vector<Bound> eye;               // further bounds, judged at the first condition in full size
  std::string accuracy = "error_soft";
  std::optional<double> error;   // the most of `accuracy`
  std::optional<double> budget;  // the most texel_work; empty: budget_of_least times that of `least`
  AnswerKind answer = AnswerKind::least;
  bool answer_given = false;         // by the user; otherwise one that is not fragile is printed (printed_answer)
  std::vector<std::string> about;    // what it is asked for, as sentences (app/advise/recommend_request.h)
  std::string given;                 // what the user gave that decides the answer, for a sentence; empty: nothing
  std::string source_of_bounds;      // for a sentence: "the defaults of recommend"; empty: it is not said
  int width_px = least_searched_px;  // of the pictures that are searched on
  std::vector<std::string> held_in;  // engines in which the bounds hold too (`elsewhere` asks), for a sentence
  // What engines make of settings with their bias. Asked last, of few; null: nothing is asked.
  std::function<Elsewhere(const Tried&)> elsewhere;
};

// Settings that were measured.
struct Tried {
  Settings settings;  // of full size, with the bias that was chosen
  std::string level;
  size_t place = 0;                          // in AdviceRequest::places
  double cost = 0;                           // texel_work of a picture with the size that the settings give
  double screened_error = 0;                 // accuracy under the first condition, by which answers are compared
  double error = 0;                          // accuracy, largest over the conditions that were measured
  std::optional<BiasChoice> bias;            // empty: no usable bias, or a filtered map
  std::optional<ReductionChoice> reduction;  // of a filtered map; empty: none is usable
  std::string why_not;                       // why it is not the answer; empty for the answer
  std::optional<PointRecord> worst;          // where it failed, or the worst condition of the answer
  // Without a usable bias: what comes nearest in the condition that failed.
  std::optional<NearestBias> nearest;
  std::optional<EyeErrors> eye;  // at the given view, in full size; empty: not looked at

  bool fails_elsewhere = false;  // why_not is that of AdviceRequest::elsewhere

  bool as_is = false;  // a form of an engine that keeps the bounds on causes as it is
  bool held = false;   // of Advice::tried: it keeps the bounds as far as it was measured, and something else is better

  bool filtered() const;  // a lookup that compares no depths
  // It keeps the bounds on causes, with some bias or reduction where one is free.
  bool usable() const { return bias || reduction || as_is; }
};

// At how many placements these settings are searched, along each axis.
int placements_along(const Tried& tried);

// An answer may not be sensitive to its bias: one that may vary by less than this share, up or down, is fragile.
inline constexpr double fragile_below = 0.25;
bool is_fragile(const BiasChoice& bias);

struct Answer {
  std::vector<AnswerKind> kinds;  // one answer can be several of the three
  Tried tried;
  double doubled_cost = 0;  // texel_work with twice the texels on a side
  double extent_m = 0;      // of a directional light's map under the first condition; 0: the light is another one
  size_t conditions = 0;
  int placements = 0;  // that were searched, under each condition
  Verified verified;   // at other placements
};

struct Advice {
  std::vector<Answer> answers;  // by cost, all different; empty: nothing holds
  std::vector<Tried> tried;     // all others, by cost
  // Without an answer: the one of them that came nearest. Its record is rendered with its nearest bias, and its worst pixel
  // is the one with most acne and Peter Panning, if these are what failed.
  std::optional<Tried> nearest;
  double budget = 0;                      // of `best`
  std::optional<AnswerKind> passed_over;  // the answer that would be printed if it were not fragile
  // The cost of the cheapest settings of each lookup that was asked for, measured or not. Empty if nothing was measured.
  std::map<std::string, double> least_costs;
  // Share of the counted receivers that are dark in the hard truth, the largest over the conditions that were measured: the
  // error without a shadow map.
  double shadowed = 0;
  // If one constant bias is not the answer: the least resolution at which it would keep the bounds, under the first
  // condition and without a filter; negative: none up to that. Empty: not known.
  std::optional<int> least_resolution;
  AdviceRequest request;

  // The answer of a kind; null without answers. `answer`: the one that the request asks for.
  const Answer* of(AnswerKind kind) const;
  const Answer* answer() const { return of(request.answer); }
};

// These settings under each condition, as they were searched: small pictures, all placements.
std::vector<Settings> under_conditions(const Tried& tried, const AdviceRequest& request);

// say: progress, one line. Throws Error.
Advice search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say);

}  // namespace noonmark
