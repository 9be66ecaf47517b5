#include "compare/judge/choices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "compare/judge/curve_reading.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Groups the items by key(item), in order of appearance.
template <class Item, class Key>
std::vector<std::vector<Item>> grouped(const std::vector<Item>& items, const Key& key) {
  std::vector<std::vector<Item>> groups;
  std::unordered_map<std::string, size_t> known;
  for (const Item& item : items) {
    const auto [at, is_new] = known.emplace(key(item), groups.size());
    if (is_new) groups.emplace_back();
    groups[at->second].push_back(item);
  }
  return groups;
}

}  // namespace

bool decides_what_is_seen(const std::string& name) {
  for (const Setting& row : settings_table())
    if (row.name == name)
      return row.read_by.has(Stage::scene) || row.read_by.has(Stage::view) || row.read_by.has(Stage::truth);
  return true;
}

std::vector<std::string> conditions_of(const RunInfo& info) {
  std::vector<std::string> names = info.over;
  for (const std::string& name : info.swept)
    if (!is_in(info.over, name) && decides_what_is_seen(name)) names.push_back(name);
  return names;
}

std::vector<std::string> choice_settings(const RunInfo& info) {
  std::vector<std::string> names = info.swept;
  std::erase_if(names, [all = conditions_of(info)](const std::string& name) { return is_in(all, name); });
  return names;
}

std::vector<Choice> choices_of(const Results& results, const std::vector<std::string>& conditions) {
  std::vector<const PointRecord*> points;
  for (const PointRecord& point : results.points) points.push_back(&point);
  if (conditions.empty()) {
    std::vector<Choice> choices;
    for (const PointRecord* point : points) choices.push_back({{point}});
    return choices;
  }
  std::vector<Choice> choices;
  for (auto& group : grouped(points, [&](const PointRecord* point) {
         std::string key = point->part;
         for (const auto& [name, text] : point->settings)
           if (!is_in(conditions, name)) key += '\n' + text;
         return key;
       }))
    choices.push_back({std::move(group)});
  return choices;
}

std::vector<std::vector<Choice>> comparable_choices(const Results& results) {
  std::unordered_map<std::string, bool> decides;
  return grouped(choices_of(results, results.info.over), [&](const Choice& choice) {
    std::string key;
    for (const auto& [name, text] : choice.first().settings) {
      const auto [known, is_new] = decides.emplace(name, false);
      if (is_new) known->second = decides_what_is_seen(name) && !is_in(results.info.over, name);
      if (known->second) key += name + '=' + text + '\n';
    }
    return key;
  });
}

Joined joined_at(const Choice& choice, const std::string& metric, std::optional<double> bias) {
  Joined result{.worst = -std::numeric_limits<double>::infinity()};
  std::vector<double> values;
  for (const PointRecord* point : choice.points) {
    const double value =
        metric_at(*point, metric, bias ? std::optional(*bias / parameter_per_depth(*point)) : std::nullopt);
    if (!std::isfinite(value)) {
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      return {nan, nan, nan, point};
    }
    if (choice.points.size() == 1) return {value, value, value, point};
    values.push_back(value);
    result.mean += value / static_cast<double>(choice.points.size());
    if (value > result.worst) result.worst = value, result.at = point;
  }
  // The nearest rank: the least value that 95% of the conditions do not exceed.
  std::sort(values.begin(), values.end());
  result.p95 = values[static_cast<size_t>(std::ceil(0.95 * static_cast<double>(values.size()))) - 1];
  return result;
}

Joined joined(const Choice& choice, const std::string& metric) { return joined_at(choice, metric, std::nullopt); }

bool has_curves(const Choice& choice) {
  const PointRecord& first = choice.first();
  return std::all_of(choice.points.begin(), choice.points.end(), [&](const PointRecord* point) {
    return has_curve(*point) && curve_parameter(*point) == curve_parameter(first) &&
           curve_unit(*point) == curve_unit(first);
  });
}

std::optional<Interval> joined_window(const Choice& choice) {
  if (!has_curves(choice)) return std::nullopt;
  Interval all{0, std::numeric_limits<double>::infinity()};
  for (const PointRecord* point : choice.points) {
    const std::optional<Interval> window = usable_window(*point);
    if (!window) return std::nullopt;
    const double per_depth = parameter_per_depth(*point);
    all.low = std::max(all.low, window->low * per_depth);
    all.high = std::min(all.high, window->high * per_depth);
  }
  if (!(all.low <= all.high)) return std::nullopt;
  return all;
}

}  // namespace noonmark
