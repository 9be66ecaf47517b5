// How to divide a budget of texels among the lights of a frame (measure/lights_frame.h), so that the frame's error is least.
//
// 1. Each light is measured with maps of several resolutions. Each map has twice the texels of the one before, and the bias with the
//    least error. The light's part of the frame's error is the mean of w |R5 - R1| over four placements of the grid. Without a map,
//    nothing is in the light's shadow.
// 2. The frame's error is at most the sum of the parts. Between the measured resolutions a part is interpolated. The best division
//    is then found exactly: among divisions with at most as many texels, only the one with the least error is kept, light by light
//    (a knapsack by its Pareto front; Nemhauser and Ullmann 1969). That division is measured, and so is an equal split.
// 3. Texels that are left over go to one light at a time: to the light that gains most from them.
// 4. Both divisions are judged: the error of the frame is measured at four placements that the search did not use.
//
//   const TexelBudget found = divide_texels(bench, lights, 1 << 22, say);
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "measure/workbench.h"

namespace noonmark {

struct LightShare {
  std::string name;
  Settings settings;   // with its resolution and its bias; of a light without a map those of the smallest map
  int resolution = 0;  // texels on a side; 0: it needs no map
  int64_t texels = 0;  // of the map, of a cube on its six faces
  double weight = 0;   // its share of the light without shadows
  double error = 0;    // its part of the frame's error
  double without = 0;  // the same without a map
};

struct TexelDivision {
  std::vector<LightShare> lights;
  int64_t texels = 0;
  double error = 0;  // of the frame: lights_error, the mean over the placements at which it is judged
};

struct TexelBudget {
  int64_t texels = 0;  // the budget
  TexelDivision best, equal;
};

// lights: the settings of each, as an experiment's parts give them; their resolutions do not matter, and a bias only where it is no
// constant bias alone. Throws Error(usage) if the budget is less than one of the smallest maps for each light.
inline constexpr int least_map = 64;  // texels on a side
TexelBudget divide_texels(Workbench& bench, const std::vector<std::pair<std::string, Settings>>& lights, int64_t texels,
                          const std::function<void(const std::string&)>& say);

std::vector<std::string> budget_text(const TexelBudget& budget);
std::string budget_json(const TexelBudget& budget);
// An experiment that measures the frame. folder: where it will stand.
std::string budget_experiment(const TexelBudget& budget, const std::string& folder);

}  // namespace noonmark
