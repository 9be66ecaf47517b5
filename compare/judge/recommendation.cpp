#include "compare/judge/recommendation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "compare/judge/conditions.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/undecided.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

using Outcome = Recommendation::Outcome;

// A bound that only warns does not decide what is good enough.
bool speaks_of(const BoundResult& bound, const PointRecord& point) {
  return !bound.warns && bound.part == point.part && matches(point, bound.where);
}

// The conditions without the swept choices.
Conditions without_choices(Conditions where, const RunInfo& info) {
  for (const std::string& name : choice_settings(info)) where.erase(name);
  return where;
}

bool lacks_conditions(const Results& results, const std::vector<std::string>& conditions) {
  return !conditions.empty() && static_cast<int64_t>(results.points.size()) < results.planned_points;
}

// A bound on other choices than the point's, which the point must keep too: no bound on that metric speaks of the point itself,
// so nothing else says what is good enough there. Not one with a min: an experiment writes it also to see that something is wrong.
bool is_asked_of_others(const BoundResult& bound, const PointRecord& point, const std::vector<BoundResult>& bounds,
                        const RunInfo& info) {
  if (bound.warns || bound.min || bound.part != point.part || matches(point, bound.where)) return false;
  return matches(point, without_choices(bound.where, info)) &&
         std::none_of(bounds.begin(), bounds.end(), [&](const BoundResult& other) {
           return other.metric == bound.metric && speaks_of(other, point);
         });
}

// What each point of a choice must keep.
using Demands = std::vector<std::pair<const PointRecord*, std::vector<const BoundResult*>>>;

Demands demands_on(const Choice& choice, const std::vector<BoundResult>& bounds, const RunInfo& info) {
  Demands demands;
  for (const PointRecord* point : choice.points) {
    std::vector<const BoundResult*> must_keep;
    for (const BoundResult& bound : bounds)
      if (speaks_of(bound, *point) || is_asked_of_others(bound, *point, bounds, info)) must_keep.push_back(&bound);
    demands.emplace_back(point, std::move(must_keep));
  }
  return demands;
}

std::optional<double> depth_at(const PointRecord& point, std::optional<double> bias) {
  return bias && has_curve(point) ? std::optional(*bias / parameter_per_depth(point)) : std::nullopt;
}

bool meets_all(const Demands& demands, std::optional<double> bias) {
  return std::all_of(demands.begin(), demands.end(), [&](const auto& of_point) {
    const PointRecord& point = *of_point.first;
    return std::all_of(of_point.second.begin(), of_point.second.end(),
                       [&](const BoundResult* bound) { return meets(point, *bound, depth_at(point, bias)); });
  });
}

// better(a, b): whether a is preferred to b. Among equals the first is kept.
template <class Better>
const Recommendation* best_by(const std::vector<Recommendation>& good, const Better& better) {
  const Recommendation* best = nullptr;
  for (const Recommendation& other : good)
    if (!best || better(other, *best)) best = &other;
  return best;
}

// The cost that ends first: every choice whose cost begins beyond it is certainly dearer.
MedianInterval least_cost(const std::vector<Recommendation>& good) {
  const Recommendation* first = best_by(good, [](const auto& a, const auto& b) { return a.cost.high < b.cost.high; });
  return first ? first->cost : MedianInterval();
}

CostNoise noise_of(const std::vector<Recommendation>& good) {
  const MedianInterval bar = least_cost(good);
  std::set<std::tuple<double, double, double>> costs, least;
  for (const Recommendation& one : good) {
    const std::tuple cost(one.cost.low, one.cost.middle, one.cost.high);
    costs.insert(cost);
    if (!certainly_less(bar, one.cost)) least.insert(cost);
  }
  return {costs.size(), least.size()};
}

// The choice that was picked of the good ones, or why nothing can be recommended. picked: null if none is good.
Recommendation answered(const Results& results, const Recommendation* picked) {
  Recommendation none;
  const std::vector<std::string> conditions = conditions_of(results.info);
  if (lacks_conditions(results, conditions)) {
    none.outcome = Outcome::incomplete;
    return none;
  }
  if (picked) return *picked;
  const std::vector<Choice> all = choices_of(results, conditions);
  if (std::any_of(all.begin(), all.end(), [&](const Choice& choice) { return has_criterion(choice, results); }))
    none.outcome = Outcome::none_holds;
  return none;
}

}  // namespace

double short_decimal(double value, double low, double high) {
  for (int digits = 1; digits <= 16; ++digits) {
    const double shorter = std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
    if (shorter >= low && shorter <= high && std::abs(shorter - value) <= 0.05 * std::abs(value)) return shorter;
  }
  return value;
}

bool meets(const PointRecord& point, const BoundResult& bound, std::optional<double> bias_depth) {
  const std::optional<double> of_curve = bias_depth ? curve_value(point, bound.metric, *bias_depth) : std::nullopt;
  const double one = of_curve ? *of_curve : quantity(point, bound.metric).value_or(std::nan(""));
  const double high = bound.placement == "worst" ? std::max(one, metric_at(point, bound.metric, bias_depth)) : one;
  const double room = ambiguous_room(point, bound.metric);
  return std::isfinite(one) && std::isfinite(high) && (!bound.max || high + room <= *bound.max) &&
         (!bound.min || one - room >= *bound.min);
}

std::vector<double> curve_biases(const Choice& choice, double low, double high) {
  std::vector<double> all{low, high};
  for (const PointRecord* point : choice.points) {
    const double per_depth = parameter_per_depth(*point);
    all.push_back(std::clamp(best_depth(*point) * per_depth, low, high));
    for (double depth : curve_depths(*point))
      if (const double bias = depth * per_depth; bias > low && bias < high) all.push_back(bias);
  }
  return all;
}

std::string margin_text(const BiasChoice& bias) {
  const double percent = 100 * (bias_margin - 1);
  if (bias.window.low > 0) return fmt::format("the bias keeps at least {:.0f}% from both ends", percent);
  return bias.value > 0
             ? fmt::format(
                   "no bias is needed, so there is no lower end, and it keeps at least {:.0f}% from the upper one",
                   percent)
             : "no bias is needed, so there is no lower end, and 0 is furthest from the upper one";
}

std::optional<BiasChoice> choose_bias(const Choice& choice, const Results& results,
                                      const std::vector<BoundResult>& bounds) {
  const std::optional<Interval> window = joined_window(choice);
  if (!window) return std::nullopt;
  double low = window->low * bias_margin, high = window->high / bias_margin;
  const bool narrow = low > high;
  if (narrow) {  // as far from both ends as possible, and half of that way is left to shorten the number
    const double middle = std::sqrt(window->low * window->high);
    low = std::sqrt(window->low * middle), high = std::sqrt(middle * window->high);
  }
  const Demands demands = demands_on(choice, bounds, results.info);
  struct Candidate {
    double bias, error;
  };
  std::vector<Candidate> allowed;
  double least = std::numeric_limits<double>::infinity();
  for (double bias : curve_biases(choice, low, high)) {
    const double error = joined_at(choice, results.info.accuracy, bias).worst;
    if (!std::isfinite(error) || !meets_all(demands, bias)) continue;
    allowed.push_back({bias, error});
    least = std::min(least, error);
  }
  if (allowed.empty()) return std::nullopt;
  const PointRecord& first = choice.first();
  // A bias that is off is acne or a gap, so it keeps away from both ends where that costs little. A reduction that is off leaks or
  // darkens a little more or less, so it is the one of least error.
  const double flat = free_setting(first) == FreeSetting::reduction ? 1 : flat_error;
  // The factor by which the scene may change before the bias is no longer usable.
  const auto distance = [&](double bias) {
    return std::min(window->low > 0 ? bias / window->low : std::numeric_limits<double>::infinity(),
                    bias > 0 ? window->high / bias : std::numeric_limits<double>::infinity());
  };
  std::optional<double> best;
  for (const auto& [bias, error] : allowed)
    if (error <= flat * least && (!best || distance(bias) > distance(*best))) best = bias;
  double value = short_decimal(*best, low, high);
  if (value != *best && !meets_all(demands, value)) value = *best;
  return BiasChoice{curve_parameter(first), curve_unit(first), value, *window, narrow};
}

std::optional<BiasChoice> set_bias(const Choice& choice, const Results& results) {
  if (choice.points.size() != results.points.size() ||
      !meets_all(demands_on(choice, results.bounds, results.info), std::nullopt))
    return {};
  if (std::none_of(results.bounds.begin(), results.bounds.end(),
                   [&](const BoundResult& bound) { return speaks_of(bound, choice.first()); }))
    return {};
  const std::optional<Interval> window = joined_window(choice);
  if (!window) return {};
  const PointRecord& first = choice.first();
  const std::string parameter = curve_parameter(first);
  const std::string text = setting_of(first, parameter);
  const std::optional<double> value = number_of(text);
  // With the parameter among the conditions there is no one bias.
  if (!value || std::any_of(choice.points.begin(), choice.points.end(),
                            [&](const PointRecord* point) { return setting_of(*point, parameter) != text; }))
    return {};
  constexpr double rounding = 1e-12;  // of the ends, which were converted from window depth
  if (*value < window->low * (1 - rounding) || *value > window->high * (1 + rounding)) return {};
  const bool narrow = *value < window->low * bias_margin || *value * bias_margin > window->high;
  return BiasChoice{parameter, curve_unit(first), *value, *window, narrow, true};
}

bool keeps_bounds_of_others(const Choice& choice, const Results& results) {
  return std::any_of(choice.points.begin(), choice.points.end(), [&](const PointRecord* point) {
    return std::any_of(results.bounds.begin(), results.bounds.end(), [&](const BoundResult& bound) {
      return is_asked_of_others(bound, *point, results.bounds, results.info);
    });
  });
}

bool has_criterion(const Choice& choice, const Results& results) {
  const Demands demands = demands_on(choice, results.bounds, results.info);
  return std::any_of(demands.begin(), demands.end(),
                     [](const auto& of_point) { return has_curve(*of_point.first) || !of_point.second.empty(); });
}

std::optional<Recommendation> good_choice(const Choice& choice, const Results& results) {
  if (!has_criterion(choice, results)) return std::nullopt;
  Recommendation candidate{Outcome::found, choice, joined_interval(choice, results.info.cost), {}, {}, {}};
  std::optional<double> bias;
  if (has_curves(choice)) {
    candidate.bias = set_bias(choice, results);
    if (!candidate.bias) candidate.bias = choose_bias(choice, results, results.bounds);
    if (!candidate.bias) return std::nullopt;
    bias = candidate.bias->read_at();
  } else if (!meets_all(demands_on(choice, results.bounds, results.info), std::nullopt)) {
    return std::nullopt;
  }
  candidate.error = joined_at(choice, results.info.accuracy, bias);
  if (!std::isfinite(candidate.cost.middle) || !std::isfinite(candidate.error.worst)) return std::nullopt;
  return candidate;
}

std::vector<Recommendation> good_choices(const Results& results) {
  std::vector<Recommendation> good;
  for (const Choice& choice : choices_of(results, conditions_of(results.info)))
    if (std::optional<Recommendation> candidate = good_choice(choice, results)) good.push_back(std::move(*candidate));
  return good;
}

bool is_incomplete(const Results& results) { return lacks_conditions(results, results.info.over); }

const Recommendation* cheapest(const std::vector<Recommendation>& good) {
  const MedianInterval bar = least_cost(good);
  return best_by(good, [&](const auto& a, const auto& b) {
    const bool a_alike = !certainly_less(bar, a.cost), b_alike = !certainly_less(bar, b.cost);
    if (a_alike != b_alike) return a_alike;
    return a_alike && std::make_pair(a.error.worst, a.cost.middle) < std::make_pair(b.error.worst, b.cost.middle);
  });
}

Recommendation recommend(const Results& results, const std::vector<Recommendation>& good) {
  Recommendation found = answered(results, cheapest(good));
  if (found.outcome != Outcome::incomplete) found.noise = noise_of(good);
  return found;
}

Recommendation recommend(const Results& results) { return recommend(results, good_choices(results)); }

}  // namespace noonmark
