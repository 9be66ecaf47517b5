#include "compare/judge/bounds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "compare/judge/poor_view.h"
#include "compare/judge/undecided.h"
#include "compare/store/quantities.h"
#include "scenes/error.h"
#include "scenes/text.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view joins[] = {"worst", "mean", "median"};

[[noreturn]] void refuse(const Bound& bound, const std::string& why) {
  throw Error(ErrorKind::usage, fmt::format("bound on '{}': {}", bound.metric, why));
}

struct Value {
  const PointRecord* point;
  double value;
};

bool by_value(const Value& a, const Value& b) { return a.value < b.value; }

double median(std::vector<Value> values) {
  std::sort(values.begin(), values.end(), by_value);
  const size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle].value;
  return values[middle - 1].value / 2 + values[middle].value / 2;
}

// values: all finite, at least one.
void judge(const Bound& bound, const std::vector<Value>& values, BoundResult& result) {
  const Value largest = *std::max_element(values.begin(), values.end(), by_value);
  const Value smallest = *std::min_element(values.begin(), values.end(), by_value);
  const auto below_min = [&](double value) { return bound.min && !(value >= *bound.min); };
  const auto above_max = [&](double value) { return bound.max && !(value <= *bound.max); };

  if (bound.join == "worst") {
    const bool from_below = !bound.max || (below_min(smallest.value) && !above_max(largest.value));
    const Value worst = from_below ? smallest : largest;
    result.found = worst.value;
    result.point = worst.point->id;
  } else {
    if (bound.join == "mean")
      result.found =
          std::accumulate(values.begin(), values.end(), 0.0, [](double sum, const Value& v) { return sum + v.value; }) /
          static_cast<double>(values.size());
    else
      result.found = median(values);
    const bool from_below = !bound.max || (below_min(result.found) && !above_max(result.found));
    result.point = (from_below ? smallest : largest).point->id;
  }
  // A sum of finite values can overflow, so a joined value that is not finite breaks the bound too.
  result.held = std::isfinite(result.found) && !below_min(result.found) && !above_max(result.found);
}

BoundResult evaluate(std::span<const PointRecord> points, const Bound& bound) {
  check_bound(bound, points);
  BoundResult result;
  result.metric = bound.metric;
  result.max = bound.max;
  result.min = bound.min;
  result.join = bound.join;
  result.where = bound.where;

  std::vector<Value> values;
  for (const PointRecord& point : points)
    if (matches(point, bound.where)) values.push_back({&point, quantity(point, bound.metric).value_or(not_a_number)});
  result.points = static_cast<int>(values.size());
  result.found = not_a_number;
  if (values.empty()) return result;

  const auto bad = std::find_if(values.begin(), values.end(), [](const Value& v) { return !std::isfinite(v.value); });
  if (bad != values.end()) {
    result.found = bad->value;
    result.point = bad->point->id;
    return result;
  }
  judge(bound, values, result);
  return result;
}

std::string point_text(const PointRecord& point, std::span<const std::string> swept) {
  std::vector<std::string> parts;
  for (const std::string& name : swept) {
    const auto setting = point.settings.find(name);
    if (setting != point.settings.end()) parts.push_back(fmt::format("{} = {}", name, setting->second));
  }
  return fmt::format("point {}{}{}", point.id, parts.empty() ? "" : ": ", fmt::join(parts, ", "));
}

}  // namespace

void check_bound(const Bound& bound, std::span<const PointRecord> points) {
  find_quantity(bound.metric, points);
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
  try {
    check_conditions(bound.where);
  } catch (const Error& error) {
    refuse(bound, error.what());
  }
}

std::vector<BoundResult> evaluate_bounds(std::span<const PointRecord> points, std::span<const Bound> bounds,
                                         const std::function<std::string(const PointRecord&)>& reproduce) {
  std::vector<BoundResult> results;
  for (const Bound& bound : bounds) {
    results.push_back(evaluate(points, bound));
    if (const PointRecord* worst = find_point(points, results.back().point))
      results.back().reproduce = reproduce(*worst);
  }
  return results;
}

std::string bound_text(const BoundResult& bound) {
  std::string text;
  if (bound.min && bound.max)
    text = fmt::format("{} <= {} <= {}", *bound.min, bound.metric, *bound.max);
  else if (bound.max)
    text = fmt::format("{} <= {}", bound.metric, *bound.max);
  else
    text = fmt::format("{} >= {}", bound.metric, bound.min.value_or(not_a_number));
  std::string_view word = " where ";
  for (const auto& [name, values] : bound.where) {
    text += fmt::format("{}{} = {}", word, name, fmt::join(values, " | "));
    word = " and ";
  }
  return bound.join == "worst" ? text : fmt::format("{} ({})", text, bound.join);
}

std::string found_text(const BoundResult& bound) {
  return std::isnan(bound.found) ? std::string(not_measured) : fmt::format("{}", bound.found);
}

std::string describe(const BoundResult& bound, const PointRecord* point, std::span<const std::string> swept) {
  std::string text = fmt::format("{}: {}", bound.held ? "held" : "broken", bound_text(bound));
  if (bound.points == 0) return text + "\n  no finished point matches it; change its where, or the swept values\n";
  text += fmt::format("; found {} ({} of {} point{})\n", found_text(bound), bound.join, bound.points,
                      bound.points == 1 ? "" : "s");
  if (bound.held) {
    const std::string doubt = point ? undecided_note(bound, *point) : "";
    return doubt.empty() ? text : text + fmt::format("  {}\n", doubt);
  }

  if (!std::isfinite(bound.found)) text += "  a value that could not be measured breaks every bound\n";
  if (const std::string poor = point ? why_poor_view(*point) : ""; !poor.empty()) text += fmt::format("  {}\n", poor);
  if (point && find_quantity(bound.metric, {point, 1}).of_curve && !nothing_judged(*point) &&
      !why_no_curve(*point).empty())
    text += fmt::format("  it is read off the bias curve, but this point has no curve: {}\n", why_no_curve(*point));
  if (point) {
    text += fmt::format("  {}\n", point_text(*point, swept));
    if (point->worst.x >= 0)
      text += fmt::format("  worst pixel by |{} - R1|: x = {}, y = {} (row 0 on top), error {}{}{}\n",
                          judged_rung(*point), point->worst.x, point->worst.y, point->worst.error,
                          point->worst.cause.empty() ? "" : ", ", point->worst.cause);
  }
  if (!bound.reproduce.empty()) text += fmt::format("  reproduce: {}\n", bound.reproduce);
  return text;
}

const PointRecord* find_point(std::span<const PointRecord> points, int64_t id) {
  const auto found = std::find_if(points.begin(), points.end(), [id](const PointRecord& p) { return p.id == id; });
  return found == points.end() ? nullptr : &*found;
}

}  // namespace noonmark
