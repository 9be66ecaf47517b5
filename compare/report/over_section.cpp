#include "compare/report/over_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/judge/curve_reading.h"
#include "compare/report/data.h"
#include "compare/report/sections.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

struct DrawnOver {
  const char* name;
  double LookupCurvePoint::*value;
};
constexpr DrawnOver series_of_over[] = {
    {"value", &LookupCurvePoint::value},
    {"error", &LookupCurvePoint::shown_error},
    {"exact_map", &LookupCurvePoint::error},
    {"leak", &LookupCurvePoint::leak},
    {"over_darkening", &LookupCurvePoint::over_darkening},
    {"peter_panning", &LookupCurvePoint::peter_panning},
    {"reduction", &LookupCurvePoint::reduction},
};

Markup least_row(const PointRecord& point, const std::vector<std::string>& swept) {
  std::string phrase = settings_phrase(point, swept);
  if (!point.part.empty()) phrase = point.part + (phrase.empty() ? "" : ": ") + phrase;
  const LookupCurvePoint& least = least_shown(point.over_curve);
  return tr(td(css("text"), point_link(point.id, phrase.empty() ? fmt::format("Point {}", point.id) : phrase)) +
            td(css("text"), code(least.parameter)) + td(setting_of(point, least.parameter)) +
            td(cell(metric_of(point, "error"), "fraction")) + td(number(least.value)) +
            td(cell(least.shown_error, "fraction")) + td(cell(least.error, "fraction")));
}

}  // namespace

nlohmann::json over_of(const PointRecord& point) {
  if (point.over_curve.empty()) return {};
  nlohmann::json json{{"parameter", point.over_curve.front().parameter}};
  for (const LookupCurvePoint& at : point.over_curve)
    for (const DrawnOver& series : series_of_over) json[series.name].push_back(drawn_value(at.*series.value));
  if (point.over_curve.front().parameter == "bias.constant") json["unit"] = setting_of(point, "bias.unit");
  if (const auto set = number_of(setting_of(point, point.over_curve.front().parameter))) json["as_set"] = *set;
  return json;
}

Markup over_section(const Results& results, const ShownPoints& shown) {
  const auto has = [](const PointRecord& point) { return !point.over_curve.empty(); };
  const size_t count = static_cast<size_t>(std::count_if(results.points.begin(), results.points.end(), has));
  if (count == 0) return "";
  Markup out = paragraph(prose(
      "Only the lookup reads this setting, so other values of it need no other map ({}). The error is what OpenGL "
      "shows, from the moments that it fetched; the causes are those on the exact map, without rounding. Where the "
      "two errors are apart, the rounding of {} is the difference.",
      code("curve.over"), code("map.moments")));
  out += shown.note;
  out += chart_place("over", "Error and causes of a filtered shadow map against a setting of its lookup.");
  Markup rows;
  for (const PointRecord& point : shown.results.points)
    if (has(point)) rows += least_row(point, results.info.swept);
  const Markup head = th(css("text"), "Point") + th(css("text"), "Setting") + th("As set") +
                      th(with_small("Error", "%")) + th("Least error at") + th(with_small("Error there", "%")) +
                      th(with_small("On the exact map", "%"));
  out += folded("", count <= open_rows, "The value of least error of each point",
                div(css("scroll"), table("numbers", head, rows)) + "\n");
  return section("over", "Error against another setting of the lookup", out);
}

}  // namespace noonmark::report
