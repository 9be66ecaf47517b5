#include "compare/report/speed_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/text.h"
#include "compare/judge/recommendation.h"
#include "compare/report/cause_shares.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

constexpr size_t most_stretches = 6;  // a sentence with more is not read

std::vector<CostAndError> places_on(const std::vector<FrontPoint>& plane) {
  std::vector<CostAndError> places;
  for (const FrontPoint& one : plane) places.push_back({one.cost.middle, one.error});
  return places;
}

bool is_finite(const CostAndError& one) { return std::isfinite(one.cost) && std::isfinite(one.error); }

std::vector<std::vector<size_t>> curves_of(const ComparedGroup& group, const Techniques& techniques,
                                           const std::vector<CostAndError>& places) {
  std::vector<std::map<double, size_t>> by_scale(techniques.first.size());
  for (size_t i = 0; i < places.size(); ++i) {
    if (!is_finite(places[i])) continue;
    const double scale = techniques.scale.empty()
                             ? 0
                             : number_of(setting_of(group.choices[i].choice.first(), techniques.scale)).value_or(0);
    const auto [at, is_new] = by_scale[techniques.of[i]].emplace(scale, i);
    if (!is_new && places[i].error < places[at->second].error) at->second = i;
  }
  std::vector<std::vector<size_t>> curves;
  for (const auto& steps : by_scale) {
    curves.emplace_back();
    for (const auto& [scale, choice] : steps) curves.back().push_back(choice);
  }
  return curves;
}

std::vector<CheapestStretch> stretches_of(const SpeedReading& reading, const Techniques& techniques,
                                          const std::vector<CostAndError>& places) {
  std::vector<std::vector<CostAndError>> lines(reading.curves.size());
  for (size_t i : reading.front) {
    const size_t technique = techniques.of[i];
    if (lines[technique].empty())
      for (size_t choice : reading.curves[technique]) lines[technique].push_back(places[choice]);
  }
  return least_errors(lines);
}

std::optional<ThreeAnswers> answers_of(const ComparedGroup& group, std::vector<CostAndError> places) {
  const auto drop = [&](size_t i) { places[i].error = std::numeric_limits<double>::quiet_NaN(); };
  const auto good = [&](size_t i) { return group.choices[i].good.has_value(); };
  bool any_good = false;
  for (size_t i = 0; i < places.size(); ++i) any_good |= good(i) && is_finite(places[i]);
  for (size_t i = 0; i < places.size(); ++i)
    if (any_good && !good(i)) drop(i);
  // The three lie on the front of these, and of a thousand choices it is quicker to ask that alone.
  std::vector<FrontPoint> points;
  for (const CostAndError& one : places) points.push_back({{one.cost, one.cost, one.cost}, one.error});
  std::vector<bool> on_front(places.size());
  for (size_t i : pareto_front(points)) on_front[i] = true;
  for (size_t i = 0; i < places.size(); ++i)
    if (!on_front[i]) drop(i);
  return three_answers(places, std::nullopt);
}

std::string unit_of(const std::string& metric) { return std::string(find_metric(metric).unit); }

// A label within a sentence: "error against the hard truth".
std::string in_sentence(std::string label) {
  if (label.size() > 1 && std::islower(static_cast<unsigned char>(label[1])))
    label[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(label[0])));
  return label;
}

// To two significant digits.
double rounded(double value) {
  if (!(value > 0) || !std::isfinite(value)) return value;
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(value / step) * step;
}

// The cause within a sentence.
std::string cause_text(const std::string& cause) {
  if (cause == "filter") return "filter's blur";
  return cause == "peter_panning" ? "Peter Panning" : cause;
}

}  // namespace

SpeedReadings::SpeedReadings(const ComparedGroup& group, const Results& results)
    : SpeedReadings(group, techniques_of(group, results), results) {}

SpeedReadings::SpeedReadings(const ComparedGroup& group, Techniques techniques, const Results& results)
    : group_(group), techniques_(std::move(techniques)), is_incomplete_(is_incomplete(results)) {}

std::vector<FrontPoint> SpeedReadings::plane(const std::string& cost, const std::string& error, AtBias at) const {
  const auto [costs, new_cost] = costs_.try_emplace(cost);
  if (new_cost)
    for (const ComparedChoice& one : group_.choices) costs->second.push_back(cost_of(one, cost));
  const auto [errors, new_error] = errors_.try_emplace({error, at});
  if (new_error)
    for (const ComparedChoice& one : group_.choices) errors->second.push_back(error_in_plane(one, error, at));
  std::vector<FrontPoint> plane;
  for (size_t i = 0; i < group_.choices.size(); ++i) plane.push_back({costs->second[i], errors->second[i]});
  return plane;
}

SpeedReading SpeedReadings::of(const std::string& cost, const std::string& error, AtBias at) const {
  SpeedReading reading{cost, error, at, {}, {}, {}, {}};
  const std::vector<FrontPoint> all = plane(cost, error, at);
  std::vector<CostAndError> places = places_on(all);
  reading.curves = curves_of(group_, techniques_, places);
  reading.front = pareto_front(all);
  reading.stretches = stretches_of(reading, techniques_, places);
  if (!is_incomplete_) reading.answers = answers_of(group_, std::move(places));
  return reading;
}

std::string SpeedReadings::name_of(size_t technique, const ChoiceNames& names) const {
  return names.technique(group_.choices[techniques_.first[technique]].choice, techniques_.scale);
}

std::vector<Phrase> SpeedReadings::takeovers(const SpeedReading& reading, const ChoiceNames& names) const {
  const std::vector<CheapestStretch>& all = reading.stretches;
  if (techniques_.first.size() < 2 || all.empty()) return {};
  if (all.size() == 1) return why(reading, names);
  // A crossing lies between measured choices, so it is not known better.
  const auto cost = [&](size_t i) { return quantity(rounded(all[i].from), unit_of(reading.cost)); };
  std::vector<Phrase> out{{fmt::format("Least {} by {}: ", in_sentence(error_label(reading.error)),
                                       in_sentence(metric_label(reading.cost)))}};
  const size_t said = std::min(all.size(), most_stretches);
  for (size_t i = 0; i < said; ++i) {
    out.push_back({name_of(all[i].curve, names), true});
    out.push_back({i == 0               ? fmt::format(" up to {}; ", cost(1))
                   : i + 1 < all.size() ? fmt::format(" from there to {}; ", cost(i + 1))
                                        : " above."});
  }
  if (said < all.size()) out.push_back({fmt::format("above, {} more.", counted(all.size() - said, "change"))});
  return out;
}

std::vector<Phrase> SpeedReadings::why(const SpeedReading& reading, const ChoiceNames& names) const {
  const size_t winner = reading.stretches.front().curve;
  const std::vector<CostAndError> places = places_on(plane(reading.cost, reading.error, reading.at));
  const auto place = [&](size_t i) { return places[i]; };
  const auto less = [&](size_t a, size_t b) {
    return std::pair(place(a).error, place(a).cost) < std::pair(place(b).error, place(b).cost);
  };
  const std::vector<size_t>& curve = reading.curves[winner];
  const size_t best = *std::min_element(curve.begin(), curve.end(), less);
  // Of the other techniques: the least error at most as dear, or at any cost. One that is as good has nothing to explain.
  std::optional<size_t> next;
  const auto take = [&](size_t i, double most_cost) {
    if (place(i).cost <= most_cost && place(i).error > error_that_differs * place(best).error &&
        (!next || less(i, *next)))
      next = i;
  };
  for (double most_cost : {place(best).cost, std::numeric_limits<double>::infinity()}) {
    if (next) break;
    for (size_t technique = 0; technique < reading.curves.size(); ++technique)
      if (technique != winner)
        for (size_t i : reading.curves[technique]) take(i, most_cost);
  }
  std::vector<Phrase> out{{name_of(winner, names), true},
                          {fmt::format(" has the least {} at every cost.", in_sentence(error_label(reading.error)))}};
  if (!next) return out;
  const auto error = [&](size_t i) { return quantity(place(i).error, unit_of(reading.error)); };
  out.push_back({fmt::format(" At {} it has {}, and the next, ", quantity(place(best).cost, unit_of(reading.cost)),
                             error(best))});
  out.push_back({name_of(techniques_.of[*next], names), true});
  // The causes are steps of these errors, and of no other one.
  std::optional<MoreOf> more;
  if (reading.error == "error" || reading.error == "error_soft")
    more = more_of(group_.choices[*next], group_.choices[best], reading.at);
  out.push_back({fmt::format(" at {}, has {}{}.", quantity(place(*next).cost, unit_of(reading.cost)), error(*next),
                             more ? fmt::format(", because of its {}: {} against {}", cause_text(more->cause),
                                                quantity(more->one, "fraction"), quantity(more->other, "fraction"))
                                  : "")});
  return out;
}

std::vector<int64_t> answer_points(const std::vector<ComparedGroup>& groups, const Results& results) {
  std::vector<Techniques> techniques;
  for (const ComparedGroup& group : groups) techniques.push_back(techniques_of(group, results));
  return answer_points(groups, techniques, results);
}

std::vector<int64_t> answer_points(const std::vector<ComparedGroup>& groups, const std::vector<Techniques>& techniques,
                                   const Results& results) {
  const std::string error = error_shown_first(results);
  std::vector<int64_t> ids;
  for (size_t which = 0; which < groups.size(); ++which) {
    const ComparedGroup& group = groups[which];
    const SpeedReading reading =
        SpeedReadings(group, techniques[which], results).of(results.info.cost, error, AtBias::best);
    if (!reading.answers) continue;
    for (size_t i : {reading.answers->least, reading.answers->balanced, reading.answers->best})
      if (const PointRecord* at = value_of(group.choices[i], error).at;
          at && std::find(ids.begin(), ids.end(), at->id) == ids.end())
        ids.push_back(at->id);
  }
  return ids;
}

}  // namespace noonmark::report
