#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "compare/judge/curve_reading.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/bias.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// Of a lookup whose bound darkens a lit slope, because the blur holds several of its depths: the bias that lifts it by their
// deviation (law 17). Empty if the settings have a bias.
std::string bias_of_slopes(const Settings& settings) {
  for (const BiasPart& part : bias_parts())
    if (settings.bias[part.name] != 0) return "";
  if (find_lookup(settings.lookup.kind).spread) return "bias.tan, by what a slope rises over the blur (law 17)";
  return fmt::format(
      "bias.unit = texel with bias.tan = {:.2g}, the deviation of a slope's depths in this blur (law 17)",
      blur_deviation_texels(settings));
}

bool reads(const Settings& settings, std::string_view name) {
  const auto& rows = find_lookup(settings.lookup.kind).reads;
  return std::any_of(rows.begin(), rows.end(), [&](const auto& read) { return read.parameter->setting == name; });
}

// Where the values of a setting are read that `curve.over` can vary: in the point's own curve, or how to get one.
std::string values_text(const PointRecord& point, std::string_view setting) {
  const std::vector<LookupCurvePoint>& curve = point.over_curve;
  if (curve.empty() || curve.front().parameter != setting)
    return fmt::format(" (curve.over = \"{}\" of an experiment gives its values)", setting);
  return fmt::format(" ({:.4g} errs least of the values of its curve)", least_shown(curve).value);
}

std::string precision_cures(const PointRecord& point, const Settings& settings) {
  std::vector<std::string> cures;
  for (const char* name : {"lookup.v_min", "lookup.floor", "lookup.moment_bias"})
    if (reads(settings, name)) cures.push_back(fmt::format("a larger {}{}", name, values_text(point, name)));
  if (settings.map.moments != MomentFormat::f32) cures.emplace_back("map.moments = 32f");
  if (cures.empty()) cures.emplace_back("near and far closer together");
  return fmt::format("{}", fmt::join(cures, "; or "));
}

}  // namespace

std::string cures_of_reduction(const PointRecord& point) {
  if (why_no_usable_reduction(point).empty()) return "";
  const Settings settings = settings_of(point);
  if (rounds_too_much(point)) return precision_cures(point, settings);
  const std::string& kind = settings.lookup.kind;
  const bool darkens = point.lookup_curve.front().over_darkening > point.lookup_bounds->acne_bound;
  std::vector<std::string> cures;
  if (const std::string bias = bias_of_slopes(settings); darkens && !bias.empty()) cures.push_back(bias);
  if (darkens && reads(settings, "lookup.moment_bias"))
    cures.push_back("a larger lookup.moment_bias" + values_text(point, "lookup.moment_bias"));
  cures.emplace_back("a smaller blur or a finer map");
  if (!darkens && reads(settings, "lookup.exponent")) cures.emplace_back("a larger lookup.exponent");
  if (!darkens && kind != "evsm4" && !kind.starts_with("msm"))
    cures.emplace_back("lookup.kind = evsm4 or msm, which leak less");
  return fmt::format("{}", fmt::join(cures, "; or "));
}

std::string no_reduction_text(const PointRecord& point) {
  const std::string why = why_no_usable_reduction(point);
  return why.empty() ? "" : fmt::format("{}. What may help: {}", why, cures_of_reduction(point));
}

std::string cures_of_precision(const PointRecord& point) {
  if (!(metric_of(point, "moment_precision") > metric_of(point, "error") / 2)) return "";
  return fmt::format(
      "most of the error is the rounding of the moments (moment_precision), which no reduction cures; what may help: "
      "{}",
      precision_cures(point, settings_of(point)));
}

}  // namespace noonmark
