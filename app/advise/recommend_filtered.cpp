#include "app/advise/recommend_filtered.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/advise/engine_forms.h"
#include "app/advise/recommend_judge.h"
#include "compare/judge/recommendation.h"
#include "compare/ladder/reduction_window.h"
#include "compare/results/number_text.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/filters.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// As docs/how-to/filtered-maps.md advises for 32-bit floats. Other parameters have their defaults.
constexpr double evsm_floor = 1e-4;

// VSM, ESM and EVSM with one warp need no bias on a lit plane; the others are too dark there without one (law 17).
bool darkens_planes(std::string_view lookup) { return lookup == "evsm4" || lookup.starts_with("msm"); }

std::vector<FilterSettings> blurs() {
  return {{"none", {}}, {"box", {{"size", 3}}}, {"box", {{"size", 5}}}, {"box", {{"size", 7}}}};
}

BiasLevel filtered_level(const std::string& lookup, bool with_bias) {
  BiasLevel level;
  level.name = lookup + (with_bias ? " with a bias of the blur's deviation by the slope's tangent" : " without a bias");
  level.lookup = lookup;
  level.blurs = blurs();
  level.apply = [lookup, with_bias](Settings& settings) {
    bias_levels().front().apply(settings);
    settings.lookup = LookupSettings(lookup, {});
    if (lookup.starts_with("evsm")) settings.lookup["floor"] = evsm_floor;
    if (!with_bias) return;
    settings.bias.unit = BiasUnit::texel;
    settings.bias["tan"] = short_deviation(find_filter(settings.filter.kind).blur(settings.filter));
  };
  return level;
}

}  // namespace

std::vector<std::string> searched_lookups() {
  std::vector<std::string> names;
  for (const LookupKind& lookup : lookups()) names.emplace_back(lookup.name);
  return names;
}

double short_deviation(std::span<const double> weights) {
  return std::ceil(blur_deviation_texels(weights) * 100) / 100;
}

std::vector<BiasLevel> filtered_levels(const std::vector<std::string>& lookups, const CurveOptions& searched) {
  std::vector<BiasLevel> levels;
  for (const std::string& lookup : lookups) {
    if (find_lookup(lookup).compares()) continue;
    if (!reduction_is_free(lookup)) {
      for (BiasLevel& level : engine_form_levels(lookup, searched)) levels.push_back(std::move(level));
      continue;
    }
    levels.push_back(filtered_level(lookup, false));
    if (darkens_planes(lookup)) levels.push_back(filtered_level(lookup, true));
  }
  return levels;
}

FilteredShares filtered_shares(const PointRecord& point) {
  return {worst_placed(point, "leak"), worst_placed(point, "over_darkening"), worst_placed(point, "reduction"),
          worst_placed(point, "peter_panning")};
}

void raise(FilteredShares& most, const FilteredShares& other) {
  most.leak = std::max(most.leak, other.leak);
  most.over_darkening = std::max(most.over_darkening, other.over_darkening);
  most.reduction = std::max(most.reduction, other.reduction);
  most.peter_panning = std::max(most.peter_panning, other.peter_panning);
}

std::string why_not_filtered(const FilteredShares& shares, const CurveOptions& bounds) {
  std::vector<std::string> broken;
  const auto hold = [&](const char* what, double share, double bound) {
    if (!(share <= bound))
      broken.push_back(fmt::format("{} {}, more than {}", what, share_text(share), share_text(bound)));
  };
  hold("it leaks", shares.leak, bounds.peter_panning_bound);
  hold("its Peter Panning is", shares.peter_panning, bounds.peter_panning_bound);
  hold("its over-darkening is", shares.over_darkening, bounds.acne_bound);
  hold("its reduction darkens", shares.reduction, bounds.acne_bound);
  return fmt::format("{}", fmt::join(broken, "; "));
}

std::string searched_filtered_text() {
  return fmt::format(
      "{:.0f}% of the bound on leak and Peter Panning (--peter-panning) and {:.0f}% of that on over-darkening and "
      "reduction (--acne)",
      100 * searched_peter_panning, 100 * searched_acne);
}

double typed_reduction(double value, double low, double high) {
  constexpr double much = 0.0025, share = 0.025;  // less changes no third digit of an error that people read
  for (int decimals = 1; decimals <= 17; ++decimals) {
    const double step = std::pow(10.0, -decimals);
    for (const double near : {std::round(value / step), std::ceil(low / step), std::floor(high / step)}) {
      const double typed = std::strtod(fmt::format("{:.{}f}", near * step, decimals).c_str(), nullptr);
      if (typed >= low && typed <= high && std::abs(typed - value) <= std::max(much, share * value)) return typed;
    }
  }
  return value;
}

std::string window_text(const ReductionChoice& choice) {
  for (int decimals = 3; decimals <= 17; ++decimals) {
    const double step = std::pow(10.0, -decimals);
    const std::string low = fmt::format("{:.{}f}", std::ceil(choice.low / step) * step, decimals),
                      high = fmt::format("{:.{}f}", std::floor(choice.high / step) * step, decimals);
    const double from = std::strtod(low.c_str(), nullptr), to = std::strtod(high.c_str(), nullptr);
    if (choice.low <= from && from <= choice.value && choice.value <= to && to <= choice.high)
      return fmt::format("{:g} to {:g}", from, to);
  }
  return fmt::format("{} to {}", choice.low, choice.high);
}

std::vector<Settings> placed_on_grid(const Settings& settings, int n, double from) {
  std::vector<Settings> placed;
  for (int v = 0; v < n; ++v)
    for (int u = 0; u < n; ++u) {
      placed.push_back(settings);
      placed.back().map.placements = 1;
      placed.back().map.shift_u_texels += (u + from) / n;
      placed.back().map.shift_v_texels += (v + from) / n;
    }
  return placed;
}

namespace {

// The window of the point's reductions, at every placement that was measured. Empty: none keeps both bounds.
std::optional<ReductionChoice> window_of(const PointRecord& point) {
  const char* const ending = has_placements(point) ? "_worst" : "";
  const std::optional<double> low = quantity(point, fmt::format("reduction_min{}", ending)),
                              high = quantity(point, fmt::format("reduction_max{}", ending));
  if (!low || !high) return std::nullopt;
  return ReductionChoice{metric_of(point, "best_reduction"), *low, *high};
}

}  // namespace

std::string why_no_reduction(const PointRecord& point, const CurveOptions& searched) {
  FilteredShares shares = filtered_shares(point);
  if (!reduction_is_free(setting_of(point, "lookup.kind"))) return why_not_filtered(shares, searched);
  const double leak = shares.leak;
  shares.leak = shares.reduction = 0;
  if (std::string broken = why_not_filtered(shares, searched); !broken.empty()) return broken;
  if (window_of(point)) return "";
  return fmt::format(
      "no lookup.reduction keeps the leak within {} and what it darkens within {}: without one it leaks {}",
      share_text(searched.peter_panning_bound), share_text(searched.acne_bound), share_text(leak));
}

namespace {

// The point is the worst so far. False if it breaks a bound.
bool take_point(Workbench& bench, Tried& tried, PointRecord shown, const CurveOptions& searched,
                const std::string& accuracy) {
  const double error = worst_placed(shown, placed_accuracy(bench, settings_of(shown), accuracy));
  tried.why_not = why_not_filtered(filtered_shares(shown), searched);
  const bool broken = !tried.why_not.empty();
  if (broken || !tried.worst || !(error <= tried.error)) tried.error = error, tried.worst = std::move(shown);
  return !broken;
}

void judge_as_is(Workbench& bench, Tried& tried, const std::vector<PointRecord>& points, const CurveOptions& searched,
                 const std::string& accuracy) {
  tried.as_is = std::all_of(points.begin(), points.end(), [&](const PointRecord& point) {
    return take_point(bench, tried, point, searched, accuracy);
  });
}

void judge_reduction(Workbench& bench, Tried& tried, const std::vector<PointRecord>& points,
                     const CurveOptions& searched, const std::string& accuracy) {
  ReductionChoice choice{0, 0, most_reduction};
  double most_error = -1;
  for (const PointRecord& point : points) {
    tried.why_not = why_no_reduction(point, searched);
    tried.worst = point;
    if (!tried.why_not.empty()) return;
    const ReductionChoice window = *window_of(point);
    choice.low = std::max(choice.low, window.low);
    choice.high = std::min(choice.high, window.high);
    // The least error in the condition that errs most.
    if (const double error = metric_of(point, "best_reduction_error"); error > most_error)
      most_error = error, choice.value = window.value;
  }
  if (choice.low > choice.high) {
    tried.why_not = "no lookup.reduction is usable under every condition";
    return;
  }
  choice.value = std::clamp(choice.value, choice.low, choice.high);
  choice.value = typed_reduction(choice.value, choice.low, choice.high);
  tried.settings.lookup["reduction"] = choice.value;
  tried.reduction = choice;
  tried.worst.reset();
  for (const PointRecord& point : points) {
    Settings there = settings_of(point);
    there.lookup["reduction"] = choice.value;
    PointRecord shown = bench.measure(there, std::nullopt, metric_set_for(accuracy), Checks::none).record;
    if (!take_point(bench, tried, std::move(shown), searched, accuracy)) return;
  }
}

}  // namespace

void judge_filtered(Workbench& bench, Tried& tried, const std::vector<PointRecord>& points,
                    const CurveOptions& searched, const std::string& accuracy) {
  tried.reduction.reset();
  tried.as_is = false;
  tried.worst.reset();
  tried.why_not.clear();
  if (reduction_is_free(tried.settings.lookup.kind))
    judge_reduction(bench, tried, points, searched, accuracy);
  else
    judge_as_is(bench, tried, points, searched, accuracy);
}

}  // namespace noonmark
