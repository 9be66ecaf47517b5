#include "tests/fuzz/sound_measurement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/file.h"
#include "compare/judge/soundness.h"
#include "compare/results/metrics.h"
#include "measure/workbench.h"
#include "scenes/library.h"
#include "tests/fuzz/target.h"

namespace noonmark::fuzz {
namespace {

// Steps are sums of at most a dozen floats in [0,1], each rounded to 2^-24. Their means have no larger error.
constexpr double rounding = 1e-6;

double metric(const Measurement& m, const char* name) { return m.record.metrics.at(name); }

// Whether the metric may be left out: law 1, and so its bias, is of lookups that compare depths.
bool may_be_absent(const Metric& row, const Measurement& m) {
  return row.optional() || (m.technique.moments && row.name.starts_with("acne_free_bias"));
}

void require_sums(const Measurement& m) {
  for (const SoundLimit& limit : sound_limits)
    if (m.record.metrics.contains(limit.metric))
      require(metric(m, limit.metric) <= limit.most, fmt::format("{} = {}", limit.metric, metric(m, limit.metric)));
  require(metric(m, "counted") + metric(m, "ambiguous_receivers") == metric(m, "facing"),
          "counted is not facing less ambiguous");
  require(metric(m, "attached") + metric(m, "facing") == metric(m, "receivers"),
          "attached is not receivers less facing");
  for (const auto& [name, rung] : m.ladder.rungs)
    for (size_t i = 0; i < rung.size(); ++i)
      require(rung[i] >= 0 && rung[i] <= 1 + rounding, fmt::format("a rung is {}", rung[i]));
}

void require_metrics(const Measurement& m) {
  if (metric(m, "counted") == 0) return;
  for (const Metric& row : metrics_table()) {
    if (row.unit == "ms") continue;  // only where times are asked for
    if (may_be_absent(row, m) && !m.record.metrics.contains(std::string(row.name))) continue;
    if (row.name.starts_with("seam_") && metric(m, "seam_points") == 0) continue;  // a mean over none
    const double value = m.record.metrics.at(std::string(row.name));
    require(!std::isnan(value), fmt::format("{} is not a number", row.name));
    if (row.unit == "fraction")
      require(value >= 0 && value <= 1 + rounding, fmt::format("{} = {} is no fraction", row.name, value));
    if (row.unit == "m2" || row.unit == "count")
      require(value >= 0 && std::isfinite(value), fmt::format("{} = {}", row.name, value));
  }
  double causes = 0;
  for (const char* name :
       {"filter", "displacement", "aliasing", "acne", "peter_panning", "coverage", "undecided", "precision"})
    causes += metric(m, name);
  if (m.technique.moments)
    for (const char* name : {"leak", "over_darkening", "reduction", "moment_precision"}) causes += metric(m, name);
  require(metric(m, "error") <= causes + rounding,
          fmt::format("error {} is more than its causes, {}", metric(m, "error"), causes));
  require(metric(m, "error") <= metric(m, "wrong") + rounding, "a mean error above the share of wrong receivers");
  require(metric(m, "peter_panning_lit") <= metric(m, "peter_panning") + rounding, "a part above its whole");
}

void require_curve(const Measurement& m) {
  if (!m.record.curve || metric(m, "counted") == 0) return;
  const BiasCurve& curve = *m.record.curve;
  require(std::is_sorted(curve.bias_depth.begin(), curve.bias_depth.end()), "the curve's biases do not ascend");
  for (auto series :
       {&BiasCurve::error, &BiasCurve::error_soft, &BiasCurve::wrong, &BiasCurve::acne, &BiasCurve::peter_panning,
        &BiasCurve::aliasing_dark, &BiasCurve::aliasing_light, &BiasCurve::coverage})
    for (const double value : curve.*series)
      require(value >= 0 && value <= 1 + rounding, fmt::format("a curve's value is {}", value));
  if (curve.window_min_depth)
    require(*curve.window_min_depth <= *curve.window_max_depth, "a window that ends before it begins");
  if (curve.parameter != "bias.constant" || m.technique.settings.bias.unit != BiasUnit::depth) return;
  // The point's own bias is the last one requested (below). There the curve must equal the measurement.
  const auto at_bias =
      std::find(curve.bias_depth.begin(), curve.bias_depth.end(), m.technique.settings.bias["constant"]);
  if (at_bias == curve.bias_depth.end()) return;
  const auto i = static_cast<size_t>(at_bias - curve.bias_depth.begin());
  const auto same = [&](const char* name, double found) {
    require(std::abs(metric(m, name) - found) <= rounding,
            fmt::format("the curve has {} = {} at the point's bias, the measurement {}", name, found, metric(m, name)));
  };
  same("acne", curve.acne[i]);
  same("peter_panning", curve.peter_panning[i]);
  same("coverage", curve.coverage[i]);
  same("aliasing_dark", curve.aliasing_dark[i]);
  same("aliasing_light", curve.aliasing_light[i]);
}

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void require_same(const Measurement& a, const Measurement& b) {
  for (const Metric& row : metrics_table()) {
    if (row.unit == "ms" || (may_be_absent(row, a) && !a.record.metrics.contains(std::string(row.name)))) continue;
    const std::string name(row.name);
    require(same_number(a.record.metrics.at(name), b.record.metrics.at(name)),
            fmt::format("{} = {}, and {} when nothing was remembered", name, a.record.metrics.at(name),
                        b.record.metrics.at(name)));
  }
  require(a.record.curve.has_value() == b.record.curve.has_value(), "a curve once, and once none");
  if (!a.record.curve) return;
  for (auto series : {&BiasCurve::bias_depth, &BiasCurve::error, &BiasCurve::acne, &BiasCurve::peter_panning}) {
    const std::vector<double>&x = *a.record.curve.*series, &y = *b.record.curve.*series;
    require(
        std::equal(x.begin(), x.end(), y.begin(), y.end(), same_number),
        fmt::format("a curve has [{}], and [{}] when nothing was remembered", fmt::join(x, " "), fmt::join(y, " ")));
  }
}

struct Benches {
  // Small pictures are faster without threads, and with one thread a failure can be repeated.
  tbb::global_control one_thread{tbb::global_control::max_allowed_parallelism, 1};
  int no_threads = ::setenv("LP_NUM_THREADS", "0", 1);
  Workbench bench{gl::DebugMode::fatal}, other{gl::DebugMode::fatal};
};

std::optional<CurveOptions> curve_for(const Settings& settings, bool wanted) {
  if (!wanted) return std::nullopt;
  CurveOptions options;
  if (const double constant = settings.bias["constant"]; constant > 0) options.bias_depth = {0, constant};
  return options;
}

Benches& benches() {
  static Benches made;
  return made;
}

}  // namespace

std::string described(const Settings& settings) {
  const Settings defaults;
  std::string text;
  for (const Setting& row : settings_table())
    if (row.get(settings) != row.get(defaults)) text += fmt::format("\n  {} = {}", row.name, row.get(settings));
  if (names_file(settings.scene.name)) text += "\n  " + read_file(settings.scene.name);
  return text;
}

void measure_soundly(const Settings& settings, bool curve, bool compare) {
  Benches& b = benches();
  const std::optional<CurveOptions> options = curve_for(settings, curve);
  const Measurement m = b.bench.measure(settings, options);
  if (metric(m, "facing") > 0) {
    require_sums(m);
    require_metrics(m);
    require_curve(m);
  }
  if (!compare) return;
  Settings unlike;  // another scene, so that no stored result can be reused
  unlike.scene.name = settings.scene.name == "plane" ? "wall" : "plane";
  unlike.view.width_px = unlike.view.height_px = 2;
  unlike.map.resolution = 2;
  b.other.measure(unlike, std::nullopt);
  require_same(m, b.other.measure(settings, options));
}

}  // namespace noonmark::fuzz
