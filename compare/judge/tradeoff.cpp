#include "compare/judge/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "compare/judge/curve_reading.h"
#include "compare/judge/undecided.h"
#include "compare/results/causes.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

using Window = ComparedChoice::Window;

// Of an empty window: the least bias of least error, among the entries of the curves.
double least_wrong_bias(const Choice& choice, const std::string& metric) {
  double largest = 0;
  for (const PointRecord* point : choice.points)
    for (double depth : curve_depths(*point)) largest = std::max(largest, depth * parameter_per_depth(*point));
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (double bias : curve_biases(choice, 0, largest)) {
    const double error = joined_at(choice, metric, bias).worst;  // NaN is never less
    if (error < least || (error == least && bias < best)) best = bias, least = error;
  }
  return best;
}

// The bias for a choice whose window is not empty, but which is not good enough.
double bias_without_bounds(const Choice& choice, const Results& results, const Interval& window) {
  if (const std::optional<BiasChoice> chosen = choose_bias(choice, results, {})) return chosen->value;
  return std::sqrt(window.low * window.high);  // no error of the curve is finite
}

bool was_rendered_in_window(const Choice& choice) {
  return std::all_of(choice.points.begin(), choice.points.end(), [](const PointRecord* point) {
    const std::optional<double> set = bias_as_set(*point);
    const std::optional<Interval> window = usable_window(*point);
    return set && window && *set >= window->low && *set <= window->high;
  });
}

// Where the recommendation stands among the choices of a group.
std::optional<size_t> place_of(const Recommendation* found, const std::vector<ComparedChoice>& choices) {
  for (size_t i = 0; found && i < choices.size(); ++i)
    if (&choices[i].choice.first() == &found->choice.first()) return i;
  return std::nullopt;
}

}  // namespace

ComparedChoice at_best_bias(const Choice& choice, const Results& results) {
  ComparedChoice one;
  one.choice = choice, one.usable = joined_window(choice), one.good = good_choice(choice, results);
  one.judged = has_criterion(choice, results);
  if (std::any_of(choice.points.begin(), choice.points.end(),
                  [](const PointRecord* point) { return hides_bounds(*point); }))
    one.window = Window::unknown;
  if (!has_curves(choice)) return one;
  if (one.window != Window::unknown) one.window = one.usable ? Window::usable : Window::empty;
  one.rendered_in_window = one.usable && was_rendered_in_window(choice);
  one.bias = one.good     ? one.good->bias->value
             : one.usable ? bias_without_bounds(choice, results, *one.usable)
                          : least_wrong_bias(choice, results.info.accuracy);
  return one;
}

std::vector<ComparedGroup> compared_groups(const Results& results) {
  std::vector<ComparedGroup> groups;
  for (const std::vector<Choice>& choices : comparable_choices(results)) {
    ComparedGroup group;
    std::vector<Recommendation> good;
    for (const Choice& choice : choices) {
      group.choices.push_back(at_best_bias(choice, results));
      if (group.choices.back().good) good.push_back(*group.choices.back().good);
    }
    if (!is_incomplete(results)) {
      group.recommended = place_of(cheapest(good), group.choices);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

std::vector<Recommendation> good_choices(const std::vector<ComparedGroup>& groups) {
  std::vector<Recommendation> good;
  for (const ComparedGroup& group : groups)
    for (const ComparedChoice& one : group.choices)
      if (one.good) good.push_back(*one.good);
  // Choices stand in the order of their first points, and the points of results in one array.
  std::stable_sort(good.begin(), good.end(), [](const Recommendation& a, const Recommendation& b) {
    return std::less<const PointRecord*>()(&a.choice.first(), &b.choice.first());
  });
  return good;
}

Joined value_of(const ComparedChoice& one, const std::string& metric, AtBias at) {
  return joined_at(one.choice, metric, at == AtBias::best ? one.read_at() : std::nullopt);
}

bool follows_bias(const ComparedChoice& one, const std::string& metric) {
  return std::all_of(one.choice.points.begin(), one.choice.points.end(),
                     [&](const PointRecord* point) { return has_curve_of(*point, metric); });
}

bool counts_by(const ComparedChoice& one, const std::string& metric, AtBias at) {
  switch (one.window) {
    case Window::no_curve:
      return true;
    case Window::empty:
    case Window::unknown:
      return false;
    case Window::usable:
      break;
  }
  return (at == AtBias::best && follows_bias(one, metric)) || one.rendered_in_window;
}

std::optional<Interval> span_over_window(const ComparedChoice& one, const std::string& metric) {
  if (!one.usable || !follows_bias(one, metric)) return std::nullopt;
  Interval span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  std::vector<double> biases = curve_biases(one.choice, one.usable->low, one.usable->high);
  biases.push_back(*one.bias);  // so that the value itself lies within the span
  for (double bias : biases) {
    const double value = joined_at(one.choice, metric, bias).worst;
    if (!std::isfinite(value)) return std::nullopt;
    span = {std::min(span.low, value), std::max(span.high, value)};
  }
  return span;
}

std::vector<std::string> joined_causes(std::initializer_list<const ComparedChoice*> choices) {
  std::vector<std::string> names;
  for (const bool of_taps : {true, false})
    for (const CauseRow& row : causes_as_in_legends)
      if (row.sum.empty() && row.place != CausePlace::light && is_of_taps(row) == of_taps) names.emplace_back(row.name);
  for (const ComparedChoice* one : choices)
    for (const PointRecord* point : one->choice.points)
      for (const RungCause& cause : point->causes)
        if (std::find(names.begin(), names.end(), cause.name) == names.end()) names.push_back(cause.name);
  return names;
}

std::string dominating_cause(const ComparedChoice& one, AtBias at) {
  std::string largest;
  double share = 0;
  for (const std::string& name : joined_causes({&one}))
    if (const double mean = value_of(one, name, at).mean; mean > share) largest = name, share = mean;
  return largest;
}

}  // namespace noonmark
