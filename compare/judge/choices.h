// A sweep varies two kinds of settings. A user selects the *choices*: resolution, filter, bias and so on. A user cannot
// select the *conditions*: views, lights, frames (RunInfo::over lists them). A recommended choice must hold under every
// condition.
//
//   for (const Choice& choice : choices_of(results, conditions_of(results.info))) print(joined(choice, "error").worst);
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/interval.h"
#include "compare/results/records.h"

namespace noonmark {

// The points that have the same part and the same settings, except for the conditions: one point for each condition.
struct Choice {
  std::vector<const PointRecord*> points;  // in order of id
  const PointRecord& first() const { return *points.front(); }
};

// The conditions of an answer: RunInfo::over, and what was swept although no one can choose it, because it decides what is seen: a
// light, a camera, a scene. Numbers of different ones are compared only where RunInfo::over asks for it (comparable_choices).
std::vector<std::string> conditions_of(const RunInfo& info);

// The swept settings that are choices: all but conditions_of().
std::vector<std::string> choice_settings(const RunInfo& info);

// In the order of their first points. They point into the results.
std::vector<Choice> choices_of(const Results& results, const std::vector<std::string>& conditions);

// Whether numbers of points with different values of the setting cannot be compared: it decides the scene, the view or the
// truth. So does a setting that this version does not know.
bool decides_what_is_seen(const std::string& name);

// The choices that share scene, view, light and size of the picture, except for the conditions, so that their numbers
// can be compared. In order.
std::vector<std::vector<Choice>> comparable_choices(const Results& results);

// Numbers of a choice, one for each condition, joined: NaN if one of them is not finite.
struct Joined {
  double worst = 0, mean = 0, p95 = 0;  // worst: the largest
  const PointRecord* at = nullptr;      // the condition that is worst
};
Joined joined(const Choice& choice, const std::string& metric);

// The same at a bias, in units of the parameter that the curves vary (bias.unit); without one, as rendered.
Joined joined_at(const Choice& choice, const std::string& metric, std::optional<double> bias);

// The biases that are usable under every condition, in units of the parameter. Empty if there is none, or if a point has
// no curve.
std::optional<Interval> joined_window(const Choice& choice);

// Whether every point has a curve of the same parameter, in the same unit.
bool has_curves(const Choice& choice);

}  // namespace noonmark
