#include "compare/report/lookup_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/judge/curve_reading.h"
#include "compare/report/blocks.h"
#include "compare/report/data.h"
#include "compare/report/sections.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using Curve = std::vector<LookupCurvePoint>;

struct Series {
  const char* name;
  double LookupCurvePoint::*value;
};
constexpr Series drawn_series[] = {{"value", &LookupCurvePoint::value},
                                   {"error", &LookupCurvePoint::shown_error},
                                   {"exact_map", &LookupCurvePoint::error},
                                   {"leak", &LookupCurvePoint::leak},
                                   {"over_darkening", &LookupCurvePoint::over_darkening},
                                   {"peter_panning", &LookupCurvePoint::peter_panning},
                                   {"reduction", &LookupCurvePoint::reduction}};

// step: every so many of the curve's values are drawn.
nlohmann::json curve_of(const PointRecord& point, const Curve& curve, size_t step) {
  if (curve.empty()) return {};
  const std::string& parameter = curve.front().parameter;
  nlohmann::json json{{"parameter", parameter}};
  if (parameter == "bias.constant") json["unit"] = setting_of(point, "bias.unit");
  for (size_t i = 0; i < curve.size(); i += step)
    for (const Series& series : drawn_series) json[series.name].push_back(drawn_value(curve[i].*series.value));
  const LookupCurvePoint& least = least_shown(curve);
  json["least"] = {{"value", least.value}, {"error", drawn_value(least.shown_error)}};
  if (const auto set = number_of(setting_of(point, parameter))) json["as_set"] = *set;
  return json;
}

bool is_placed(const PointRecord& point) { return point.metrics.contains("error_mean"); }

Markup point_cell(const PointRecord& point, const std::vector<std::string>& swept) {
  std::string phrase = settings_phrase(point, swept);
  if (!point.part.empty()) phrase = point.part + (phrase.empty() ? "" : ": ") + phrase;
  return td(css("text"), point_link(point.id, phrase.empty() ? fmt::format("Point {}", point.id) : phrase));
}

// placed: the table also has the columns of the placements (map.placements above 1).
Markup window_row(const PointRecord& point, const std::vector<std::string>& swept, bool placed) {
  const auto metric = [&](const char* name) { return metric_of(point, name); };
  const bool hidden = hides_window(point), usable = !hidden && !std::isnan(metric("reduction_min"));
  Markup cells = point_cell(point, swept) + td(setting_of(point, "lookup.reduction"));
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

Markup least_row(const PointRecord& point, const std::vector<std::string>& swept) {
  const LookupCurvePoint& least = least_shown(point.over_curve);
  return tr(point_cell(point, swept) + td(css("text"), code(least.parameter)) + td(setting_of(point, least.parameter)) +
            td(cell(metric_of(point, "error"), "fraction")) + td(number(least.value)) +
            td(cell(least.shown_error, "fraction")) + td(cell(least.error, "fraction")));
}

// The points of the page that have such a curve.
std::vector<const PointRecord*> points_with(Curve PointRecord::*curve, const ShownPoints& shown) {
  std::vector<const PointRecord*> points;
  for (const PointRecord& point : shown.results.points)
    if (!(point.*curve).empty()) points.push_back(&point);
  return points;
}

Markup folded_table(size_t rows, const std::string& title, const Markup& head, const Markup& body) {
  return folded("", rows <= open_rows, title, div(css("scroll"), table("numbers", head, body)) + "\n");
}

}  // namespace

nlohmann::json reductions_of(const PointRecord& point, size_t points) {
  nlohmann::json json = curve_of(point, point.lookup_curve, 1 + points * point.lookup_curve.size() / max_curve_entries);
  if (json.is_null()) return json;
  if (point.lookup_bounds)
    json["acne_bound"] = point.lookup_bounds->acne_bound,
    json["peter_panning_bound"] = point.lookup_bounds->peter_panning_bound;
  if (std::string why = no_reduction_text(point); !why.empty()) {
    why[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(why[0])));
    json["why"] = std::move(why);
  }
  return json;
}

nlohmann::json over_of(const PointRecord& point) { return curve_of(point, point.over_curve, 1); }

Markup reduction_section(const ShownPoints& shown) {
  const std::vector<const PointRecord*> points = points_with(&PointRecord::lookup_curve, shown);
  if (points.empty()) return "";
  Markup out = paragraph(prose(
      "{} r removes leaks of up to r and darkens the rest: (L − r) / (1 − r). It is arithmetic on the result, so the "
      "causes are exact for every r, on the exact map and without rounding; the error, and where it is least, is what "
      "OpenGL shows. In the usable window the leak is within the bound on Peter Panning ({}), and over-darkening and "
      "what the reduction darkens are each within that on acne ({}).",
      code("lookup.reduction"), code("curve.peter_panning_bound"), code("curve.acne_bound")));
  out += shown.note;
  out += chart_place(
      "reduction", "Error and causes of a filtered shadow map against lookup.reduction; the usable window is shaded.");
  const bool placed = std::any_of(points.begin(), points.end(), [](const auto* point) { return is_placed(*point); });
  Markup rows;
  for (const PointRecord* point : points) rows += window_row(*point, shown.all.info.swept, placed);
  Markup head = th(css("text"), "Point") + th("As set") + th("Usable from") + th("to");
  if (placed) head += th("At every placement from") + th("to");
  head += th("Least error at") + th(with_small("Error there", "%"));
  return section("reduction", "Error against light-bleed reduction",
                 out + folded_table(points.size(), "Every window of the reduction", head, rows));
}

Markup over_section(const ShownPoints& shown) {
  const std::vector<const PointRecord*> points = points_with(&PointRecord::over_curve, shown);
  if (points.empty()) return "";
  Markup out = paragraph(prose(
      "Only the lookup reads this setting, so other values of it need no other map ({}). The error is what OpenGL "
      "shows, from the moments that it fetched; the causes are those on the exact map, without rounding. Where the "
      "two errors are apart, the rounding of {} is the difference.",
      code("curve.over"), code("map.moments")));
  out += shown.note;
  out += chart_place("over", "Error and causes of a filtered shadow map against a setting of its lookup.");
  Markup rows;
  for (const PointRecord* point : points) rows += least_row(*point, shown.all.info.swept);
  const Markup head = th(css("text"), "Point") + th(css("text"), "Setting") + th("As set") +
                      th(with_small("Error", "%")) + th("Least error at") + th(with_small("Error there", "%")) +
                      th(with_small("On the exact map", "%"));
  return section("over", "Error against another setting of the lookup",
                 out + folded_table(points.size(), "The value of least error of each point", head, rows));
}

}  // namespace noonmark::report
