#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>

#include "app/pictures/pictures.h"
#include "app/pictures/point_files.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/one_point.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/interval.h"
#include "compare/judge/no_flicker.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/undecided.h"
#include "compare/report/cascade_rows.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "measure/pass_times.h"
#include "measure/workbench.h"
#include "scenes/library.h"
#include "technique/bias.h"
#include "technique/casters.h"
#include "technique/light_frame.h"
#include "technique/light_kind.h"
#include "technique/placements.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// "over 64 placements, exact map              mean      worst", and a line for each metric.
void print_placements(const Measurement& m) {
  const std::map<std::string, double>& metrics = m.record.metrics;
  if (!metrics.contains("error_mean")) return;
  const int side = m.technique.settings.map.placements;
  fmt::print("\n  {:<32}{:>12}{:>12}\n", fmt::format("over {} placements, exact map", side * side), "mean", "worst");
  for (const Metric& metric : metric_rows()) {
    const std::string mean = fmt::format("{}_mean", metric.name), worst = fmt::format("{}_worst", metric.name);
    if (!metric.is(Metric::placed) || !metrics.contains(mean)) continue;  // a blend band has none of some
    fmt::print("  {:<32}{:>11.5f}%{:>11.5f}%\n", metric.name, 100 * metrics.at(mean), 100 * metrics.at(worst));
  }
  if (m.maps.size() > 1) {
    fmt::print("  each cascade at its own worst; OpenGL shows {:.5f}% error there\n",
               100 * metrics.at("error_worst_shown"));
    return;
  }
  std::vector<double> worst;
  for (const PlacementFact& fact : m.technique.frame.light().placement_facts(m.technique.frame, Placements(side), 0))
    worst.push_back(metrics.at(fmt::format("worst_{}", fact.name)));
  fmt::print("  the worst is {}; OpenGL shows {:.5f}% error there\n", m.technique.frame.light().placement_text(worst),
             100 * metrics.at("error_worst_shown"));
}

// "from frame 3 to frame 4", and a line for each metric.
void print_flicker(const Measurement& m) {
  if (!m.flicker) return;
  const int frame = m.technique.settings.view.motion.frame;
  fmt::print("\n  {:<32}{:>11.0f} points\n", fmt::format("from frame {} to frame {}", frame, frame + 1),
             m.record.metrics.at("flicker_points"));
  if (const std::string why = why_no_flicker(m.record); !why.empty()) fmt::print("  {}\n", why);
  for (const Metric& metric : metric_rows())
    if (const auto found = m.record.metrics.find(std::string(metric.name));
        metric.is(Metric::motion) && metric.is(Metric::share) && found != m.record.metrics.end())
      fmt::print("  {:<32}{:>11.5f}%\n", metric.name, 100 * found->second);
}

// What an automatic shape and rotation of the map became.
void print_fitted_map(const Measurement& m) {
  const MapSettings& map = m.technique.settings.map;
  const LightFrame& frame = m.technique.frame;
  if (m.maps.size() > 1 || (map.aspect && map.roll_deg) || !frame.light().rays().have_one_direction()) return;
  const LightFrame unrolled = frame.light().axes(effective_light(m.scene, m.technique.settings));
  const double roll = std::atan2(glm::dot(frame.right, unrolled.up), glm::dot(frame.right, unrolled.right));
  fmt::print("  the map: {} x {} texels, {:.4g} x {:.4g} m, map.roll_deg = {:.4g}\n\n", frame.resolution, frame.rows,
             frame.extent_m, frame.extent_m * frame.rows / frame.resolution, glm::degrees(roll));
}

// The table of the cascades, and which of them the error comes from.
void print_cascades(const Measurement& m) {
  if (m.record.cascades.empty()) return;
  fmt::print("\n  {:<10}{:>19}{:>11}{:>11}{:>12}{:>10}{:>10}{:>28}{:>28}\n", "cascade",
             cascades_by_depth(m.record) ? "depth" : "receivers from", "texel", "receivers", "error", "of all", "seam",
             "bias needed", "bias set");
  const auto share = [](const std::optional<double>& value, int digits) {
    return value ? quantity_text(*value, "fraction", digits) : "-";
  };
  for (const CascadeRow& row : cascade_rows_of(m.record))
    fmt::print("  {:<10}{:>19}{:>11}{:>11.0f}{:>12}{:>10}{:>10}{:>28}{:>28}\n", row.number, cascade_depths_text(row),
               quantity_text(row.texel_m, "m", 3), row.receivers, share(row.error, people_digits),
               row.share ? fmt::format("{:.0f}%", 100 * *row.share) : "-", share(row.seam, 2),
               cascade_bias_text(m.record, row, row.needed), cascade_bias_text(m.record, row, row.set));
  if (const std::string worst = worst_cascade(m.record); !worst.empty()) fmt::print("  {}\n", worst);
}

// The curve's numbers in the unit of its parameter: the depth of that unit differs from cascade to cascade.
void print_curve_of_cascades(const Measurement& m, const BiasCurve& c) {
  const BiasPart& part = bias_part(c.parameter.substr(std::string_view("bias.").size()));
  const BiasUnit unit = m.technique.settings.bias.unit;
  const bool in_unit = part.unit == "bias.unit";
  const double per_depth = !in_unit || unit == BiasUnit::depth ? 1
                           : unit == BiasUnit::m               ? c.m_per_depth
                                                               : c.texels_per_depth;
  const std::string name = !in_unit ? "" : unit == BiasUnit::depth ? " depth" : unit == BiasUnit::m ? " m" : " texels";
  if (hides_window(m.record))
    fmt::print("\n  usable {}: {}\n", c.parameter, window_not_known);
  else if (c.window_min_depth)
    fmt::print("\n  usable {}: {:.4g} ... {:.4g}{}\n", c.parameter, *c.window_min_depth * per_depth,
               *c.window_max_depth * per_depth, name);
  else
    fmt::print("\n  no {} keeps acne within {:g} and Peter Panning within {:g}\n", c.parameter, c.acne_bound,
               c.peter_panning_bound);
  if (c.acne_free_bias_depth && !hides_window(m.record))
    fmt::print("  free of acne in all cascades from: {:.4g}{}\n", *c.acne_free_bias_depth * per_depth, name);
  fmt::print("  best {}: {:.4g}{} (error {:.5f}%)\n", c.parameter, c.best_bias_depth * per_depth, name,
             100 * c.best_error);
}

// What another lookup.reduction would do.
void print_reductions(const Measurement& m) {
  const auto& metrics = m.record.metrics;
  if (!metrics.contains("best_reduction")) return;
  fmt::print("  lookup.reduction of least error: {:.4g} ({:.5f}% on the exact map, without rounding)\n",
             metrics.at("best_reduction"), 100 * metrics.at("best_reduction_error"));
  constexpr const char* bounds =
      "the leak within curve.peter_panning_bound, and over-darkening and what the reduction darkens each within "
      "curve.acne_bound";
  if (hides_window(m.record)) {
    fmt::print("  usable lookup.reduction: {}\n", window_not_known);
    return;
  }
  if (metrics.contains("reduction_min"))
    fmt::print("  reductions from {:.4g} to {:.4g} keep {}\n", metrics.at("reduction_min"), metrics.at("reduction_max"),
               bounds);
  else
    fmt::print("  no reduction keeps {}\n", bounds);
  if (metrics.contains("error_mean") && m.maps.size() == 1) {
    if (metrics.contains("reduction_min_worst"))
      fmt::print("  at every placement of the grid: reductions from {:.4g} to {:.4g}\n",
                 metrics.at("reduction_min_worst"), metrics.at("reduction_max_worst"));
    else
      fmt::print("  at every placement of the grid: no reduction\n");
  }
  if (const std::string why = why_no_usable_reduction(m.record); !why.empty())
    fmt::print("    {} {}\n    what may help: {}\n",
               !rounds_too_much(m.record)          ? "because"
               : metrics.contains("reduction_min") ? "but none is usable:"
                                                   : "and",
               why, cures_of_reduction(m.record));
}

// What another value of curve.over would do: the values of least error, and the usable ones.
void print_curve_over(const Measurement& m) {
  const std::vector<LookupCurvePoint>& curve = m.record.over_curve;
  if (curve.empty()) return;
  const LookupCurvePoint& best = least_shown(curve);
  const std::string& setting = best.parameter;
  const std::string unit = setting == "bias.constant" ? " " + find_setting("bias.unit").get(m.technique.settings) : "";
  fmt::print("\n  {:<20}{:>12}{:>12}{:>12}{:>16}{:>15}\n", setting + unit, "error", "exact map", "leak",
             "over_darkening", "peter_panning");
  for (const LookupCurvePoint& at : curve)
    fmt::print("  {:<20.4g}{:>11.5f}%{:>11.5f}%{:>11.5f}%{:>15.5f}%{:>14.5f}%{}\n", at.value, 100 * at.shown_error,
               100 * at.error, 100 * at.leak, 100 * at.over_darkening, 100 * at.peter_panning,
               &at == &best ? "  least error" : "");
}

// Calls print(metric, value) for each metric of the point that is printed so. A point with one map has none of cascades.
void each_printed(const Measurement& m, Metric::Is so, const auto& print) {
  for (const Metric& metric : metrics_of({&m.record, 1}))
    if (const auto found = m.record.metrics.find(std::string(metric.name));
        metric.is(so) && !metric.is(Metric::motion) && found != m.record.metrics.end())
      print(metric, found->second);
}

void print_shares(const Measurement& m) {
  fmt::print("\n  {:<32}{:>12}\n", "share of counted receivers", "");
  each_printed(m, Metric::share, [&](const Metric& metric, double share) {
    if (std::isnan(share)) return;
    fmt::print("  {:<32}{:>11.5f}%{}\n", metric.name, 100 * share,
               metric.name == "wrong" && !m.ladder.of_comparisons()
                   ? "  (not exactly as the truth, however little; judge by the error)"
                   : "");
  });
}

void print_window(const Measurement& m, const BiasCurve& c) {
  const char* there = m.uniform() ? "" : " (m and texels at the median receiver)";
  if (hides_window(m.record))
    fmt::print("\n  usable {}: {}\n", c.parameter, window_not_known);
  else if (c.window_min_depth)
    fmt::print("\n  usable {}: {:.6g} ... {:.6g} depth = {:.4g} ... {:.4g} m = {:.4g} ... {:.4g} texels{}\n",
               c.parameter, *c.window_min_depth, *c.window_max_depth, *c.window_min_depth * c.m_per_depth,
               *c.window_max_depth * c.m_per_depth, *c.window_min_depth * c.texels_per_depth,
               *c.window_max_depth * c.texels_per_depth, there);
  else
    fmt::print("\n  no {} keeps acne within {:g} and Peter Panning within {:g}\n", c.parameter, c.acne_bound,
               c.peter_panning_bound);
  if (c.acne_free_bias_depth && !hides_window(m.record) && c.parameter == "bias.constant") {
    fmt::print("  free of acne from: {:.6g} depth = {:.4g} m{}", *c.acne_free_bias_depth,
               *c.acne_free_bias_depth * c.m_per_depth, m.uniform() ? "" : " at the median receiver");
    // The law's bias in the parameter's own unit, which each receiver converts to depth by itself. The law does not
    // include the effect of other parts of the bias.
    const Bias& bias = m.technique.bias;
    if (bias.compared().size() > 1 || bias.moves_lookup() || bias.polygon_offset() || m.technique.moves_casters())
      fmt::print(", on top of the other parts");
    else if (m.uniform() || m.technique.settings.bias.unit == BiasUnit::m)
      fmt::print("; by law 1 the planes in the picture need {:.4g} m", m.record.metrics.at("acne_free_bias_law_m"));
    else if (m.technique.settings.bias.unit == BiasUnit::depth)
      fmt::print("; by law 1 the planes in the picture need {:.4g} depth",
                 m.record.metrics.at("acne_free_bias_law_depth"));
    fmt::print("\n");
  }
}

// clock: what the times come from.
void print_ladder(const Measurement& m, const char* clock) {
  const auto value = [&](const char* name) { return m.record.metrics.at(name); };
  fmt::print("{}: {:.0f} receivers, {:.0f} face the light, {:.0f} counted", printable(m.scene.name), value("receivers"),
             value("facing"), value("counted"));
  if (value("facing") > 0) fmt::print(" ({:.4f}% ambiguous)", 100 * value("ambiguous"));
  fmt::print("\n");
  if (const std::string poor = why_poor_view(m.record); !poor.empty()) fmt::print("\n  {}\n", poor);
  if (nothing_judged(m.record)) return;
  print_shares(m);
  print_cascades(m);
  print_placements(m);
  print_flicker(m);
  fmt::print("\n");
  print_fitted_map(m);
  if (const std::string doubt = undecided_note({&m.record, 1}); !doubt.empty()) fmt::print("  {}\n\n", doubt);
  each_printed(m, Metric::value, [](const Metric& metric, double number) {
    fmt::print("  {:<32}{:>12.5g} {}\n", metric.name, number, metric.unit);
  });
  // Up to 1 the map is fine enough for the camera.
  each_printed(m, Metric::above_1, [](const Metric& metric, double number) {
    if (!(number <= 1)) fmt::print("  {:<32}{:>12.5g} texel widths for a pixel's\n", metric.name, number);
  });
  each_printed(m, Metric::one_receiver, [](const Metric& metric, double share) {
    fmt::print("  {:<32}{:>11.5f}% of the light of one receiver\n", metric.name, 100 * share);
  });
  print_reductions(m);
  if (const std::string cures = cures_of_precision(m.record); !cures.empty() && !rounds_too_much(m.record))
    fmt::print("  {}\n", cures);
  print_curve_over(m);
  for (const char* name : {"map_ms", "prefilter_ms", "lookup_ms"}) {
    if (!m.record.metrics.contains(name)) continue;
    const MedianInterval time = interval_of(m.record, name);
    fmt::print("  {:<32}{:>12.5g} ms ({:.5g} ... {:.5g}; {})\n", name, time.middle, time.low, time.high, clock);
  }
  if (const std::string why = why_no_curve(m.record); !why.empty() && !has_curve(m.record))
    fmt::print("\n  no bias curve: {}\n", why);
  if (!m.record.curve) return;
  const BiasCurve& c = *m.record.curve;
  if (m.maps.size() > 1) {
    print_curve_of_cascades(m, c);
    return;
  }
  print_window(m, c);
  if (!hides_window(m.record))
    fmt::print("  best {}: {:.6g} depth (error {:.5f}%)\n", c.parameter, c.best_bias_depth, 100 * c.best_error);
}

struct RenderOptions : PointOptions {
  bool times = false;  // also without a wish of the experiment
};

int render_point(const RenderOptions& options) {
  const ExperimentArguments& arguments = options.arguments;
  const VerbOutputs outputs = outputs_of("render", options.what, arguments.out);
  OutputFolder folder(outputs);
  const OnePoint point = chosen_point(options, "render");
  const Settings& settings = point.settings;
  const std::string& out = outputs.folder;
  folder.make();
  require_room_to_start(true);
  Workbench bench(gl::DebugMode::log);
  const Experiment& part = part_of_point(point.experiment, point.id);
  const bool curve = part.curve_enabled;
  require_room(bench, point, curve, true);
  TimeMetrics times;
  if (options.times || times_measured(point.experiment)) times = time_passes(bench, settings);
  Measurement m = bench.measure(settings, curve ? std::optional(part.curve) : std::nullopt);
  m.record.metrics.merge(times);
  write_pictures(m, out, ".", "point");
  write_debug_pictures(m, out, ".", "point");
  write_images(m, out, ".", "");
  write_file_atomically(out + "/point.json", point_json(m, arguments.command));
  print_ladder(m, gl::text_of(bench.device().times));
  print_notes(m.scene, settings);
  for (const IdleSetting& idle : idle_settings(m.technique.frame.kind, settings))
    fmt::print("  note: {} has no effect {}\n", idle.name, idle.why);
  if (!part.bounds.empty() || !part.laws.empty())
    fmt::print("  note: render judges no bounds and no laws; noonmark check does\n");
  fmt::print("\n{0}/point.json, {0}/ladder.exr, {0}/map.exr and {0}/point-*.png are written\n", printable(out));
  return 0;
}

RunVerb add_render(CLI::App& verb) {
  const auto options = std::make_shared<RenderOptions>();
  add_point_options(verb, *options, true);
  verb.add_flag("--times", options->times,
                "Measure times too; an experiment that names one, or says times = true, has them without it");
  add_out(verb, options->arguments, "Folder for the files", outputs_of("render", "", "").folder);
  return [options](const std::string& command) {
    options->arguments.command = command;
    const ThreadLimit limit(options->arguments.threads);
    return render_point(*options);
  };
}

}  // namespace

Verb verb_render() {
  return {"render", "Measure one point and write its pictures, its ladder and all numbers behind it",
          "noonmark render cube-room --set map.resolution=512", add_render};
}

}  // namespace noonmark
