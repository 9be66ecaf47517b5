#include "compare/report/broken.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

std::string limits_text(const BoundResult& bound) {
  const std::string_view unit = bound_unit(bound);
  if (const std::optional<double> limit = broken_limit(bound))
    return fmt::format("{} {}", limit == bound.max ? "at most" : "at least",
                       quantity(*limit, unit, found_digits(bound, report_digits)));
  std::string out;
  if (bound.max) out = fmt::format("at most {}", quantity(*bound.max, unit));
  if (bound.min) out += fmt::format("{}at least {}", out.empty() ? "" : ", ", quantity(*bound.min, unit));
  return out;
}

std::string value_text(const BoundResult& bound) {
  if (std::isnan(bound.found)) return std::string(not_measured);
  return quantity(bound.found, bound_unit(bound), found_digits(bound, report_digits));
}

// " (mean of 4 points)"
std::string joined_text(const BoundResult& bound) {
  return bound.join == "worst" || bound.join.empty() ? "" : fmt::format(" ({} of {} points)", bound.join, bound.points);
}

std::string place_text(const BoundResult& bound) {
  return bound.placement == "worst" ? ", at the worst placement of the grid" : "";
}

// The swept settings but the curve's parameter, which set_bias_phrase() says.
std::string point_phrase(const PointRecord& point, const Results& results) {
  return settings_phrase(point, without_curve_parameter(point, results.info.swept));
}

// In the order of the experiment.
std::vector<const BoundResult*> broken_bounds(const Results& results) {
  std::vector<const BoundResult*> broken;
  for (const BoundResult& bound : results.bounds)
    if (breaks(bound)) broken.push_back(&bound);
  return broken;
}

}  // namespace

std::string set_bias_phrase(const PointRecord& point) {
  if (!has_curve(point)) return "";
  const std::string set = setting_of(point, curve_parameter(point));
  const std::optional<double> value = number_of(set);
  if (!value) return "";
  const PointRecord* const only[] = {&point};
  return fmt::format("a {} as set", named_bias(only, *value));
}

Markup failure_link(const BoundResult& bound, const Markup& content) {
  return element("a", Attribute("href", fmt::format("#p{}", bound.point)), Attribute("data-failure", bound.metric),
                 content);
}

BrokenWords broken_words(const Results& results) {
  const std::vector<const BoundResult*> broken = broken_bounds(results);
  if (broken.empty()) return {};
  const BoundResult& bound = *broken.front();
  BrokenWords words{&bound, fmt::format("The bound on {} fits no point", metric_label(bound.metric)), "", "."};
  if (bound.points > 0)
    words.before = fmt::format("{} is {}{} where {} is allowed{}", metric_label(bound.metric), value_text(bound),
                               joined_text(bound), limits_text(bound), place_text(bound));
  if (const PointRecord* point = find_point(results.points, bound.point)) {
    const std::string phrase = point_phrase(*point, results), bias = set_bias_phrase(*point);
    words.before += ", at ";
    words.subject = phrase.empty() ? fmt::format("point {}", point->id) : phrase;
    words.after = bias.empty() ? "." : fmt::format(", with {}.", bias);
  }
  if (broken.size() > 1)
    words.after += fmt::format(" {} more bound{} broken.", broken.size() - 1, broken.size() == 2 ? " is" : "s are");
  return words;
}

Markup broken_sentence(const Results& results) {
  const BrokenWords words = broken_words(results);
  if (words.subject.empty()) return words.text();
  return words.before + failure_link(*words.bound, words.subject) + words.after;
}

nlohmann::json failures_of(const PointRecord& point, const Results& results) {
  nlohmann::json out = nlohmann::json::array();
  for (const BoundResult& bound : results.bounds) {
    if (bound.held || bound.point != point.id) continue;
    const std::string bias = set_bias_phrase(point);
    nlohmann::json one{
        {"metric", bound.metric},
        {"label", metric_label(bound.metric)},
        {"text", fmt::format("{}: {} is {}{} where {} is allowed{}{}", verdict_of(bound), metric_label(bound.metric),
                             value_text(bound), joined_text(bound), limits_text(bound), place_text(bound),
                             bias.empty() ? "" : ", with " + bias)}};
    if (const auto worst = failing_pixel(bound, point)) {
      one["x"] = worst->x, one["y"] = worst->y;
      one["size"] = quantity(worst->size, find_quantity(worst->metric, {&point, 1}).unit);
      if (bound.placement == "worst") one["placement"] = "as set";
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace noonmark::report
