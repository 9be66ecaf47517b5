// Points in which every member has a value, for the tests of the code that stores and writes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "compare/results/metrics.h"
#include "compare/results/records.h"
#include "technique/settings.h"
#include "tests/support/temporary_folder.h"

namespace noonmark {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double inf_value = std::numeric_limits<double>::infinity();

// Points with different ids differ in every number.
inline PointRecord sample_point(int64_t id, bool with_curve = true) {
  PointRecord point;
  point.id = id;
  Settings settings;
  settings.map.resolution = 256 << (id % 4);
  for (const Setting& row : settings_table()) point.settings[std::string(row.name)] = row.get(settings);
  point.scene_digest = "5ce7e" + std::to_string(id);
  double value = 0.1 + static_cast<double>(id);
  for (const Metric& row : metrics_table()) point.metrics[std::string(row.name)] = value /= 3;
  point.metrics["placement_disagreements"] = 0;
  for (const char* stage : {"contract_store", "contract_blur", "contract_fetch", "contract_lit"})
    point.metrics[stage] = 0;
  point.metrics["contract"] = 0;                                // a sound measurement (compare/judge/soundness.h)
  point.metrics["counted"] = 700000 - static_cast<double>(id);  // enough for a picture
  point.times = {{"map_ms", 1.25}, {"truth_ms", 1.0 / 3 + static_cast<double>(id)}, {"rays", 1e9 + 1}};
  for (const double r : {0.0, 0.5})
    point.lookup_curve.push_back({"lookup.reduction", r, value /= 3, value /= 3, value /= 3, value /= 3, value /= 3,
                                  value /= 3, value /= 3, value /= 3, value /= 3, value /= 3});
  point.lookup_bounds = CauseBounds{0.002, 0.003};
  point.over_curve.push_back({"lookup.v_min", 0.25, value /= 3, value /= 3, value /= 3, value /= 3, 0, value /= 3,
                              value /= 3, 0, value /= 3, value /= 3});
  if (with_curve) {
    BiasCurve curve;
    curve.parameter = "bias.constant";
    curve.made = "one pass";
    for (int i = 0; i < 7; ++i) {
      const double b = i * 0.1 / 7 + (i ? static_cast<double>(id) : 0);
      curve.bias_depth.push_back(b);
      for (auto series :
           {&BiasCurve::error, &BiasCurve::error_soft, &BiasCurve::wrong, &BiasCurve::acne, &BiasCurve::peter_panning,
            &BiasCurve::aliasing_dark, &BiasCurve::aliasing_light, &BiasCurve::coverage})
        (curve.*series).push_back(value = std::sqrt(value + b));
    }
    curve.m_per_depth = 6.5;
    curve.texels_per_depth = 6.5 / (20.0 / 1024);
    curve.acne_bound = 0.001;
    curve.peter_panning_bound = 0.002;
    curve.window_min_depth = 0.1 / 3;
    curve.window_max_depth = 0.2 / 3;
    curve.best_bias_depth = 0.05;
    curve.best_error = 0.01 / 3;
    curve.flat_min_depth = 0.04;
    curve.flat_max_depth = 0.06;
    curve.breakpoints = 87420;
    curve.steps.most_share = 0.05;
    curve.steps.taps = 700000;
    curve.steps.unit_depth = 0.5;
    curve.steps.acne = {{0.001f, 20000.0 + static_cast<double>(id)}, {0.01f, 300}, {0.5f, 0}};
    curve.steps.peter_panning = {
        {0.02f, 0}, {0.03f, 0.125 + static_cast<double>(id)}, {std::numeric_limits<float>::infinity(), 9}};
    if (id % 2) {
      curve.placements = 16;
      curve.steps.acne_worst = {{0.25f, 31}, {0.5f, 1}};
      curve.steps.peter_panning_worst = {{0.0f, 0}};
      curve.window_min_worst_depth = 0.11 / 3;
      curve.window_max_worst_depth = 0.19 / 3;
      curve.acne_free_bias_worst_depth = 0.17 / 3;
      for (Band* band : {&curve.error_band, &curve.acne_band, &curve.peter_panning_band, &curve.aliasing_band})
        for (std::vector<double>* part : {&band->mean, &band->worst, &band->best})
          for (size_t i = 0; i < curve.bias_depth.size(); ++i) part->push_back(value = std::sqrt(value + 1));
    }
    curve.acne_free_bias_depth = 0.1 / 7;
    curve.acne_free_bias_stored_depth = id % 2 ? std::optional(0.2 / 7) : std::nullopt;
    point.curve = curve;
  }
  point.pictures = {{"truth", "images/p0003-truth.png", "The truth.", "0123456789abcdef"},
                    {"map", "images/p0003-map.png", "It's \"the\" map.", "fedcba9876543210"}};
  point.images = {{"images/p0003-ladder.exr", "00000000000000ff"}, {"images/p0003-map.exr", "00000000000000fe"}};
  point.worst = {12, 34, 2.0 / 3, "acne"};
  point.worst_of = {{"acne", 56, 78, 0.5}, {"peter_panning_gap_m", 9, 10, 1.0 / 3 + static_cast<double>(id)}};
  for (int k = 0; k < static_cast<int>(id % 3); ++k) {
    PointRecord::Cascade cascade{
        std::pow(3, k), std::pow(3, k + 1), {}, k == 1 ? std::nullopt : std::optional(1.0 / 3)};
    for (const char* metric : cascade_metrics) cascade.metrics[metric] = std::sqrt(static_cast<double>(id + k));
    point.cascades.push_back(cascade);
  }
  return point;
}

inline LawResult sample_law() {
  LawResult law;
  law.part = "law 1";
  law.name = "1: acne-free bias";
  law.says = "Free of acne from k w A tan(theta) on.";
  law.found = "The least bias is 0.3 m.";
  law.measured = "acne_free_bias_m";
  law.predicted = "0.5 * texel_m";
  law.relation = LawRelation::at_most;
  law.tolerance = "within 5%";
  law.join = "each";
  law.samples = {{3, 0.1, 0.3, 0.005}, {4, 0.2, 0.19, 0.01}};
  law.worst = 0;
  law.reproduce = "noonmark render x.toml --point 3";
  return law;
}

// Texel sizes and biases by octaves. Acne falls with the bias and grows with the texel; Peter Panning begins at the sixth
// bias. So the finer rows have a usable interval and the coarsest has none.
inline PhaseDiagram sample_phase() {
  PhaseDiagram d;
  d.part = "room & <hall>";
  d.made_from = "placements = 8\n";
  d.scene = "a <b> scene";
  d.light = "directional";
  d.technique = "constant bias in metres";
  d.render = "noonmark render --set scene.name='x y'";
  d.width_px = 320;
  d.height_px = 180;
  d.placements = 8;
  d.receivers = 1000;
  d.acne_bound = d.peter_panning_bound = 0.001;
  d.range_m = 10;
  d.law_at_bound = 1.5;
  d.law_steepest = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 8; ++i) d.bias_m.push_back(0.001 * std::exp2(i));
  for (int r = 0; r < 3; ++r) {
    PhaseRow row;
    row.resolution = 64 << r;
    row.texel_m = 0.04 / (1 << r);
    for (int i = 0; i < 8; ++i) {
      row.acne.push_back(i < 6 - 2 * r ? 0.1 / (i + 1) : 0);
      row.acne_worst.push_back(1.2 * row.acne.back());
      row.peter_panning.push_back(i < 5 ? 0 : 0.01);
      row.peter_panning_worst.push_back(row.peter_panning.back());
      row.aliasing.push_back(0.002);
      row.error.push_back(row.acne.back() + row.peter_panning.back() + 0.002);
      row.error_worst.push_back(1.2 * row.error.back());
      for (auto list : {&PhaseRow::coverage, &PhaseRow::filter, &PhaseRow::undecided}) (row.*list).push_back(0);
    }
    row.last_acne_m = r ? 0.05 : std::numeric_limits<double>::infinity();
    d.rows.push_back(row);
  }
  // Two points at one place, one whose bias is too large, and one of another technique.
  d.points = {{0, 0.01, 0.006, ""}, {1, 0.01, 0.006, ""}, {2, 0.02, 0.1, ""}, {3, 0, 0, "filter.kind = box"}};
  return d;
}

inline RunInfo sample_info() {
  RunInfo info;
  info.experiment = "experiments/cube room.toml";
  info.file = "../../experiments/cube room.toml";
  info.title = "Größe & \"Bias\" <test>";
  info.command = "noonmark run 'experiments/cube room.toml'";
  info.commit = "0123abc";
  info.version = "0.1.0";
  info.started = "2025-01-31T12:00:00Z";
  info.host_cpu = "a cpu";
  info.gl_vendor = "Mesa";
  info.gl_renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  info.gl_version = "4.5";
  info.gl_timer = "CPU time of the process";
  info.embree_version = "3.13.5";
  info.embree_isa = "AVX2";
  info.libraries = {{"glm", "0.9.9.8"}, {"sqlite", "3.40.1"}};
  info.swept = {"map.resolution", "filter.kind"};
  info.plot = {"error", "acne"};
  info.scene_name = "cube-room";
  info.triangles = 38;
  info.sweep_notes = {"the sweep of filter.size is dead"};
  info.scene_notes = {"street: 2 animations at rest; 1 primitive of lines left out"};
  return info;
}

// Equality in which NaN equals NaN.
inline bool same(double a, double b) { return (std::isnan(a) && std::isnan(b)) || a == b; }
inline bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return same(x, y); });
}
inline bool same(const std::map<std::string, double>& a, const std::map<std::string, double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return x.first == y.first && same(x.second, y.second); });
}
inline bool same(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
inline bool same(const BiasCurve& a, const BiasCurve& b) {
  return a.parameter == b.parameter && a.made == b.made && same(a.bias_depth, b.bias_depth) && same(a.error, b.error) &&
         same(a.wrong, b.wrong) && same(a.acne, b.acne) && same(a.peter_panning, b.peter_panning) &&
         same(a.aliasing_dark, b.aliasing_dark) && same(a.aliasing_light, b.aliasing_light) &&
         same(a.coverage, b.coverage) && same(a.m_per_depth, b.m_per_depth) &&
         same(a.texels_per_depth, b.texels_per_depth) && same(a.acne_bound, b.acne_bound) &&
         same(a.peter_panning_bound, b.peter_panning_bound) && same(a.window_min_depth, b.window_min_depth) &&
         same(a.window_max_depth, b.window_max_depth) && same(a.best_bias_depth, b.best_bias_depth) &&
         same(a.best_error, b.best_error) && same(a.flat_min_depth, b.flat_min_depth) &&
         same(a.flat_max_depth, b.flat_max_depth) && a.breakpoints == b.breakpoints &&
         same(a.acne_free_bias_depth, b.acne_free_bias_depth) &&
         same(a.acne_free_bias_stored_depth, b.acne_free_bias_stored_depth) && a.placements == b.placements &&
         same(a.window_min_worst_depth, b.window_min_worst_depth) &&
         same(a.window_max_worst_depth, b.window_max_worst_depth) &&
         same(a.acne_free_bias_worst_depth, b.acne_free_bias_worst_depth) &&
         same(a.error_band.mean, b.error_band.mean) && same(a.acne_band.worst, b.acne_band.worst) &&
         same(a.peter_panning_band.best, b.peter_panning_band.best) && a.steps == b.steps;
}
inline bool same(const PictureRecord& a, const PictureRecord& b) {
  return a.name == b.name && a.path == b.path && a.caption == b.caption && a.digest == b.digest;
}
inline bool same(const std::vector<LookupCurvePoint>& a, const std::vector<LookupCurvePoint>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const LookupCurvePoint& x, const LookupCurvePoint& y) {
    return x.parameter == y.parameter && x.value == y.value && x.error == y.error && x.leak == y.leak &&
           x.over_darkening == y.over_darkening && x.peter_panning == y.peter_panning && x.reduction == y.reduction &&
           x.aliasing_dark == y.aliasing_dark && x.aliasing_light == y.aliasing_light && x.coverage == y.coverage &&
           x.shown_error == y.shown_error && x.shown_error_soft == y.shown_error_soft;
  });
}
inline bool same(const PointRecord& a, const PointRecord& b) {
  return a.id == b.id && a.part == b.part && a.settings == b.settings && a.scene_digest == b.scene_digest &&
         same(a.metrics, b.metrics) && same(a.times, b.times) && a.curve.has_value() == b.curve.has_value() &&
         (!a.curve || same(*a.curve, *b.curve)) &&
         std::equal(a.pictures.begin(), a.pictures.end(), b.pictures.begin(), b.pictures.end(),
                    [](const PictureRecord& x, const PictureRecord& y) { return same(x, y); }) &&
         std::equal(
             a.images.begin(), a.images.end(), b.images.begin(), b.images.end(),
             [](const ImageRecord& x, const ImageRecord& y) { return x.path == y.path && x.digest == y.digest; }) &&
         a.worst.x == b.worst.x && a.worst.y == b.worst.y && same(a.worst.error, b.worst.error) &&
         a.worst.cause == b.worst.cause &&
         std::equal(a.worst_of.begin(), a.worst_of.end(), b.worst_of.begin(), b.worst_of.end(),
                    [](const auto& x, const auto& y) {
                      return x.metric == y.metric && x.x == y.x && x.y == y.y && same(x.size, y.size);
                    }) &&
         same(a.lookup_curve, b.lookup_curve) && same(a.over_curve, b.over_curve) &&
         a.lookup_bounds == b.lookup_bounds &&
         std::equal(a.cascades.begin(), a.cascades.end(), b.cascades.begin(), b.cascades.end(),
                    [](const auto& x, const auto& y) {
                      return same(x.begin_m, y.begin_m) && same(x.end_m, y.end_m) && same(x.metrics, y.metrics) &&
                             x.bias_needed == y.bias_needed;
                    });
}

inline bool same(const PhaseDiagram& a, const PhaseDiagram& b) {
  const auto same_row = [](const PhaseRow& x, const PhaseRow& y) {
    return x.resolution == y.resolution && same(x.texel_m, y.texel_m) && same(x.last_acne_m, y.last_acne_m) &&
           std::all_of(phase_series().begin(), phase_series().end(),
                       [&](const PhaseSeries& series) { return same(x.*series.values, y.*series.values); });
  };
  const auto same_point = [](const PhasePoint& x, const PhasePoint& y) {
    return x.point == y.point && same(x.texel_m, y.texel_m) && same(x.bias_m, y.bias_m) && x.left_out == y.left_out;
  };
  return a.part == b.part && a.refused == b.refused && a.made_from == b.made_from && a.scene == b.scene &&
         a.light == b.light && a.technique == b.technique && a.render == b.render && a.width_px == b.width_px &&
         a.height_px == b.height_px && a.placements == b.placements && same(a.receivers, b.receivers) &&
         same(a.acne_bound, b.acne_bound) && same(a.peter_panning_bound, b.peter_panning_bound) &&
         same(a.range_m, b.range_m) && same(a.metres_per_bias, b.metres_per_bias) && same(a.bias_m, b.bias_m) &&
         same(a.law_at_bound, b.law_at_bound) && same(a.law_steepest, b.law_steepest) &&
         std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(), same_row) &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), same_point);
}

inline bool same(const LawResult& a, const LawResult& b) {
  return a.part == b.part && a.name == b.name && a.says == b.says && a.found == b.found && a.measured == b.measured &&
         a.predicted == b.predicted && a.relation == b.relation && a.tolerance == b.tolerance && a.join == b.join &&
         a.worst == b.worst && a.held == b.held && a.reproduce == b.reproduce &&
         std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(), b.samples.end(),
                    [](const LawResult::Sample& x, const LawResult::Sample& y) {
                      return x.point == y.point && same(x.predicted, y.predicted) && same(x.measured, y.measured) &&
                             same(x.allowed, y.allowed);
                    });
}

}  // namespace noonmark
