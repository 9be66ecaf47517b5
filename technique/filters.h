// The filters of a lookup. A filter is one file in technique/filters/ and one row of the table in filters.cpp. The row
// gives the choice of filter.kind, the shader, and the parameters that the filter reads (technique/kind_parameters.h). The settings filter.<name>, the
// uniforms, and the rules about values that a filter refuses or does not use are made from the rows.
//
//   TapPattern pattern = tap_pattern(settings.filter);     // technique/tap_pattern.h
//   for (const Filter& filter : filters()) print(filter.name, filter.help);
//
// Taps of equal weight are a table of offsets, made by <name>.cpp; the shader counts the lit ones. Taps that the
// sampler of a hardware comparison blends have weights. <name>.glsl gives the weights along one axis, and both the
// shader and the host compile that file. A lookup in a filtered map (technique/lookups.h) has no taps: its filter blurs
// the map instead.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "technique/settings.h"
#include "technique/tap_pattern.h"

namespace noonmark {

enum class FilterMap { any, flat, cube };

struct Filter {
  std::string_view name;  // a choice of filter.kind
  std::string_view help;
  std::string_view law;             // what the laws say of it, for the table in docs/reference/techniques.md
  FilterMap map = FilterMap::flat;  // the shapes of map that it can read
  std::string_view shader;          // gl/shaders/filter/<shader>.glsl
  TapPattern (*taps)(const FilterSettings&) = nullptr;
  std::vector<KindRead<FilterSettings>> reads = {};
  bool blended = false;      // a comparison sampler blends the taps: one reference for all texels of a fetch
  bool own_weights = false;  // the file <name>.glsl gives the weights of the blend: <name>_weight
  // The kernel with which it blurs a map, along each axis; null: it cannot. An odd number of weights, of sum 1.
  std::vector<double> (*blur)(const FilterSettings&) = nullptr;
  int weight_operations = 0;  // of <name>_weight of one texel, as LookupCost::operations (technique/cost.h)
};

std::span<const Filter> filters();

// Throws std::logic_error if no row has that name.
const Filter& find_filter(std::string_view name);

}  // namespace noonmark
