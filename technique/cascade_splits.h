// The schemes that split the view's depth among cascades. A scheme is one file in technique/splits/ and one row of the table
// in cascade_splits.cpp; the choice of cascades.splits, and which settings are idle under it, are made from the rows.
//
//   std::vector<double> bounds = find_cascade_split("practical").bounds({0.1, 100, 4, settings.cascades});  // 3 depths
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "technique/settings.h"

namespace noonmark {

// What is split: the depths from near_m to far_m along the view, both above 0, into `count` slices.
struct SplitInput {
  double near_m = 0, far_m = 0;
  int count = 1;
  const CascadeSettings& settings;
  double ratio() const { return far_m / near_m; }
};

struct CascadeSplit {
  std::string_view name;  // a choice of cascades.splits
  std::string_view help;
  // The depths at which each slice but the last ends, in metres. view_slices() checks that they ascend between near and
  // far.
  std::vector<double> (*bounds)(const SplitInput&);
  std::vector<std::string_view> reads = {};  // settings: "cascades.lambda"
};

std::span<const CascadeSplit> cascade_splits();

// Throws std::logic_error if no row has that name.
const CascadeSplit& find_cascade_split(std::string_view name);

}  // namespace noonmark
