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
#include "compare/judge/recommendation.h"
#include "compare/report/broken.h"
#include "compare/report/cause_colors.h"
#include "compare/report/laws.h"
#include "compare/report/opening.h"
#include "compare/report/phase_section.h"
#include "compare/report/point_data.h"
#include "compare/report/rules.h"
#include "compare/report/speed.h"
#include "compare/report/text.h"
#include "compare/results/curve_fields.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using nlohmann::json;

// JSON cannot write these values. Charts leave them out, tables show "not finite".
json value_of(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  return value;
}

// Six digits are a thousandth of a chart's pixel, and take half the bytes.
json drawn_value(double value) {
  return std::isfinite(value) ? json(std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr)) : value_of(value);
}

json drawn(const std::vector<double>& series, const std::vector<size_t>& indices) {
  json out = json::array();
  for (size_t i : indices) out.push_back(i < series.size() ? drawn_value(series[i]) : json("NaN"));
  return out;
}

json curve_of(const PointRecord& point, size_t entries_of_all_curves) {
  const BiasCurve& curve = *point.curve;
  const std::vector<size_t> indices = drawn_biases(curve, entries_of_all_curves);
  json out;
  each_field(curve, [&](std::string_view name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      out[name] = value_of(value);
    else
      out[name] = value;
  });
  for (const CurveSeries& series : curve_series())
    if (!series.of(curve).empty()) out[series.name] = drawn(series.of(curve), indices);
  if (const std::optional<double> set = bias_as_set(point)) out["set_bias_depth"] = value_of(*set);
  return out;
}

}  // namespace

std::vector<size_t> drawn_biases(const BiasCurve& curve, size_t entries_of_all_curves) {
  const size_t count = curve.bias_depth.size();
  size_t keep = count;
  if (entries_of_all_curves > max_curve_entries)
    keep = std::min(count, std::max<size_t>(32, count * max_curve_entries / entries_of_all_curves));
  std::vector<size_t> indices;
  for (size_t i = 0; i < keep; ++i) indices.push_back(keep == 1 ? 0 : i * (count - 1) / (keep - 1));
  return indices;
}

size_t curve_entries(const Results& results) {
  size_t entries = 0;
  for (const PointRecord& point : results.points) entries += point.curve ? point.curve->bias_depth.size() : 0;
  return entries;
}

json chart_data(const Results& results, const ShownPoints& shown) {
  json data;
  data["swept"] = json::array();
  for (const std::string& name : results.info.swept) {
    const std::vector<std::string> values = values_of(shown.results, name);
    std::vector<std::string> texts;  // of the values, for people
    for (const std::string& value : values) texts.push_back(setting_text(value));
    bool numeric = !values.empty();
    for (const std::string& value : values) numeric = numeric && number_of(value);
    data["swept"].push_back({{"name", name},
                             {"label", setting_label(name)},
                             {"unit", swept_unit(name, results)},
                             {"numeric", numeric},
                             {"values", values},
                             {"texts", texts}});
  }
  data["metrics"] = json::array();
  for (const Metric& metric : metrics_of(results.points))
    data["metrics"].push_back({{"name", metric.name},
                               {"label", error_label(metric.name)},
                               {"unit", metric.unit},
                               {"help", metric.help},
                               {"plotted", metric.plotted}});
  data["causes"] = json::array();
  for (const CauseColor& cause : causes_of(results.points))
    data["causes"].push_back({{"name", cause.name}, {"label", cause.label}});
  data["plot"] = results.info.plot;
  data["over"] = results.info.over;
  data["cost"] = results.info.cost;
  data["accuracy"] = results.info.accuracy;
  data["bias"] = opens_as_set(results) ? "set" : "recommended";
  // What is not good enough is not recommended: of such choices the bias is the best that there is.
  const bool any_good = std::any_of(shown.groups.begin(), shown.groups.end(), [](const ComparedGroup& group) {
    return std::any_of(group.choices.begin(), group.choices.end(),
                       [](const auto& one) { return one.good.has_value(); });
  });
  data["bias_word"] = any_good ? "Recommended" : "Best";

  const size_t entries = curve_entries(shown.results);
  const std::map<int64_t, double> biases = recommended_biases(shown.groups);
  // The settings that all shown points share stand once.
  std::map<std::string, size_t> times;
  for (const PointRecord& point : shown.results.points)
    for (const std::string& word : settings_of_command(point)) ++times[word];
  std::set<std::string> common;
  data["command"] = json::array();
  for (const auto& [word, count] : times) {
    if (count < shown.results.points.size()) continue;
    common.insert(word);
    data["command"].push_back(word);
  }
  data["points"] = json::array();
  for (const PointRecord& point : shown.results.points) {
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
    if (point.curve) entry["curve"] = curve_of(point, entries);
    if (const auto bias = biases.find(point.id); bias != biases.end()) entry["at"] = at_bias(point, bias->second);
    for (const std::string& word : settings_of_command(point))
      if (!common.contains(word)) entry["set"].push_back(word);
    for (const PointRecord::WorstOf& worst : point.worst_of)
      if (find_quantity(worst.metric, {&point, 1}).unit == "fraction")
        entry["worst_of"][worst.metric] = {{"x", worst.x}, {"y", worst.y}, {"size", value_of(worst.size)}};
    if (point.worst.x >= 0)
      entry["worst"] = {{"x", point.worst.x},
                        {"y", point.worst.y},
                        {"error", value_of(point.worst.error)},
                        {"cause", point.worst.cause}};
    data["points"].push_back(std::move(entry));
  }

  data["laws"] = law_data(results);
  data["phases"] = json::array();
  for (const PhaseDiagram& diagram : results.phases)
    if (diagram.refused.empty()) data["phases"].push_back(phase_data(diagram));
  const Recommendation recommendation = recommend(results);
  data["recommended"] = recommendation.choice.points.empty() ? json() : json(recommendation.choice.first().id);
  data["speed"] = speed_data(results, shown);
  return data;
}

}  // namespace noonmark::report
