#include "compare/report/point_data.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/shell_words.h"
#include "compare/judge/curve_reading.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark::report {
namespace {

// The metrics of a point that follow its free setting, as its own curve gives them.
constexpr std::array curve_metrics{"error",         "error_soft",     "wrong",         "acne",
                                   "leak",          "over_darkening", "peter_panning", "aliasing",
                                   "aliasing_dark", "aliasing_light", "coverage",      "reduction"};

}  // namespace

std::map<int64_t, double> recommended_biases(const Findings& found) {
  std::map<int64_t, double> biases;
  for (const ComparedGroup& group : found.groups)
    for (const ComparedChoice& one : group.choices)
      for (const PointRecord* point : one.choice.points)
        if (one.bias && has_curve(*point)) biases[point->id] = *one.bias;
  if (found.recommended.bias)
    for (const PointRecord* point : found.recommended.choice.points) biases[point->id] = found.recommended.bias->value;
  return biases;
}

nlohmann::json at_bias(const PointRecord& point, double bias) {
  const double depth = bias / parameter_per_depth(point);
  if (!std::isfinite(depth)) return {};
  const std::optional<Interval> window = usable_window(point);
  nlohmann::json out{{"parameter", curve_parameter(point)},
                     {"word", free_setting_words(point)},
                     {"value", bias},
                     {"text", amount_of_bias(std::array{&point}, bias)},
                     {"depth", depth},
                     // The bias may lie on an end of the window, and its depth was rounded twice.
                     {"usable", window && depth >= window->low * (1 - 1e-12) && depth <= window->high * (1 + 1e-12)}};
  // At the bias that was set the rendered numbers are exact; the curve is linear between its entries.
  const bool as_set = number_of(setting_of(point, curve_parameter(point))) == bias;
  for (const char* metric : curve_metrics)
    if (as_set && std::isfinite(metric_of(point, metric)))
      out["metrics"][metric] = metric_of(point, metric);
    else if (const std::optional<double> value = curve_value(point, metric, depth); value && std::isfinite(*value))
      out["metrics"][metric] = *value;
  return out;
}

std::vector<std::string> settings_of_command(const PointRecord& point) {
  static const Settings defaults;
  std::vector<std::string> words;
  for (const Setting& row : settings_table()) {
    const auto found = point.settings.find(std::string(row.name));
    if (found != point.settings.end() && found->second != row.get(defaults))
      words.push_back(shell_quoted(found->first + "=" + found->second));
  }
  return words;
}

}  // namespace noonmark::report
