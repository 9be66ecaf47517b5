#include "compare/report/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "compare/judge/curve_reading.h"
#include "compare/judge/techniques.h"
#include "compare/report/cause_shares.h"
#include "compare/report/speed_reading.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark::report {
namespace {

using nlohmann::json;
using Window = ComparedChoice::Window;

template <size_t count>
std::vector<std::string> measured(const Results& results, const std::string& first,
                                  const std::array<const char*, count>& others) {
  std::vector<std::string> names{first};
  for (const char* name : others)
    if (name != first) names.emplace_back(name);
  std::stable_partition(names.begin() + 1, names.end(), [&](const std::string& name) {
    return std::find(results.info.plot.begin(), results.info.plot.end(), name) != results.info.plot.end();
  });
  std::erase_if(names, [&](const std::string& name) {
    return std::none_of(results.points.begin(), results.points.end(),
                        [&](const PointRecord& point) { return std::isfinite(metric_of(point, name)); });
  });
  return names;
}

json or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

// A property by which the choices of a group can be told apart: the filter, the part, or a swept setting.
struct Property {
  std::string setting;  // empty: the part
  std::vector<std::string> values;
};

const std::string& value_of_property(const Property& property, const Choice& choice) {
  const PointRecord& point = choice.first();
  if (property.setting.empty()) return point.part;
  static const std::string none;
  const auto found = point.settings.find(property.setting);
  return found == point.settings.end() ? none : found->second;
}

// Those with several values, what is told apart first in front: the lookup, the filter, the part, then the swept settings.
// Where a part has a lookup of its own, the part names it better, with the parameters of the lookup.
std::vector<Property> properties_of(const ComparedGroup& group, const Results& results) {
  std::set<std::string> lookups;
  for (const ComparedChoice& one : group.choices) lookups.insert(setting_of(one.choice.first(), "lookup.kind"));
  std::vector<std::string> settings{"filter.kind", ""};
  if (lookups.size() > 1) settings = {"", "lookup.kind", "filter.kind"};
  for (const std::string& name : choice_settings(results.info))
    if (std::find(settings.begin(), settings.end(), name) == settings.end()) settings.push_back(name);
  std::vector<Property> properties;
  for (const std::string& setting : settings) {
    Property property{setting, {}};
    std::set<std::string> known;
    for (const ComparedChoice& one : group.choices)
      if (const std::string& value = value_of_property(property, one.choice); known.insert(value).second)
        property.values.push_back(value);
    if (property.values.size() < 2) continue;
    if (std::all_of(property.values.begin(), property.values.end(), [](const auto& v) { return number_of(v); }))
      std::sort(property.values.begin(), property.values.end(),
                [](const auto& a, const auto& b) { return *number_of(a) < *number_of(b); });
    properties.push_back(std::move(property));
  }
  return properties;
}

const char* text_of(Window window) {
  switch (window) {
    case Window::usable:
      return "usable";
    case Window::empty:
      return "empty";
    case Window::unknown:
      return "unknown";
    case Window::no_curve:
      break;
  }
  return "no_curve";
}

json bias_data(const ComparedChoice& one) {
  if (!one.bias) return json();
  const PointRecord& first = one.choice.first();
  const std::string unit = curve_unit(first);
  json out{{"parameter", curve_parameter(first)}, {"value", bias_in_unit(*one.bias, unit)}};
  if (one.usable) out["from"] = bias_in_unit(one.usable->low, unit), out["to"] = bias_in_unit(one.usable->high, unit);
  return out;
}

// The value of a metric: [largest over the conditions, mean] at the choice's bias, and the same with the bias as set; of
// both whether it counts for the front; whether the first is at the bias, and its span.
json metric_data(const ComparedChoice& one, const std::string& metric) {
  const Joined value = value_of(one, metric);
  json out{{"v", {or_null(value.worst), or_null(value.mean)}},
           {"counts", counts_by(one, metric)},
           {"at_bias", follows_bias(one, metric)}};
  const Joined rendered = value_of(one, metric, AtBias::as_set);
  out["set_counts"] = counts_by(one, metric, AtBias::as_set);
  out["set"] = {or_null(rendered.worst), or_null(rendered.mean)};
  if (const std::optional<Interval> span = span_over_window(one, metric))
    out["span"] = {or_null(span->low), or_null(span->high)};
  return out;
}

struct Axes {
  std::vector<std::string> costs, errors;
  std::string error_first;  // error_shown_first()
};

json entry_data(const ComparedChoice& one, const Axes& axes, const ChoiceNames& names) {
  json out{{"name", names.of(one.choice)},
           {"name_at_bias", names.of(one.choice, AtBias::best)},
           {"conditions", one.choice.points.size()},
           {"window", text_of(one.window)},
           {"good", one.good.has_value()},
           {"judged", one.judged},
           {"bias", bias_data(one)},
           {"cause", dominating_cause(one)},
           {"set_cause", dominating_cause(one, AtBias::as_set)}};
  for (const std::string& cost : axes.costs) {
    const Joined value = value_of(one, cost);
    json& numbers = out["costs"][cost] = {or_null(value.worst), or_null(value.mean)};
    if (const MedianInterval known = cost_of(one, cost); known.low < known.high)
      numbers.push_back(known.low), numbers.push_back(known.high);
  }
  for (const std::string& error : axes.errors) out["errors"][error] = metric_data(one, error);
  return out;
}

// What is read off one cost and one error, in indices of the entries. entry_of: of each choice; -1 if it has none.
json reading_data(const SpeedReadings& readings, const SpeedReading& reading, const ChoiceNames& names,
                  const std::vector<int>& entry_of) {
  const auto entries = [&](const std::vector<size_t>& choices) {
    json out = json::array();
    for (size_t i : choices)
      if (entry_of[i] >= 0) out.push_back(entry_of[i]);
    return out;
  };
  json out{{"front", entries(reading.front)}, {"words", json::array()}};
  for (const Phrase& phrase : readings.takeovers(reading, names))  // names as a list of one
    out["words"].push_back(phrase.is_name ? json({phrase.text}) : json(phrase.text));
  out["curves"] = json::array();
  for (const std::vector<size_t>& curve : reading.curves) out["curves"].push_back(entries(curve));
  out["ahead"] = json::array();  // the techniques that err least somewhere, each once
  std::set<size_t> ahead;
  for (const CheapestStretch& stretch : reading.stretches)
    if (ahead.insert(stretch.curve).second) out["ahead"].push_back(stretch.curve);
  if (const auto& found = reading.answers) {
    out["budget"] = found->budget;
    for (const auto& [name, i] :
         {std::pair("least", found->least), std::pair("balanced", found->balanced), std::pair("best", found->best)})
      if (entry_of[i] >= 0) out["answers"][name] = entry_of[i];
  }
  return out;
}

// By cost, error and bias of the page. The curves of many pairs are the same and stand once. Of more than most_whole_points
// choices only the pair that is shown first is read, because each takes time.
void add_readings(json& out, const ComparedGroup& group, const Techniques& techniques, const Results& results,
                  const Axes& axes, const ChoiceNames& names, const std::vector<int>& entry_of) {
  const SpeedReadings readings(group, techniques, results);
  out["scale"] = techniques.scale.empty() ? "" : setting_label(techniques.scale);
  for (size_t i = 0; i < entry_of.size(); ++i)
    if (entry_of[i] >= 0) out["entries"][static_cast<size_t>(entry_of[i])]["technique"] = techniques.of[i];
  for (size_t first : techniques.first)
    out["techniques"].push_back(names.technique(group.choices[first].choice, techniques.scale));
  std::map<std::string, size_t> known;  // curves by their text
  out["curves"] = json::array();
  const bool only_first = group.choices.size() > most_whole_points;
  for (const std::string& cost : only_first ? std::vector{axes.costs.front()} : axes.costs)
    for (const std::string& error : only_first ? std::vector{axes.error_first} : axes.errors)
      for (const auto& [bias, at] : {std::pair("best", AtBias::best), std::pair("set", AtBias::as_set)}) {
        json one = reading_data(readings, readings.of(cost, error, at), names, entry_of);
        const auto [same, is_new] = known.emplace(one["curves"].dump(), out["curves"].size());
        if (is_new) out["curves"].push_back(std::move(one["curves"]));
        one["curves"] = same->second;
        out["readings"][cost][error][bias] = std::move(one);
      }
}

json group_data(const ComparedGroup& group, const Techniques& techniques, const Results& results, const Axes& axes,
                const ChoiceNames& names, const std::unordered_set<int64_t>& shown_ids) {
  const std::vector<Property> properties = properties_of(group, results);
  json out{{"choices", group.choices.size()}, {"entries", json::array()}, {"properties", json::array()}};
  for (const Property& property : properties) {
    json texts = json::array();
    for (const std::string& value : property.values)
      texts.push_back(property.setting.empty() ? value : setting_text(value));
    out["properties"].push_back(
        {{"label", property.setting.empty() ? "part" : setting_label(property.setting)}, {"values", std::move(texts)}});
  }
  std::vector<int> entry_of(group.choices.size(), -1);
  for (size_t i = 0; i < group.choices.size(); ++i) {
    const ComparedChoice& one = group.choices[i];
    const PointRecord* const point = point_on_page(one, axes.error_first, shown_ids);
    if (!point) continue;
    json entry = entry_data(one, axes, names);
    entry["id"] = point->id;
    entry["points"] = json::array();
    for (const PointRecord* condition : one.choice.points)
      if (shown_ids.contains(condition->id)) entry["points"].push_back(condition->id);
    entry["is"] = json::array();
    for (const Property& property : properties) {
      const auto at =
          std::find(property.values.begin(), property.values.end(), value_of_property(property, one.choice));
      entry["is"].push_back(at - property.values.begin());
    }
    entry_of[i] = static_cast<int>(out["entries"].size());
    out["entries"].push_back(std::move(entry));
  }
  if (!out["entries"].empty()) add_readings(out, group, techniques, results, axes, names, entry_of);
  return out;
}

}  // namespace

std::vector<std::string> costs_of(const Results& results) { return measured(results, results.info.cost, cost_metrics); }

std::vector<std::string> errors_of(const Results& results) {
  return measured(results, results.info.accuracy, error_metrics);
}

std::string error_shown_first(const Results& results) {
  const std::vector<std::string> errors = errors_of(results);
  const bool measured = !errors.empty() && errors.front() == results.info.accuracy;
  const bool has_size = std::any_of(results.points.begin(), results.points.end(),
                                    [](const PointRecord& point) { return metric_of(point, "light_size") != 0; });
  return measured && (has_size || results.info.accuracy != "error_soft") ? errors.front() : "error";
}

double error_in_plane(const ComparedChoice& one, const std::string& error, AtBias at) {
  return counts_by(one, error, at) ? value_of(one, error, at).worst : std::numeric_limits<double>::quiet_NaN();
}

std::vector<size_t> front_of(const ComparedGroup& group, const std::string& cost, const std::string& error, AtBias at) {
  std::vector<FrontPoint> plane;
  for (const ComparedChoice& one : group.choices) plane.push_back({cost_of(one, cost), error_in_plane(one, error, at)});
  return pareto_front(plane);
}

size_t group_shown_first(const std::vector<ComparedGroup>& groups) {
  const auto most = std::max_element(groups.begin(), groups.end(),
                                     [](const auto& a, const auto& b) { return a.choices.size() < b.choices.size(); });
  return static_cast<size_t>(most - groups.begin());
}

GroupNames::GroupNames(const Results& results, const std::vector<ComparedGroup>& groups) {
  const auto& over = results.info.over;
  for (const Setting& row : settings_table()) {  // in its order: the scene first
    const std::string name(row.name);
    if (!decides_what_is_seen(name) || std::find(over.begin(), over.end(), name) != over.end()) continue;
    std::set<std::string> texts;
    for (const ComparedGroup& group : groups) texts.insert(setting_of(group.choices.front().choice.first(), name));
    if (texts.size() > 1) differing_.push_back(name);
  }
}

std::string GroupNames::of(const ComparedGroup& group) const {
  const PointRecord& point = group.choices.front().choice.first();
  std::vector<std::string> said = differing_;  // without those that are "auto", which tell a reader nothing
  std::erase_if(said, [&](const std::string& name) { return setting_of(point, name) == "auto"; });
  return settings_phrase(point, said.empty() ? differing_ : said);
}

ChoiceNames::ChoiceNames(const Results& results) {
  for (const std::string& name : choice_settings(results.info)) {
    if (decides_what_is_seen(name)) continue;
    std::map<std::string, std::set<std::string>> values;  // by part
    for (const PointRecord& point : results.points) values[point.part].insert(setting_of(point, name));
    for (const auto& [part, texts] : values)
      if (texts.size() > 1) differing_[part].push_back(name);
  }
}

std::string ChoiceNames::of(const Choice& choice, AtBias at) const {
  const auto found = differing_.find(choice.first().part);
  const std::vector<std::string> settings = found == differing_.end() ? std::vector<std::string>() : found->second;
  const std::string name =
      named(choice, at == AtBias::best ? without_curve_parameter(choice.first(), settings) : settings);
  return name.empty() ? fmt::format("point {}", choice.first().id) : name;
}

std::string ChoiceNames::technique(const Choice& choice, const std::string& scale) const {
  const auto found = differing_.find(choice.first().part);
  std::vector<std::string> settings = found == differing_.end() ? std::vector<std::string>() : found->second;
  for (const std::string& tuned : tuned_settings(choice)) std::erase(settings, tuned);
  std::erase(settings, scale);
  return named(choice, std::move(settings));
}

std::string ChoiceNames::named(const Choice& choice, std::vector<std::string> settings) const {
  const PointRecord& point = choice.first();
  const std::string phrase = settings_phrase(point, settings);
  return point.part + (point.part.empty() || phrase.empty() ? "" : ", ") + phrase;
}

const PointRecord* point_on_page(const ComparedChoice& one, const std::string& error,
                                 const std::unordered_set<int64_t>& shown_ids) {
  if (const PointRecord* worst = value_of(one, error).at; worst && shown_ids.contains(worst->id)) return worst;
  for (const PointRecord* point : one.choice.points)
    if (shown_ids.contains(point->id)) return point;
  return nullptr;
}

json speed_data(const ShownPoints& shown) {
  json data{{"costs", shown.costs}, {"errors", shown.errors}, {"error", shown.error_first}};
  data["groups"] = json::array();
  if (shown.groups.empty()) return data;
  const size_t first = group_shown_first(shown.groups);
  data["group"] = 0;
  const ChoiceNames names(shown.all);
  const GroupNames group_names(shown.all, shown.groups);
  const Axes axes{shown.costs, shown.errors, shown.error_first};
  std::unordered_set<int64_t> shown_ids;
  for (const PointRecord& point : shown.results.points) shown_ids.insert(point.id);
  for (size_t i = 0; i < shown.groups.size(); ++i) {
    json group = group_data(shown.groups[i], shown.techniques[i], shown.all, axes, names, shown_ids);
    if (group["entries"].empty()) continue;
    group["name"] = group_names.of(shown.groups[i]);
    if (i == first) data["group"] = data["groups"].size();
    data["groups"].push_back(std::move(group));
  }
  return data;
}

}  // namespace noonmark::report
