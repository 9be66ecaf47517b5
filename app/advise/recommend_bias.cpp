#include "app/advise/recommend_bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "compare/judge/curve_reading.h"
#include "compare/ladder/ladder.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

double multiple(double found, double bound) {
  if (bound > 0) return found / bound;
  return found > 0 ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace

CurveOptions searched_bounds(CurveOptions bounds) {
  bounds.acne_bound *= searched_acne;
  bounds.peter_panning_bound *= searched_peter_panning;
  return bounds;
}

std::string searched_text() {
  return fmt::format("{:.0f}% of the bound on acne and {:.0f}% of that on Peter Panning", 100 * searched_acne,
                     100 * searched_peter_panning);
}

double excess(const NearestBias& nearest, const CurveOptions& bounds) {
  return std::max(multiple(nearest.acne, bounds.acne_bound),
                  multiple(nearest.peter_panning, bounds.peter_panning_bound));
}

NearestBias nearest_bias(const PointRecord& point, const CurveOptions& bounds) {
  const BiasCurve& curve = *point.curve;
  const bool placed = curve.placements > 1;
  const std::vector<double>& acne = placed ? curve.acne_band.worst : curve.acne;
  const std::vector<double>& panning = placed ? curve.peter_panning_band.worst : curve.peter_panning;
  const auto at = [&](size_t i) -> NearestBias {
    return {curve.bias_depth[i] * parameter_per_depth(point), acne[i], panning[i]};
  };
  NearestBias best = at(0);
  for (size_t i = 1; i < acne.size(); ++i)
    if (const NearestBias other = at(i); excess(other, bounds) < excess(best, bounds)) best = other;
  return best;
}

std::string why_no_window(const PointRecord& point, const NearestBias& nearest) {
  return fmt::format("no bias keeps both within {}: the best, {} = {:.3g} {}, leaves {} acne and {} Peter Panning",
                     searched_text(), point.curve->parameter, nearest.bias, setting_of(point, "bias.unit"),
                     share_text(nearest.acne), share_text(nearest.peter_panning));
}

PointRecord::Worst worst_of_bias(const Measurement& m) {
  PointRecord::Worst worst = m.record.worst;
  double most = 0;
  const Image<float>&acne = m.ladder[Cause::acne], &panning = m.ladder[Cause::peter_panning];
  for (int y = 0; y < acne.height; ++y)
    for (int x = 0; x < acne.width; ++x) {
      const double dark = std::abs(acne.at(x, y)), light = std::abs(panning.at(x, y));
      if (!is_counted(m.ladder, acne.index(x, y)) || dark + light <= most) continue;
      most = dark + light;
      worst = {x, y, most, dark > light ? "acne" : "peter_panning"};
    }
  return worst;
}

std::optional<int> constant_bias_resolution(Workbench& bench, const Settings& settings, const CurveOptions& bounds) {
  PhaseOptions options;
  options.rows = 17, options.coarsest = 1024, options.finest = 16384, options.usable_only = true;
  static_cast<CauseBounds&>(options) = bounds;
  try {
    const PhaseDiagram diagram = bench.phase(phase_settings(settings, bench.scene(settings.scene)), options);
    int least = -diagram.rows.back().resolution;
    for (auto row = diagram.rows.rbegin(); row != diagram.rows.rend() && !diagram.usable(*row).empty(); ++row)
      least = row->resolution;
    return least;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    return std::nullopt;
  }
}

}  // namespace noonmark
