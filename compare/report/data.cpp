#include "compare/report/data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <type_traits>

#include "compare/judge/curve_reading.h"
#include "compare/report/broken.h"
#include "compare/report/cause_colors.h"
#include "compare/report/laws.h"
#include "compare/report/lookup_section.h"
#include "compare/report/opening.h"
#include "compare/report/phase_section.h"
#include "compare/report/point_data.h"
#include "compare/report/speed.h"
#include "compare/report/text.h"
#include "compare/results/curve_fields.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using nlohmann::json;

// What the card and the diagram say of a curve. compare/report/function_figure.h draws it.
json curve_of(const BiasCurve& curve) {
  json out;
  each_field(curve, [&](std::string_view name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      out[name] = value_of(value);
    else
      out[name] = value;
  });
  return out;
}

}  // namespace

nlohmann::json value_of(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  return value;
}

nlohmann::json drawn_value(double value) {
  return std::isfinite(value) ? json(std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr)) : value_of(value);
}

std::vector<Metric> listed_metrics(const Results& results) {
  std::vector<Metric> metrics = metrics_of(results.points);
  auto next = metrics.begin();
  for (const std::string& name : results.info.plot)
    if (const auto asked = std::find_if(next, metrics.end(), [&](const Metric& metric) { return metric.name == name; });
        asked != metrics.end())
      std::rotate(next, asked, asked + 1), ++next;
  return metrics;
}

namespace {

json swept_data(const ShownPoints& shown) {
  json out = json::array();
  for (const std::string& name : shown.all.info.swept) {
    const std::vector<std::string> values = values_of(shown.results, name);
    std::vector<std::string> texts;  // of the values, for people
    for (const std::string& value : values) texts.push_back(setting_text(value));
    bool numeric = !values.empty();
    for (const std::string& value : values) numeric = numeric && number_of(value);
    out.push_back({{"name", name},
                   {"label", setting_label(name)},
                   {"unit", swept_unit(name, shown.all)},
                   {"numeric", numeric},
                   {"values", values},
                   {"texts", texts}});
  }
  return out;
}

json metric_data(const Results& results) {
  json out = json::array();
  for (const Metric& metric : listed_metrics(results))
    out.push_back(
        {{"name", metric.name}, {"label", error_label(metric.name)}, {"unit", metric.unit}, {"help", metric.help}});
  return out;
}

json cause_data(const Results& results) {
  json out = json::array();
  for (const CauseColor& cause : causes_of(results.points))
    out.push_back({{"name", cause.name}, {"label", cause.label}});
  return out;
}

// What is not good enough is not recommended: of such choices the bias is the best that there is.
const char* bias_word(const ShownPoints& shown) {
  const bool any_good = std::any_of(shown.groups.begin(), shown.groups.end(), [](const ComparedGroup& group) {
    return std::any_of(group.choices.begin(), group.choices.end(),
                       [](const auto& one) { return one.good.has_value(); });
  });
  return any_good ? "Recommended" : "Best";
}

// The settings in the command of every point: those that all share.
std::set<std::string> shared_settings(const std::vector<PointRecord>& points) {
  std::map<std::string, size_t> times;
  for (const PointRecord& point : points)
    for (const std::string& word : settings_of_command(point)) ++times[word];
  std::set<std::string> shared;
  for (const auto& [word, count] : times)
    if (count >= points.size()) shared.insert(word);
  return shared;
}

// The pixels at which the point is worst.
void add_worst_pixels(const PointRecord& point, json& entry) {
  for (const PointRecord::WorstOf& worst : point.worst_of)
    if (find_quantity(worst.metric, {&point, 1}).unit == "fraction")
      entry["worst_of"][worst.metric] = {{"x", worst.x}, {"y", worst.y}, {"size", value_of(worst.size)}};
  if (point.worst.x >= 0)
    entry["worst"] = {{"x", point.worst.x},
                      {"y", point.worst.y},
                      {"error", value_of(point.worst.error)},
                      {"cause", point.worst.cause}};
}

// shared: the settings that are not said again for each point.
json point_data(const PointRecord& point, const Results& results, const std::set<std::string>& shared) {
  json settings = json::object(), metrics = json::object();
  for (const std::string& name : results.info.swept) settings[name] = setting_of(point, name);
  for (const auto& [name, value] : point.metrics) metrics[name] = value_of(value);
  json entry{{"id", point.id}, {"settings", settings}, {"metrics", metrics}};
  entry["phrase"] = settings_phrase(point, results.info.swept);
  if (const std::vector<std::string> names = without_curve_parameter(point, results.info.swept);
      names.size() < results.info.swept.size())
    entry["phrase_at_bias"] = settings_phrase(point, names);
  if (json failures = failures_of(point, results); !failures.empty()) entry["failures"] = std::move(failures);
  if (!point.part.empty()) entry["part"] = point.part;
  for (const std::string& word : settings_of_command(point))
    if (!shared.contains(word)) entry["set"].push_back(word);
  add_worst_pixels(point, entry);
  return entry;
}

json points_data(const ShownPoints& shown, const std::set<std::string>& shared) {
  const auto reductions =
      static_cast<size_t>(std::count_if(shown.results.points.begin(), shown.results.points.end(),
                                        [](const PointRecord& point) { return !point.lookup_curve.empty(); }));
  const std::map<int64_t, double> biases = recommended_biases(shown);
  json out = json::array();
  for (const PointRecord& point : shown.results.points) {
    json entry = point_data(point, shown.all, shared);
    if (point.curve) entry["curve"] = curve_of(*point.curve);
    if (json curve = reductions_of(point, reductions); !curve.is_null()) entry["reductions"] = std::move(curve);
    if (hides_window(point)) {
      entry["no_window"] = window_not_known;
      if (point.curve)
        for (const char* end : {"min", "max", "min_worst", "max_worst"})
          entry["curve"].erase(fmt::format("window_{}_depth", end));
    }
    if (json curve = over_of(point); !curve.is_null()) entry["over"] = std::move(curve);
    if (const auto bias = biases.find(point.id); bias != biases.end()) entry["at"] = at_bias(point, bias->second);
    out.push_back(std::move(entry));
  }
  return out;
}

json diagram_data(const Results& results) {
  json out = json::array();
  for (const PhaseDiagram& diagram : results.phases)
    if (diagram.refused.empty()) out.push_back(phase_data(diagram));
  return out;
}

}  // namespace

json chart_data(const ShownPoints& shown) {
  const std::set<std::string> shared = shared_settings(shown.results.points);
  return {
      {"swept", swept_data(shown)},
      {"metrics", metric_data(shown.all)},
      {"causes", cause_data(shown.all)},
      {"frames",
       judges_frames(shown.all.points) ? json(shown.all.info.command) : json()},  // the command that judged them
      {"cost", shown.all.info.cost},
      {"bias", opens_as_set(shown) ? "set" : "recommended"},
      {"bias_word", bias_word(shown)},
      {"free", free_setting_words(shown.results.points)},
      {"command", shared},
      {"points", points_data(shown, shared)},
      {"laws", law_data(shown.all)},
      {"phases", diagram_data(shown.all)},
      {"recommended", shown.recommended.choice.points.empty() ? json() : json(shown.recommended.choice.first().id)},
      {"speed", speed_data(shown)},
  };
}

}  // namespace noonmark::report
