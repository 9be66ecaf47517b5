// app/advise/: what to type: the search for the cheapest settings that hold, and their text for other engines. May include
// raytrace, frames, measure, compare, app/definition and app/pictures.
//
// Searches for the settings to recommend: the least technique that holds the bounds under all conditions and at every
// placement of the map's grid.
//
//   const Advice advice = search(bench, request, [](const std::string& step) { print(step); });
//   for (const std::string& line : advice_text(advice)) print(line);          // app/advise/recommend_text.h
//
// The search:
// 1. Screening, under the first condition and at one placement: each technique, from the least, at doubling
//    resolutions. Settings that fail here fail for good, because the window at every placement lies within it. Dearer
//    resolutions are not tried where they do not pay: on average errors fall as the texel's width (law 5).
// 2. The settings that hold, from the best, are measured under all conditions at 8 x 8 placements. The first that holds
//    there is verified.
// 3. Verification: OpenGL renders it at 64 other placements, and each must keep the bounds. Otherwise the next is taken.
// Screening and confirmation ask for searched_share of the bounds, because other views than the searched ones are a
// little worse.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/advise/recommend_bias.h"
#include "app/advise/recommend_space.h"
#include "compare/judge/recommendation.h"
#include "compare/ladder/bias_curves.h"
#include "compare/report/tornado.h"
#include "measure/workbench.h"

namespace noonmark {

struct AdviceRequest {
  std::vector<Settings> conditions;  // of full size; the first is searched on. They differ in conditions only
  std::vector<BiasLevel> levels;     // empty: the bias as the conditions give it
  std::vector<FilterSettings> filters;
  std::vector<int> resolutions;  // ascending
  CurveOptions curve;            // the bounds
  std::string accuracy = "error_soft";
  std::optional<double> error;   // the most of `accuracy`
  std::optional<double> budget;  // the most texel_work
  int width_px = 320;            // of the pictures that are searched on
};

// Settings that were measured.
struct Tried {
  Settings settings;  // of full size, with the bias that was chosen
  std::string level;
  double cost = 0;                   // texel_work of a picture with the size that the settings give
  double error = 0;                  // accuracy, largest over the conditions that were measured
  std::optional<BiasChoice> bias;    // empty: no usable bias
  std::string why_not;               // why it is not the answer; empty for the answer
  std::optional<PointRecord> worst;  // where it failed, or the worst condition of the answer
  // Without a usable bias: what comes nearest in the condition that failed.
  std::optional<NearestBias> nearest;
};

struct Advice {
  std::optional<Tried> answer;
  std::vector<Tried> tried;  // all others, by cost
  // Without an answer: the one of them that came nearest. Its record is rendered with its nearest bias, and its worst pixel
  // is the one with most acne and Peter Panning, if these are what failed.
  std::optional<Tried> nearest;
  // Of the answer.
  size_t conditions = 0;
  int placements = 0, verified = 0;                                 // searched (each condition); rendered afresh
  double worst_acne = 0, worst_peter_panning = 0, worst_error = 0;  // over the placements that were rendered
  // Share of the counted receivers that are dark in the hard truth, the largest over the conditions that were measured: the
  // error without a shadow map.
  double shadowed = 0;
  // If one constant bias is not the answer: the least resolution at which it would keep the bounds, under the first
  // condition and without a filter; negative: none up to that. Empty: not known.
  std::optional<int> least_resolution;
  // What each setting does around the answer; only if it was asked for (app/advise/recommend_around.h).
  std::optional<Tornado> around;
  AdviceRequest request;
};

// The answer's settings under each condition, as they were searched: small pictures, all placements. There must be an
// answer.
std::vector<Settings> answer_under_conditions(const Advice& advice);

// say: progress, one line. Throws Error.
Advice search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say);

}  // namespace noonmark
