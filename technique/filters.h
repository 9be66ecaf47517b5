// The filters of a lookup. A filter is one file in technique/filters/ and one row of the table in filters.cpp: the
// choices of filter.kind, the shader, and which settings are read are read off the rows.
//
//   TapPattern pattern = tap_pattern(settings.filter);     // technique/tap_pattern.h
//   for (const Filter& filter : filters()) print(filter.name, filter.help);
//
// Taps that all count alike are a table of offsets, made by <name>.cpp; the shader counts them. Taps that the sampler
// of a hardware comparison blends have weights: <name>.glsl gives those of one axis, and the shader and the host
// compile it.
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
  FilterMap map = FilterMap::flat;  // the maps that it can look up
  std::string_view shader;          // gl/shaders/filter/<shader>.glsl
  TapPattern (*taps)(const FilterSettings&) = nullptr;
  std::vector<std::string_view> reads = {};  // its settings, besides filter.kind
  bool blended = false;                      // by a comparison sampler: one reference for the texels of a fetch
  // Blended by weights that the file <name>.glsl gives: filter.size is one of these.
  std::vector<int> sizes = {};
};

std::span<const Filter> filters();

// Throws std::logic_error where there is none of that name.
const Filter& find_filter(std::string_view name);

}  // namespace noonmark
