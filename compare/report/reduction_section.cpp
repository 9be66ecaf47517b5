#include "compare/report/reduction_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/judge/curve_reading.h"
#include "compare/judge/moment_cures.h"
#include "compare/report/data.h"
#include "compare/report/sections.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

struct Series {
  const char* name;
  double LookupCurvePoint::*value;
};
constexpr Series drawn_series[] = {{"value", &LookupCurvePoint::value},
                                   {"error", &LookupCurvePoint::shown_error},
                                   {"leak", &LookupCurvePoint::leak},
                                   {"over_darkening", &LookupCurvePoint::over_darkening},
                                   {"peter_panning", &LookupCurvePoint::peter_panning},
                                   {"reduction", &LookupCurvePoint::reduction}};

bool is_placed(const PointRecord& point) { return point.metrics.contains("error_mean"); }

// placed: whether the table has columns for the placements of the map's grid.
Markup window_row(const PointRecord& point, const std::vector<std::string>& swept, bool placed) {
  std::string phrase = settings_phrase(point, swept);
  if (!point.part.empty()) phrase = point.part + (phrase.empty() ? "" : ": ") + phrase;
  const auto metric = [&](const char* name) { return metric_of(point, name); };
  const bool hidden = hides_window(point), usable = !hidden && !std::isnan(metric("reduction_min"));
  Markup cells = td(css("text"), point_link(point.id, phrase.empty() ? fmt::format("Point {}", point.id) : phrase)) +
                 td(setting_of(point, "lookup.reduction"));
  cells += usable ? td(number(metric("reduction_min"))) + td(number(metric("reduction_max")))
                  : td(Attribute("colspan", 2), hidden ? std::string(window_not_known) : "none");
  if (placed && (hidden || !is_placed(point)))
    cells += td(Attribute("colspan", 2), "–");
  else if (placed && std::isnan(metric("reduction_min_worst")))
    cells += td(Attribute("colspan", 2), "none");
  else if (placed)
    cells += td(number(metric("reduction_min_worst"))) + td(number(metric("reduction_max_worst")));
  const LookupCurvePoint& least = least_shown(point.lookup_curve);
  cells += td(number(least.value)) + td(cell(least.shown_error, "fraction"));
  return tr(css(usable ? "" : "broken"), cells);
}

}  // namespace

size_t points_with_reductions(const std::vector<PointRecord>& points) {
  return static_cast<size_t>(
      std::count_if(points.begin(), points.end(), [](const auto& p) { return !p.lookup_curve.empty(); }));
}

nlohmann::json reductions_of(const PointRecord& point, size_t points) {
  const std::vector<LookupCurvePoint>& curve = point.lookup_curve;
  if (curve.empty()) return {};
  const size_t step = 1 + points * curve.size() / max_curve_entries;
  nlohmann::json json;
  for (size_t i = 0; i < curve.size(); i += step)
    for (const Series& series : drawn_series) json[series.name].push_back(drawn_value(curve[i].*series.value));
  const LookupCurvePoint& least = least_shown(curve);
  json["least"] = {{"value", least.value}, {"error", drawn_value(least.shown_error)}};
  if (const auto set = number_of(setting_of(point, "lookup.reduction"))) json["as_set"] = *set;
  if (point.lookup_bounds)
    json["acne_bound"] = point.lookup_bounds->acne_bound,
    json["peter_panning_bound"] = point.lookup_bounds->peter_panning_bound;
  if (std::string why = why_no_usable_reduction(point); !why.empty()) {
    why[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(why[0])));
    json["why"] = fmt::format("{}. What may help: {}", why, cures_of_reduction(point));
  }
  return json;
}

Markup reduction_section(const Results& results, const ShownPoints& shown) {
  if (points_with_reductions(results.points) == 0) return "";
  Markup out = paragraph(prose(
      "{} r removes leaks of up to r and darkens the rest: (L − r) / (1 − r). It is arithmetic on the result, so the "
      "causes are exact for every r, on the exact map and without rounding; the error, and where it is least, is what "
      "OpenGL shows. In the usable window the leak is within the bound on Peter Panning ({}), and over-darkening and "
      "what the reduction darkens "
      "are "
      "each within that on acne ({}).",
      code("lookup.reduction"), code("curve.peter_panning_bound"), code("curve.acne_bound")));
  out += shown.note;
  out += chart_place(
      "reduction", "Error and causes of a filtered shadow map against lookup.reduction; the usable window is shaded.");
  const std::vector<PointRecord>& points = shown.results.points;
  const bool placed = std::any_of(points.begin(), points.end(),
                                  [](const auto& point) { return !point.lookup_curve.empty() && is_placed(point); });
  Markup rows;
  for (const PointRecord& point : points)
    if (!point.lookup_curve.empty()) rows += window_row(point, results.info.swept, placed);
  Markup head = th(css("text"), "Point") + th("As set") + th("Usable from") + th("to");
  if (placed) head += th("At every placement from") + th("to");
  head += th("Least error at") + th(with_small("Error there", "%"));
  const size_t count = points_with_reductions(points);
  out += folded("", count <= open_rows, "Every window of the reduction",
                div(css("scroll"), table("numbers", head, rows)) + "\n");
  return section("reduction", "Error against light-bleed reduction", out);
}

}  // namespace noonmark::report
