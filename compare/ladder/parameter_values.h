// Which settings of a lookup in a filtered map have a curve besides lookup.reduction. Only the lookup reads them: the map and
// its blur are the same at every value.
//
//   const ParameterValues asked{"lookup.v_min", {0, 1e-6, 1e-4}};
//   for (double value : values_of(asked, settings)) measure(with_value(settings, asked.setting, value));
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "technique/settings.h"

namespace noonmark {

struct ParameterValues {
  std::string setting = {};         // one of curve_settings(); empty: no such curve
  std::vector<double> values = {};  // in the setting's unit and range, ascending; empty: usual_values()
  bool operator==(const ParameterValues&) const = default;
};

// By name, "lookup.v_min" first.
std::span<const std::string_view> curve_settings();

// Whether a point of these settings has a curve over this setting: its lookup reads a filtered map and the setting, and no
// result is a mix of the lookups in two maps.
bool has_curve_over(const Settings& settings, std::string_view setting);

// 0, then two values a decade over what is in use. Throws std::logic_error if it is none of curve_settings().
std::vector<double> usual_values(std::string_view setting, BiasUnit unit);

// The values asked for, or the usual ones, and the one that the settings have: ascending, each once.
std::vector<double> values_of(const ParameterValues& asked, const Settings& settings);

// The settings with another value of one of curve_settings().
Settings with_value(Settings settings, std::string_view setting, double value);

}  // namespace noonmark
