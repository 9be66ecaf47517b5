#include "compare/judge/bounds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/text.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/no_flicker.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/undecided.h"
#include "compare/ladder/numbers.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

constexpr std::string_view joins[] = {"worst", "mean", "median"};
constexpr std::string_view placements[] = {"worst", "first"};

[[noreturn]] void refuse(const Bound& bound, const std::string& why) {
  throw Error(ErrorKind::usage, fmt::format("bound on '{}': {}", bound.metric, why));
}

struct Value {
  const PointRecord* point;
  double value;
  double room = 0;  // ambiguous_room()
};

bool by_value(const Value& a, const Value& b) { return a.value < b.value; }

double median(std::vector<Value> values) {
  std::sort(values.begin(), values.end(), by_value);
  const size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle].value;
  return values[middle - 1].value / 2 + values[middle].value / 2;
}

// The values that a bound compares with its limits, one for each point. Without placements both are the same.
struct Values {
  std::vector<Value> for_max, for_min;
};

double mean(const std::vector<Value>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0, [](double sum, const Value& v) { return sum + v.value; }) /
         static_cast<double>(values.size());
}

// Whether the bound, which the values hold, would hold too if what is ambiguous were the worst for it.
bool surely_holds(const Bound& bound, Values values) {
  const auto joined = [&](const std::vector<Value>& list, auto extreme) {
    return bound.join == "mean"     ? mean(list)
           : bound.join == "median" ? median(list)
                                    : extreme(list.begin(), list.end(), by_value)->value;
  };
  for (Value& one : values.for_max) one.value += one.room;
  for (Value& one : values.for_min) one.value -= one.room;
  return !(bound.max && joined(values.for_max, [](auto... all) { return std::max_element(all...); }) > *bound.max) &&
         !(bound.min && joined(values.for_min, [](auto... all) { return std::min_element(all...); }) < *bound.min);
}

// values: all finite, at least one.
void judge(const Bound& bound, const Values& values, BoundResult& result) {
  const Value largest = *std::max_element(values.for_max.begin(), values.for_max.end(), by_value);
  const Value smallest = *std::min_element(values.for_min.begin(), values.for_min.end(), by_value);
  const auto below_min = [&](double value) { return bound.min && !(value >= *bound.min); };
  const auto above_max = [&](double value) { return bound.max && !(value <= *bound.max); };

  double high = largest.value, low = smallest.value;
  if (bound.join != "worst") {
    const auto joined = [&](const std::vector<Value>& list) {
      return bound.join == "mean" ? mean(list) : median(list);
    };
    high = joined(values.for_max);
    low = joined(values.for_min);
  }
  const bool from_below = !bound.max || (below_min(low) && !above_max(high));
  result.found = from_below ? low : high;
  result.point = (from_below ? smallest : largest).point->id;
  // A sum of finite values can overflow, so a joined value that is not finite breaks the bound too.
  result.held = std::isfinite(result.found) && !below_min(result.found) && !above_max(result.found);
  if (!result.held || surely_holds(bound, values)) return;
  result.held = false;
  result.found = not_a_number;
  result.point = std::max_element(values.for_max.begin(), values.for_max.end(), [](const Value& a, const Value& b) {
                   return a.room < b.room;
                 })->point->id;
}

// The largest or the least of a point's quantities of these names. Not a number if one of them is missing.
template <class Better>
double extreme_of(const PointRecord& point, const std::vector<std::string>& names, const Better& better) {
  double found = not_a_number;
  for (const std::string& name : names) {
    const double value = quantity(point, name).value_or(not_a_number);
    if (!std::isfinite(value)) return value;
    if (std::isnan(found) || better(value, found)) found = value;
  }
  return found;
}

bool is_of_view(const std::string& setting) { return setting.starts_with("view."); }

// Whether the conditions name a view, and it is the first point's own.
bool names_given_view(const Conditions& where, std::span<const PointRecord> points) {
  Conditions view = where;
  std::erase_if(view, [](const auto& one) { return !is_of_view(one.first); });
  const bool one_view = std::all_of(view.begin(), view.end(), [](const auto& one) { return one.second.size() == 1; });
  return !view.empty() && one_view && !points.empty() && matches(points.front(), view);
}

BoundResult evaluate(std::span<const PointRecord> points, const Bound& bound) {
  check_bound(bound, points);
  BoundResult result;
  result.metric = bound.metric;
  result.max = bound.max;
  result.min = bound.min;
  result.join = bound.join;
  result.where = bound.where;
  result.warns = bound.level == "warn";
  result.location = bound.location;
  result.at_given_view = names_given_view(bound.where, points);

  const PlacedNames placed = placed_names(bound.metric);
  Values values;
  for (const PointRecord& point : points) {
    if (!matches(point, bound.where)) continue;
    if (!point.delivery.refused.empty()) continue;  // its verdict is that no bound is judged
    double high = quantity(point, bound.metric).value_or(not_a_number), low = high;
    if (!placed.largest.empty() && has_placements(point)) {
      result.placement = bound.placement;
      if (bound.placement == "worst") {
        high = extreme_of(point, placed.largest, std::greater<>());
        low = extreme_of(point, placed.least, std::less<>());
      }
    }
    const double room = ambiguous_room(point, bound.metric);
    values.for_max.push_back({&point, high, room});
    values.for_min.push_back({&point, low, room});
  }
  result.points = static_cast<int>(values.for_max.size());
  result.found = not_a_number;
  if (values.for_max.empty()) return result;

  for (const auto* list : {&values.for_max, &values.for_min})
    for (const Value& value : *list)
      if (!std::isfinite(value.value)) {
        result.found = value.value;
        result.point = value.point->id;
        return result;
      }
  judge(bound, values, result);
  return result;
}

// The bias or reduction at which a bound was judged, where a curve shows that others are possible: "bias.constant = 2 texel".
// Empty without a curve.
std::string bias_text(const PointRecord& point) {
  if (!has_curve(point)) return "";
  const std::string value = setting_of(point, curve_parameter(point));
  const std::string unit = curve_unit(point);
  return value.empty()
             ? ""
             : fmt::format("{} = {}{}{}", curve_parameter(point), setting_text(value), unit.empty() ? "" : " ", unit);
}

// Limits are typed by a person, so they keep more digits than what is found.
constexpr int limit_digits = 9;

std::string point_text(const PointRecord& point, std::span<const std::string> swept) {
  std::vector<std::string> parts;
  for (const std::string& name : swept) {
    const auto setting = point.settings.find(name);
    if (setting != point.settings.end()) parts.push_back(fmt::format("{} = {}", name, setting_text(setting->second)));
  }
  if (const std::string bias = bias_text(point);
      !bias.empty() && std::find(swept.begin(), swept.end(), curve_parameter(point)) == swept.end())
    parts.push_back(bias);
  return fmt::format("point {}{}{}", point.id, parts.empty() ? "" : ": ", fmt::join(parts, ", "));
}

constexpr std::string_view wildcards = "*?";

bool is_pattern(const std::string& name) { return name.find_first_of(wildcards) != std::string::npos; }

// On a mismatch the last * takes one character more, so the time is at most the product of both lengths.
bool fits(std::string_view name, std::string_view pattern) {
  size_t at = 0, in_pattern = 0, star = std::string_view::npos, taken = 0;
  while (at < name.size()) {
    if (in_pattern < pattern.size() && pattern[in_pattern] == '*') {
      star = in_pattern++;
      taken = at;
    } else if (in_pattern < pattern.size() && (pattern[in_pattern] == '?' || pattern[in_pattern] == name[at])) {
      ++at;
      ++in_pattern;
    } else if (star != std::string_view::npos) {
      in_pattern = star + 1;
      at = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', in_pattern) == std::string_view::npos;
}

// given_view: the view's numbers are left out, and "at the given view" stands in their place.
std::string words_of(const BoundResult& bound, bool given_view) {
  const auto limit = [unit = bound_unit(bound)](double value) { return quantity_text(value, unit, limit_digits); };
  std::string text;
  if (bound.min && bound.max)
    text = fmt::format("{} <= {} <= {}", limit(*bound.min), bound.metric, limit(*bound.max));
  else if (bound.max)
    text = fmt::format("{} <= {}", bound.metric, limit(*bound.max));
  else
    text = fmt::format("{} >= {}", bound.metric, limit(bound.min.value_or(not_a_number)));
  if (given_view) text += " at the given view";
  std::string_view word = " where ";
  for (const auto& [name, values] : bound.where) {
    if (given_view && is_of_view(name)) continue;
    text += fmt::format("{}{} = {}", word, name, fmt::join(values, " | "));
    word = " and ";
  }
  std::vector<std::string_view> how;
  if (bound.join != "worst") how.push_back(bound.join);
  if (!bound.placement.empty()) how.push_back(placement_text(bound));
  return how.empty() ? text : fmt::format("{} ({})", text, fmt::join(how, ", "));
}

// Every point with a curve has the curve's quantities, but those of all placements only if there are several.
bool is_measured(const PointRecord& point, const QuantityInfo& info) {
  if (!info.of_curve) return point.metrics.contains(std::string(info.name));
  return point.curve && (has_placements(point) || info.name.find("_worst") == std::string_view::npos);
}

}  // namespace

std::vector<QuantityInfo> quantities_named(const std::string& name, std::span<const PointRecord> points) {
  if (!is_pattern(name)) return {find_quantity(name, points)};
  std::vector<std::string_view> all;
  const std::vector<Metric> metrics = metrics_of(points);
  for (const Metric& row : metrics) all.push_back(row.name);
  for (const CurveQuantity& row : curve_quantities()) all.emplace_back(row.name);
  std::vector<QuantityInfo> found;
  for (const std::string_view one : all)
    if (fits(one, name)) found.push_back(find_quantity(one, points));
  if (!found.empty()) return found;
  std::string letters = name;
  std::erase_if(letters, [](char c) { return wildcards.find(c) != std::string_view::npos; });
  const std::string near = nearest_name(letters, all);
  throw Error(ErrorKind::usage, fmt::format("no metric fits '{}'{}", name,
                                            near.empty() ? " (noonmark settings lists them)"
                                                         : fmt::format("; the nearest name is '{}'", near)));
}

std::vector<Bound> expanded(const Bound& bound, std::span<const PointRecord> points) {
  if (!is_pattern(bound.metric)) return {bound};
  std::vector<Bound> all, measured;
  for (const QuantityInfo& info : quantities_named(bound.metric, points)) {
    all.push_back(bound);
    all.back().metric = info.name;
    if (std::any_of(points.begin(), points.end(),
                    [&](const PointRecord& point) { return matches(point, bound.where) && is_measured(point, info); }))
      measured.push_back(all.back());
  }
  return measured.empty() ? all : measured;
}

void check_bound(const Bound& bound, std::span<const PointRecord> points) {
  quantities_named(bound.metric, points);
  if (!bound.max && !bound.min) refuse(bound, "has neither max nor min; give one of them");
  for (const std::optional<double>& limit : {bound.max, bound.min})
    if (limit && !std::isfinite(*limit)) refuse(bound, "max and min must be finite numbers");
  if (bound.max && bound.min && *bound.min > *bound.max)
    refuse(bound, fmt::format("min = {} is above max = {}", *bound.min, *bound.max));
  if (std::find(std::begin(joins), std::end(joins), bound.join) == std::end(joins)) {
    const std::string near = nearest_name(bound.join, joins);
    refuse(bound, fmt::format("join = '{}' is not one of worst | mean | median{}", bound.join,
                              near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
  }
  if (std::find(std::begin(placements), std::end(placements), bound.placement) == std::end(placements))
    refuse(bound, fmt::format("placement = '{}' is not one of worst | first", bound.placement));
  if (bound.level != "error" && bound.level != "warn")
    refuse(bound, fmt::format("level = '{}' is not one of error | warn", bound.level));
  try {
    check_conditions(bound.where);
  } catch (const Error& error) {
    refuse(bound, error.what());
  }
}

std::vector<BoundResult> evaluate_bounds(std::span<const PointRecord> points, std::span<const Bound> bounds,
                                         const std::function<std::string(const PointRecord&)>& reproduce) {
  std::vector<BoundResult> results;
  for (const Bound& pattern : bounds)
    for (const Bound& bound : expanded(pattern, points)) {
      results.push_back(evaluate(points, bound));
      if (const PointRecord* worst = find_point(points, results.back().point))
        results.back().reproduce = reproduce(*worst);
    }
  return results;
}

std::string_view verdict_of(const BoundResult& bound) {
  return bound.held ? "held" : bound.warns ? "warning" : "broken";
}

std::string bound_text(const BoundResult& bound) { return words_of(bound, false); }

std::string_view bound_unit(const BoundResult& bound) {
  return quantity_unit(bound.metric, "fraction");  // that of the cause of a rung on top of R5
}

std::optional<double> broken_limit(const BoundResult& bound) {
  if (bound.held || !std::isfinite(bound.found)) return std::nullopt;
  if (bound.max && bound.found > *bound.max) return bound.max;
  if (bound.min && bound.found < *bound.min) return bound.min;
  return std::nullopt;
}

int found_digits(const BoundResult& bound, int least) {
  const std::optional<double> limit = broken_limit(bound);
  return limit ? digits_to_tell(bound.found, *limit, least) : least;
}

std::optional<PointRecord::WorstOf> failing_pixel(const BoundResult& bound, const PointRecord& point) {
  // Too little of something is at no pixel.
  if (bound.held || !bound.max || !(bound.found > *bound.max)) return std::nullopt;
  return worst_pixel_of(point, bound.metric);
}

std::string failing_pixel_text(const BoundResult& bound, const PointRecord& point) {
  const std::optional<PointRecord::WorstOf> worst = failing_pixel(bound, point);
  if (!worst) return "";
  const bool error = worst->metric == "error" || worst->metric == "wrong";
  return fmt::format("worst pixel by {}{}: x = {}, y = {} (row 0 on top), {} {}{}",
                     error ? fmt::format("|{} - R1|", judged_rung(point)) : worst->metric,
                     bound.placement == "worst" ? ", at placement 0" : "", worst->x, worst->y,
                     error ? "error" : worst->metric,
                     quantity_text(worst->size, quantity_unit(worst->metric, "fraction")),
                     error && !point.worst.cause.empty() ? ", " + point.worst.cause : "");
}

std::string_view placement_text(const BoundResult& bound) {
  return bound.placement.empty() ? "" : bound.placement == "worst" ? "worst placement" : "placement 0";
}

double room_of(const BoundResult& bound, std::span<const PointRecord> points) {
  const PointRecord* const point = find_point(points, bound.point);
  return point ? ambiguous_room(*point, bound.metric) : 0;
}

std::string found_text(const BoundResult& bound, std::span<const PointRecord> points) {
  return text_with_room(bound.found, std::isfinite(bound.found) ? room_of(bound, points) : 0, bound_unit(bound),
                        found_digits(bound));
}

std::string describe(const BoundResult& bound, const PointRecord* point, std::span<const std::string> swept) {
  std::string text = fmt::format("{}: {}", verdict_of(bound), printable(words_of(bound, bound.at_given_view)));
  if (is_of_lights(bound.metric))
    text += " of the frame of lights";
  else if (!bound.part.empty())
    text += fmt::format(" in part {}", printable(bound.part));
  if (bound.points == 0)
    return text +
           "\n  no finished point matches it; change its where, or the swept values (a refused frame matches "
           "nothing)\n";
  text += fmt::format("; found {} ({} of {} point{}{}{})\n", found_text(bound, {point, size_t{point != nullptr}}),
                      bound.join, bound.points, bound.points == 1 ? "" : "s", bound.placement.empty() ? "" : ", at ",
                      bound.placement == "worst" ? "the worst placement of the grid" : placement_text(bound));
  if (bound.held) {
    const std::string doubt = point ? undecided_note(bound, *point) : "";
    return doubt.empty() ? text : text + fmt::format("  {}\n", doubt);
  }

  if (point && !std::isfinite(bound.found) && ambiguous_room(*point, bound.metric) > 0)
    text += "  not known to hold: the receivers whose truth is ambiguous could break it\n";
  else if (!std::isfinite(bound.found))
    text += "  a value that could not be measured breaks every bound\n";
  const Metric* const metric = metric_named(bound.metric);
  if (point && !point->metrics.contains(bound.metric) && metric && metric->is(Metric::moments))
    text += fmt::format(
        "  {} is measured only of a lookup in a map of moments; give those lookups a [[part]] and the bound as "
        "[[part.bound]]\n",
        bound.metric);
  if (const std::string poor = point ? why_poor_view(*point) : "";
      !poor.empty() && poor != ambiguous_note(*point))  // a note of the whole run says that once
    text += fmt::format("  {}\n", poor);
  if (const std::string why =
          point && std::isnan(bound.found) && bound.metric.starts_with("flicker") ? why_no_flicker(*point) : "";
      !why.empty())
    text += fmt::format("  {}\n", why);
  if (point && curve_quantity(bound.metric) && !nothing_judged(*point) && !why_no_curve(*point).empty())
    text += fmt::format("  it is read off the bias curve, but this point has no curve: {}\n", why_no_curve(*point));
  if (point) {
    text += fmt::format("  {}\n", printable(point_text(*point, swept)));
    if (const std::string worst = failing_pixel_text(bound, *point); !worst.empty())
      text += fmt::format("  {}\n", printable(worst));
  }
  if (!bound.reproduce.empty()) text += fmt::format("  reproduce: {}\n", bound.reproduce);
  return text;
}

const PointRecord* find_point(std::span<const PointRecord> points, int64_t id) {
  const auto found = std::find_if(points.begin(), points.end(), [id](const PointRecord& p) { return p.id == id; });
  return found == points.end() ? nullptr : &*found;
}

}  // namespace noonmark
