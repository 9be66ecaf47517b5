// The names that experiments and formulas are made of.
#pragma once
#include <string>
#include <vector>

#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark::fuzz {

// The names of all settings, metrics and quantities of a curve.
inline std::vector<std::string> program_names() {
  std::vector<std::string> names;
  for (const Setting& row : settings_table()) names.emplace_back(row.name);
  for (const Metric& row : metrics_table()) names.emplace_back(row.name);
  for (const CurveQuantity& row : curve_quantities()) names.emplace_back(row.name);
  return names;
}

}  // namespace noonmark::fuzz
