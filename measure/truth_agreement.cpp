#include "measure/truth_agreement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace noonmark {
namespace {

// What is kept of a measurement: the next one frees the scene that it refers to.
struct Kept {
  Ladder ladder;
  std::vector<MapDepths> exact;  // of each map
  std::map<std::string, double> metrics;
};

Kept measured(Workbench& bench, Settings& settings, TruthMethod method) {
  settings.truth.method = method;
  Measurement m = bench.measure(settings, std::nullopt);
  Kept kept{std::move(m.ladder), {}, std::move(m.record.metrics)};
  for (const MeasuredMap& map : m.maps) kept.exact.push_back(map.exact);
  return kept;
}

bool is_compared(const std::string& metric) { return !metric.ends_with("_ms") && !metric.starts_with("truth_by_"); }

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

TruthAgreement compare_truth_methods(Workbench& bench, Settings settings) {
  const Kept a = measured(bench, settings, TruthMethod::automatic), b = measured(bench, settings, TruthMethod::rays);
  TruthAgreement found;
  const auto compare = [&](bool equal, const std::string& name) {
    if (!equal) found.differences.push_back(name);
  };
  for (size_t i = 0; i < a.ladder.rungs.size(); ++i)
    compare(a.ladder.rungs[i].lit.pixels == b.ladder.rungs[i].lit.pixels, a.ladder.rungs[i].name);
  for (size_t i = 0; i < a.ladder.causes.size(); ++i)
    compare(a.ladder.causes[i].step.pixels == b.ladder.causes[i].step.pixels, a.ladder.causes[i].name);
  compare(a.ladder.cause.pixels == b.ladder.cause.pixels, "the cause of each pixel");
  compare(a.ladder.flags.pixels == b.ladder.flags.pixels, "what is ambiguous");
  compare(a.ladder.doubt.pixels == b.ladder.doubt.pixels, "what is undecided");
  compare(std::equal(a.exact.begin(), a.exact.end(), b.exact.begin(), b.exact.end(),
                     [](const MapDepths& x, const MapDepths& y) { return x.depth == y.depth; }),
          "the exact map");
  for (const auto& [name, value] : a.metrics)
    if (is_compared(name)) compare(b.metrics.contains(name) && same(value, b.metrics.at(name)), name);
  found.by_cells = a.metrics.at("truth_by_cells");
  found.by_rays = a.metrics.at("truth_by_rays");
  found.by_scan = a.metrics.at("truth_by_scan");
  found.rays_by_rays = b.metrics.at("truth_by_rays");
  return found;
}

}  // namespace noonmark
