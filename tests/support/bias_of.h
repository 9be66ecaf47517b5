// A bias of a few parts, for tests: bias_of({{"slope", 0.05}, {"slope_floor", 0.005}}).
#pragma once
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "technique/bias.h"

namespace noonmark {

using BiasValues = std::initializer_list<std::pair<std::string_view, double>>;

inline BiasSettings bias_settings_of(BiasValues values) {
  BiasSettings settings;
  for (const auto& [name, value] : values) settings[name] = value;
  return settings;
}

// No bias, each part alone, each reference together with a constant, and all parts together.
inline std::vector<BiasSettings> every_bias() {
  std::vector<BiasSettings> all(1);
  BiasSettings together;
  for (const BiasPart& part : bias_parts()) {
    all.push_back(bias_settings_of({{part.name, 1}}));
    together[part.name] = 1;
  }
  for (const TapReference& reference : tap_references()) {
    all.push_back(bias_settings_of({{"constant", 0.01}}));
    all.back().reference = std::string(reference.name);
  }
  all.push_back(together);
  return all;
}

inline Bias bias_of(BiasValues values) { return Bias(bias_settings_of(values)); }

}  // namespace noonmark
