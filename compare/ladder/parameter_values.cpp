#include "compare/ladder/parameter_values.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "technique/lookups.h"

namespace noonmark {
namespace {

constexpr std::string_view settings_of_curves[] = {"lookup.v_min", "lookup.floor", "lookup.moment_bias",
                                                   "bias.constant"};

std::string_view name_of(std::string_view setting) { return setting.substr(setting.find('.') + 1); }
bool is_bias(std::string_view setting) { return setting.starts_with("bias."); }

double value_in(const Settings& settings, std::string_view setting) {
  return is_bias(setting) ? settings.bias[name_of(setting)] : settings.lookup[name_of(setting)];
}

// The powers of ten between which the usual values lie.
struct Decades {
  int first = 0, last = 0;
};
Decades decades_of(std::string_view setting, BiasUnit unit) {
  if (setting == "lookup.v_min") return {-9, -2};  // in depth squared: gaps of 3e-5 to 0.1 of the range (law 19)
  if (setting == "lookup.floor") return {-6, -1};
  if (setting == "lookup.moment_bias") return {-8, -2};
  if (setting != "bias.constant") throw std::logic_error("no curve over " + std::string(setting));
  switch (unit) {
    case BiasUnit::depth:
      return {-6, -1};
    case BiasUnit::m:
      return {-4, 1};
    case BiasUnit::texel:
      return {-2, 2};
  }
  throw std::logic_error("a unit of the bias without usual values");
}

}  // namespace

std::span<const std::string_view> curve_settings() { return settings_of_curves; }

bool has_curve_over(const Settings& settings, std::string_view setting) {
  if (setting.empty() || compares(settings) || mixes_maps(settings)) return false;
  const LookupKind& kind = find_lookup(settings.lookup.kind);
  return is_bias(setting) || std::any_of(kind.reads.begin(), kind.reads.end(),
                                         [&](const auto& read) { return read.parameter->setting == setting; });
}

std::vector<double> usual_values(std::string_view setting, BiasUnit unit) {
  const auto [first, last] = decades_of(setting, unit);
  std::vector<double> values = {0};
  for (int half = 2 * first; half <= 2 * last; ++half) {
    // 1 and 3 of each decade: round numbers, and a step of about the square root of 10.
    const double power = std::pow(10.0, std::floor(half / 2.0));
    values.push_back(half % 2 == 0 ? power : 3 * power);
  }
  return values;
}

std::vector<double> values_of(const ParameterValues& asked, const Settings& settings) {
  std::vector<double> values = asked.values.empty() ? usual_values(asked.setting, settings.bias.unit) : asked.values;
  values.push_back(value_in(settings, asked.setting));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

Settings with_value(Settings settings, std::string_view setting, double value) {
  (is_bias(setting) ? settings.bias[name_of(setting)] : settings.lookup[name_of(setting)]) = value;
  return settings;
}

}  // namespace noonmark
