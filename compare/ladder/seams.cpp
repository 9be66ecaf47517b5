#include "compare/ladder/seams.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

size_t part_of(const CauseRow& row) {
  const std::string_view group = row.sum.empty() ? row.name : row.sum;
  return static_cast<size_t>(std::find(seam_parts.begin(), seam_parts.end(), group) - seam_parts.begin());
}

}  // namespace

void Seam::add(const Seam& other) {
  points += other.points;
  jump += other.jump;
  for (size_t k = 0; k < parts.size(); ++k) parts[k] += other.parts[k];
}

Seam seam_of(const Ladder& here, const Ladder& next, const Image<uint8_t>& mask) {
  Seam seam;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i] || !is_counted(here, i)) continue;
    ++seam.points;
    seam.jump += std::abs(static_cast<double>(next.shown()[i]) - static_cast<double>(here.shown()[i]));
    std::array<double, seam_parts.size()> steps{};
    for (const CauseRow& row : cause_rows) {
      const size_t part = part_of(row);
      if (!row.cause || !here.books(row) || part == steps.size()) continue;
      steps[part] += static_cast<double>(next[*row.cause][i]) - static_cast<double>(here[*row.cause][i]);
    }
    for (size_t k = 0; k < steps.size(); ++k) seam.parts[k] += std::abs(steps[k]);
  }
  return seam;
}

std::map<std::string, double> seam_metrics(const Seam& seam) {
  const auto mean = [&](double sum) { return seam.points > 0 ? sum / seam.points : not_a_number; };
  std::map<std::string, double> metrics{{"seam_points", seam.points}, {"seam_jump", mean(seam.jump)}};
  for (size_t k = 0; k < seam_parts.size(); ++k) metrics["seam_" + std::string(seam_parts[k])] = mean(seam.parts[k]);
  return metrics;
}

}  // namespace noonmark
