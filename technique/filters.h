// The filters of a lookup. A filter is one file in technique/filters/ and one row of the table in filters.cpp. The row
// gives the choice of filter.kind, the shader, and the settings that are read.
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

#include "technique/settings.h"
#include "technique/tap_pattern.h"

namespace noonmark {

enum class FilterMap { any, flat, cube };

struct Filter {
  std::string_view name;  // a choice of filter.kind
  std::string_view help;
  FilterMap map = FilterMap::flat;  // the shapes of map that it can read
  std::string_view shader;          // gl/shaders/filter/<shader>.glsl
  TapPattern (*taps)(const FilterSettings&) = nullptr;
  std::vector<std::string_view> reads = {};  // the settings that it reads, besides filter.kind
  bool blended = false;                      // a comparison sampler blends the taps: one reference for all texels of a
                                             // fetch
  std::vector<int> sizes = {};               // the sizes that filter.size may have; empty: any odd size
  bool own_weights = false;                  // the file <name>.glsl gives the weights of the blend: <name>_weight
};

std::span<const Filter> filters();

// Throws std::logic_error if no row has that name.
const Filter& find_filter(std::string_view name);

}  // namespace noonmark
