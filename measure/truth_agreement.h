// Whether the two methods of the truth (truth.method) give the same at one point. `noonmark doctor` asks it of a small
// scene, and a test of all built-in scenes.
//
//   TruthAgreement agreement = compare_truth_methods(bench, settings);
//   if (!agreement.differences.empty()) print(agreement.differences);
#pragma once
#include <string>
#include <vector>

#include "measure/workbench.h"

namespace noonmark {

struct TruthAgreement {
  // Names of rungs, causes, metrics and maps that differ in any bit: "R3", "acne", "aliasing_rms". Empty: none does.
  // Times, and the metrics that say how the truth was found, are not compared.
  std::vector<std::string> differences;
  // With truth.method = "auto": what share of the truth was found how (0 ... 1).
  double by_cells = 0, by_rays = 0, by_scan = 0;
  double rays_by_rays = 0;  // the same share of rays with truth.method = "rays"
};

// Measures the point twice. settings.truth.method is not read. Throws Error as Workbench::measure() does.
TruthAgreement compare_truth_methods(Workbench& bench, Settings settings);

}  // namespace noonmark
