// The filters of a lookup. A filter is one file in technique/filters/ and one row of the table in filters.cpp. The row
// gives the choice of filter.kind, the shader, and the parameters that the filter reads. The settings filter.<name>, the
// uniforms, and the rules about values that a filter refuses or does not use are made from the rows.
//
//   TapPattern pattern = tap_pattern(settings.filter);     // technique/tap_pattern.h
//   for (const Filter& filter : filters()) print(filter.name, filter.help);
//
// Taps of equal weight are a table of offsets, made by <name>.cpp; the shader counts the lit ones. Taps that the
// sampler of a hardware comparison blends have weights. <name>.glsl gives the weights along one axis, and both the
// shader and the host compile that file.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "technique/counted.h"
#include "technique/settings.h"
#include "technique/tap_pattern.h"

namespace noonmark {

enum class FilterMap { any, flat, cube };

// A number, flag or choice that at least one filter reads. It is the setting filter.<name>, and the uniform
// filter_<name> in the shader of each filter that reads it: an int, or a float if the type is real.
struct FilterParameter {
  std::string_view setting;  // "filter.size"
  std::string_view unit;
  ValueType type = ValueType::real;
  double min = 0, max = 0;  // integer, real: inclusive limits
  double initial = 0;       // the default; of a choice its index
  std::string_view help;    // after the names of the filters that read it: "box, gaussian: <help>"
  std::span<const std::string_view> choices = {};

  std::string_view name() const { return setting.substr(setting.find('.') + 1); }
};

// That a filter reads a parameter. Both functions get settings in which filter.kind is this filter. They return the
// reason, or an empty text.
struct FilterRead {
  const FilterParameter* parameter;
  std::string (*why_refused)(const FilterSettings&) = nullptr;  // the filter has no kernel for this value
  std::string (*why_idle)(const FilterSettings&) = nullptr;     // another parameter switches this one off
};

struct Filter {
  std::string_view name;  // a choice of filter.kind
  std::string_view help;
  std::string_view law;             // what the laws say of it, for the table in docs/reference/techniques.md
  FilterMap map = FilterMap::flat;  // the shapes of map that it can read
  std::string_view shader;          // gl/shaders/filter/<shader>.glsl
  TapPattern (*taps)(const FilterSettings&) = nullptr;
  std::vector<FilterRead> reads = {};
  bool blended = false;      // a comparison sampler blends the taps: one reference for all texels of a fetch
  bool own_weights = false;  // the file <name>.glsl gives the weights of the blend: <name>_weight
  Counted (*counted_weight)(int texel, Counted s, int size) = nullptr;  // the same with counters, for the cost

  // Null if the filter does not read the parameter.
  const FilterRead* read(const FilterParameter& parameter) const;
};

std::span<const Filter> filters();

// Every parameter that a filter reads, once, in the order of the rows.
std::span<const FilterParameter* const> filter_parameters();

// Throws std::logic_error if no row has that name.
const Filter& find_filter(std::string_view name);

}  // namespace noonmark
