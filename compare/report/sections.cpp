// The sections of error against a setting: tables, and bars by cause.
#include "compare/report/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge/curve_reading.h"
#include "compare/report/blocks.h"
#include "compare/report/cause_colors.h"
#include "compare/report/cause_shares.h"
#include "compare/report/data.h"
#include "compare/report/part_answers.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using Classes = std::map<std::string, std::string>;

// Head cells and row cells for the part and the swept settings, which distinguish the points.
Markup swept_head(const Results& results, const Classes& classes) {
  Markup cells = th("Point");
  if (has_parts(results)) cells += th(css("text"), "Part");
  for (const std::string& name : results.info.swept)
    cells +=
        th(css(classes.at(name)), Attribute("title", name), with_small(setting_label(name), swept_unit(name, results)));
  return cells;
}

Markup swept_cells(const Results& results, const PointRecord& point, const Classes& classes) {
  Markup cells = row_head(point_link(point.id, point.id));
  if (has_parts(results)) cells += td(css("text"), point.part);
  for (const std::string& name : results.info.swept)
    cells += td(css(classes.at(name)), setting_text(setting_of(point, name)));
  return cells;
}

Markup bias_cells(double depth, const BiasCurve& curve) {
  return td(css("first"), number(depth * curve.m_per_depth)) + td(number(depth * curve.texels_per_depth)) +
         td(number(depth));
}

// What the curves of the points have in common. alike: all vary the same parameter and were made in the same way.
struct CurvesOfAll {
  const BiasCurve* first = nullptr;
  bool alike = true;
};

CurvesOfAll curves_of_all(const Results& results) {
  CurvesOfAll curves;
  for (const PointRecord& point : results.points) {
    if (!point.curve) continue;
    if (!curves.first) curves.first = &*point.curve;
    curves.alike =
        curves.alike && point.curve->parameter == curves.first->parameter && point.curve->made == curves.first->made;
  }
  return curves;
}

Markup window_row(const Results& results, const PointRecord& point, const Classes& classes, bool alike) {
  const BiasCurve& curve = *point.curve;
  const std::optional<Interval> usable = usable_window(point);
  Markup cells = swept_cells(results, point, classes);
  cells += usable ? bias_cells(usable->low, curve) + bias_cells(usable->high, curve)
                  : td(Attribute("colspan", 6), css("fails first"),
                       hides_window(point) ? std::string(window_not_known) : "none: no bias is good enough");
  cells += bias_cells(curve.best_bias_depth, curve) + td(cell(curve.best_error, "fraction"));
  cells += td(css("first"), number(curve.flat_min_depth * curve.m_per_depth), " … ",
              number(curve.flat_max_depth * curve.m_per_depth));
  if (!alike) cells += td(css("text"), curve.parameter) + td(css("text"), curve.made);
  return tr(css(usable ? "" : "broken"), cells);
}

// Two rows: what is told, and its units.
Markup windows_head(const Results& results, const Classes& classes, bool alike) {
  const auto wide = [](int columns, const Markup& name) {
    return th(css("first"), Attribute("colspan", columns), name);
  };
  Markup names = swept_head(results, classes) + wide(3, "Window from") + wide(3, "Window to") +
                 wide(4, "Least error at") + th(css("first"), "Within 10\u202f%", line_break(), "of the least");
  if (!alike) names += heads({"Parameter", "Made"});
  Markup units = td();
  for (size_t i = 0; i < results.info.swept.size() + (has_parts(results) ? 1 : 0); ++i) units += td();
  for (int i = 0; i < 3; ++i) units += th(css("first"), "m") + heads({"texels", "depth"});
  units += th("error %") + th(css("first"), "m");
  if (!alike) units += td() + td();
  return element("thead", tr(names), element("tr", css("units"), units));
}

Markup windows_table(const ShownPoints& shown, bool alike) {
  const Classes classes = text_classes(shown.all);
  Markup rows;
  size_t count = 0;
  for (const PointRecord& point : shown.results.points) {
    if (!point.curve) continue;
    ++count;
    rows += window_row(shown.all, point, classes, alike);
  }
  const Markup windows =
      element("table", css("numbers windows"), windows_head(shown.all, classes, alike), element("tbody", "\n", rows));
  return folded("", count <= open_rows,
                shown.note.empty() ? "Every window" : "The windows of the points that are shown",
                div(css("scroll"), windows) + "\n");
}

// The causes that the bars of frames have: the parts of R5 - R1.
bool is_part(std::string_view cause) { return cause != "light_size" && cause != "aliasing" && cause != "coverage"; }

}  // namespace

Markup chart_place(std::string_view name, const std::string& caption) {
  return element("figure", css("chart js-only"), Attribute("id", fmt::format("chart-{}", name)), div(css("controls")),
                 div(css("legend")), div(css("plot"), Attribute("role", "img"), Attribute("aria-label", caption)),
                 element("figcaption", caption)) +
         "\n";
}

std::map<std::string, std::string> text_classes(const Results& results) {
  std::map<std::string, std::string> classes;
  for (const std::string& name : results.info.swept) {
    const std::vector<std::string> values = values_of(results, name);
    const bool numbers = std::all_of(values.begin(), values.end(),
                                     [](const std::string& value) { return number_of(value).has_value(); });
    classes[name] = numbers ? "" : "text";
  }
  return classes;
}

Markup by_bias(const Markup& as_set, const Markup& recommended) {
  return span(css("as-set"), as_set) + span(css("as-recommended"), recommended);
}

Markup bias_section(const ShownPoints& shown) {
  const auto [first, alike] = curves_of_all(shown.all);
  if (!first) return "";  // the findings say why
  Markup out;
  for (const PointRecord& point : shown.all.points) {
    if (has_curve(point) || why_no_curve(point).empty()) continue;
    out += paragraph(css("small"), prose("Some points have no curve: {}.", why_no_curve(point)));
    break;
  }
  out += paragraph(prose(
      "Too little bias leaves acne; too much detaches shadows. The usable window is every bias that keeps acne within "
      "{} and Peter Panning within {} of the counted receivers{}.{}",
      quantity(first->acne_bound, "fraction"), quantity(first->peter_panning_bound, "fraction"),
      first->placements > 1 ? ", at every placement of the grid" : "",
      alike ? prose(" Varied: {}; made: {}.", code(first->parameter), first->made) : ""));
  out += shown.note;
  return section("bias", "Error against bias", out + windows_table(shown, alike));
}

namespace {

// A frame's bar: the parts of its error by place, as lengths of `largest`, which is the longest bar.
Markup place_row(const PointRecord& frame, const std::vector<CauseColor>& places,
                 const std::vector<std::string>& differing, double largest) {
  Markup parts;
  std::string told;
  for (const CauseColor& place : places) {
    const double value = metric_of(frame, std::string(place.name));
    if (!is_part(place.name) || !has_cause(frame, place.name)) continue;
    told += fmt::format("{}{} {}", told.empty() ? "" : ", ", metric_label(place.name), quantity(value, "fraction"));
    if (value > 0)
      parts += element("i", css(fmt::format("c-{}", place.name)),
                       Attribute("style", fmt::format("width:{:.3f}%", 100 * value / largest)));
  }
  const std::string name = settings_phrase(frame, differing);
  return div(css("row"), Attribute("data-point", frame.id), Attribute("title", told),
             span(css("name"), point_link(frame.id, name.empty() ? fmt::format("point {}", frame.id) : name)),
             span(css("track"), parts),
             span(css("value"), quantity(metric_of(frame, error_metric({&frame, 1})), "fraction"))) +
         "\n";
}

}  // namespace

Markup places_section(const ShownPoints& shown) {
  if (!judges_frames(shown.all.points)) return "";
  const std::vector<CauseColor> places = causes_of(shown.all.points);
  double largest = 0;
  for (const PointRecord& frame : shown.results.points) {
    double sum = 0;
    for (const CauseColor& place : places)
      if (const double value = metric_of(frame, std::string(place.name)); is_part(place.name) && value > 0)
        sum += value;
    largest = std::max(largest, sum);
  }
  // What every point shares does not tell the rows apart.
  std::vector<std::string> differing;
  for (const std::string& name : shown.all.info.swept)
    if (values_of(shown.all, name).size() > 1) differing.push_back(name);
  Markup legend, rows;
  for (const CauseColor& place : places)
    if (is_part(place.name)) legend += legend_entry(place.name, place.label);
  for (const PointRecord& frame : shown.results.points) rows += place_row(frame, places, differing, largest);
  return section(
      "places", "The error by place",
      paragraph("The part of the error at each place, as a share of counted receivers. The number at the end is "
                "the whole error, mean |frame − truth|. A place is no cause: a frame alone does not say what "
                "its map and its bias did. A frame whose own map was handed over is split by cause.") +
          shown.note + div(css("legend"), legend) + "\n" +
          div(css(shown.all.points.size() > open_rows ? "places many" : "places"), div(css("rows"), "\n", rows)));
}

}  // namespace noonmark::report
