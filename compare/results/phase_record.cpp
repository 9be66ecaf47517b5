#include "compare/results/phase_record.h"

#include <algorithm>
#include <cmath>

namespace noonmark {
namespace {

constexpr PhaseSeries all_series[] = {
    {"error", &PhaseRow::error},
    {"error_worst", &PhaseRow::error_worst},
    {"acne", &PhaseRow::acne},
    {"acne_worst", &PhaseRow::acne_worst},
    {"peter_panning", &PhaseRow::peter_panning},
    {"peter_panning_worst", &PhaseRow::peter_panning_worst},
    {"aliasing", &PhaseRow::aliasing},
    {"coverage", &PhaseRow::coverage},
    {"filter", &PhaseRow::filter},
    {"undecided", &PhaseRow::undecided},
};

// Acne falls with the bias and Peter Panning grows, so each bound is met from one bias on, or up to one.
Interval between(const std::vector<double>& bias_m, const std::vector<double>& acne, double acne_bound,
                 const std::vector<double>& panning, double panning_bound) {
  const auto from = std::find_if(acne.begin(), acne.end(), [&](double share) { return share <= acne_bound; });
  const auto end =
      std::find_if(panning.begin(), panning.end(), [&](double share) { return !(share <= panning_bound); });
  const auto first = from - acne.begin(), last = end - panning.begin() - 1;
  if (first > last) return empty_interval;
  return {bias_m[static_cast<size_t>(first)], bias_m[static_cast<size_t>(last)]};
}

}  // namespace

std::span<const PhaseSeries> phase_series() { return all_series; }

Interval PhaseDiagram::usable(const PhaseRow& row) const {
  return between(bias_m, row.acne_worst, acne_bound, row.peter_panning_worst, peter_panning_bound);
}
Interval PhaseDiagram::usable_on_average(const PhaseRow& row) const {
  return between(bias_m, row.acne, acne_bound, row.peter_panning, peter_panning_bound);
}

const PhaseRow& PhaseDiagram::nearest_row(double texel_m) const {
  const auto away = [&](const PhaseRow& row) { return std::abs(std::log(row.texel_m / texel_m)); };
  return *std::min_element(rows.begin(), rows.end(),
                           [&](const PhaseRow& a, const PhaseRow& b) { return away(a) < away(b); });
}

}  // namespace noonmark
