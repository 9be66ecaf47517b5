// The sections with charts: a place for each chart, which compare/report/page/charts.js fills, and the same numbers as
// a table.
#include "compare/report/sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "compare/judge/curve_reading.h"
#include "compare/report/cause_colors.h"
#include "compare/report/data.h"
#include "compare/report/findings.h"
#include "compare/report/rules.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

std::string folded(const std::string& title, size_t rows, const std::string& inner) {
  return fmt::format("<details{}><summary>{}</summary>\n{}</details>\n", rows <= open_rows ? " open" : "", title,
                     inner);
}

std::string point_link(const PointRecord& point) { return fmt::format("<a href=\"#p{0}\">{0}</a>", point.id); }

using Classes = std::map<std::string, std::string>;

// Head cells and row cells for the swept settings, which distinguish the points.
std::string swept_head(const Results& results, const Classes& classes) {
  std::string out = "<th>Point</th>";
  for (const std::string& name : results.info.swept) {
    const std::string unit = swept_unit(name, results);
    out += fmt::format("<th{} title=\"{}\">{}{}</th>", classes.at(name), html(name), html(setting_label(name)),
                       unit.empty() ? "" : fmt::format(" <small>{}</small>", html(unit)));
  }
  return out;
}

std::string swept_cells(const Results& results, const PointRecord& point, const Classes& classes) {
  std::string out = fmt::format("<th scope=\"row\">{}</th>", point_link(point));
  for (const std::string& name : results.info.swept)
    out += fmt::format("<td{}>{}</td>", classes.at(name), html(setting_text(setting_of(point, name))));
  return out;
}

std::string bias_cell(double depth, const BiasCurve& curve) {
  return fmt::format("<td class=\"first\">{}</td><td>{}</td><td>{}</td>", number(depth),
                     number(depth * curve.m_per_depth), number(depth * curve.texels_per_depth));
}

// The causes with stacked bars: the parts of R5 - R1.
bool is_part(std::string_view cause) { return cause != "light_size" && cause != "aliasing" && cause != "coverage"; }

}  // namespace

std::string chart_place(const std::string& name, const std::string& caption) {
  return fmt::format(
      "<figure class=\"chart js-only\" id=\"chart-{0}\"><div class=\"controls\"></div><div class=\"legend\"></div>"
      "<div class=\"plot\" role=\"img\" aria-label=\"{1}\"></div><figcaption>{1}</figcaption></figure>\n",
      name, caption);
}

std::map<std::string, std::string> text_classes(const Results& results) {
  std::map<std::string, std::string> classes;
  for (const std::string& name : results.info.swept) {
    const std::vector<std::string> values = values_of(results, name);
    const bool numbers = std::all_of(values.begin(), values.end(),
                                     [](const std::string& value) { return number_of(value).has_value(); });
    classes[name] = numbers ? "" : " class=\"text\"";
  }
  return classes;
}

std::string by_bias(const std::string& as_set, const std::string& recommended) {
  return fmt::format("<span class=\"as-set\">{}</span><span class=\"as-recommended\">{}</span>", as_set, recommended);
}

std::string swatch(const std::string& cause) { return fmt::format("<i class=\"sw c-{}\"></i>", html(cause)); }

std::string bias_section(const Results& results, const ShownPoints& shown) {
  const Classes classes = text_classes(results);
  std::string rows;
  size_t count = 0;
  const BiasCurve* first = nullptr;
  bool alike = true;  // whether all curves vary the same parameter and were made in the same way
  for (const PointRecord& point : results.points) {
    if (!point.curve) continue;
    if (!first) first = &*point.curve;
    alike = alike && point.curve->parameter == first->parameter && point.curve->made == first->made;
  }
  for (const PointRecord& point : shown.results.points) {
    if (!point.curve) continue;
    ++count;
    const BiasCurve& curve = *point.curve;
    const std::optional<Interval> usable = usable_window(curve);
    rows += fmt::format("<tr{}>{}", usable ? "" : " class=\"broken\"", swept_cells(results, point, classes));
    rows += usable ? bias_cell(usable->low, curve) + bias_cell(usable->high, curve)
                   : "<td colspan=\"6\" class=\"fails first\">none: no bias is good enough</td>";
    rows += bias_cell(curve.best_bias_depth, curve);
    rows += fmt::format("<td>{}</td><td class=\"first\">{} … {}</td>", cell(curve.best_error, "fraction"),
                        number(curve.flat_min_depth), number(curve.flat_max_depth));
    if (!alike)
      rows +=
          fmt::format("<td class=\"text\">{}</td><td class=\"text\">{}</td>", html(curve.parameter), html(curve.made));
    rows += "</tr>\n";
  }
  if (!first) return "";  // the findings say why
  std::string out = "<section id=\"bias\"><h2>Error against bias</h2>\n";
  for (const PointRecord& point : results.points) {
    if (why_no_curve(point).empty()) continue;
    out += fmt::format("<p class=\"small\">Some points have no curve: {}.</p>\n", why_no_curve(point));
    break;
  }
  out += fmt::format(
      "<p>Too little bias leaves acne; too much detaches shadows. The usable window is every bias that keeps acne "
      "within {} and "
      "Peter Panning within {} of the counted receivers{}.{}</p>\n",
      quantity(first->acne_bound, "fraction"), quantity(first->peter_panning_bound, "fraction"),
      first->placements > 1 ? ", at every placement of the grid" : "",
      alike ? fmt::format(" Varied: <code>{}</code>; made: {}.", html(first->parameter), html(first->made)) : "");
  out += shown.note;
  if (const size_t drawn = drawn_biases(*first, curve_entries(shown.results)).size(); drawn < first->bias_depth.size())
    out += fmt::format(
        "<p class=\"small\">The chart draws {} of the {} biases of a curve, evenly chosen. <code>results.sqlite</code> "
        "has "
        "all of them. Windows and best biases are of the exact curve.</p>\n",
        drawn, first->bias_depth.size());
  out += chart_place("bias", "Share of counted receivers by cause against the bias; the usable window is shaded.");
  std::string head =
      "<thead><tr>" + swept_head(results, classes) +
      "<th class=\"first\" colspan=\"3\">Window from</th><th class=\"first\" colspan=\"3\">Window to</th>"
      "<th class=\"first\" colspan=\"4\">Least error at</th><th class=\"first\">Within 10\u202f%<br>of the least</th>";
  if (!alike) head += "<th>Parameter</th><th>Made</th>";
  head += "</tr>\n<tr class=\"units\"><td></td>";
  for (size_t i = 0; i < results.info.swept.size(); ++i) head += "<td></td>";
  for (int i = 0; i < 3; ++i) head += "<th class=\"first\">depth</th><th>m</th><th>texels</th>";
  head += "<th>error %</th><th class=\"first\">depth</th>";
  if (!alike) head += "<td></td><td></td>";
  head += "</tr></thead>";
  out += folded(shown.note.empty() ? "Every window" : "The windows of the points that are shown", count,
                "<div class=\"scroll\"><table class=\"numbers windows\">" + head + "<tbody>\n" + rows +
                    "</tbody></table></div>\n");
  return out + "</section>\n";
}

std::string sweep_section(const Results& results, const ShownPoints& shown) {
  std::string out =
      "<p class=\"small\">The tables are of the error against the hard truth (R1). The charts offer the others.</p>\n" +
      shown.note;
  std::vector<std::string> labels;
  size_t charts = 0;
  for (const std::string& name : results.info.swept) {
    const std::vector<std::string> values = values_of(results, name);
    if (values.size() < 2 ||
        !std::all_of(values.begin(), values.end(), [](const auto& v) { return number_of(v).has_value(); }))
      continue;
    ++charts;
    labels.push_back(html(setting_label(name)));
    // Mean and worst over all other settings: the chart's trend in numbers.
    struct Trend {
      double sum = 0, worst = 0, best_sum = 0;
      size_t finite = 0, of = 0, curves = 0;
    };
    std::unordered_map<std::string, Trend> trends;
    for (const PointRecord& point : results.points) {
      Trend& trend = trends[setting_of(point, name)];
      ++trend.of;
      if (point.curve && std::isfinite(point.curve->best_error))
        trend.best_sum += point.curve->best_error, ++trend.curves;
      const double error = metric_of(point, "error");
      if (!std::isfinite(error)) continue;
      ++trend.finite, trend.sum += error, trend.worst = std::max(trend.worst, error);
    }
    std::string rows;
    for (const std::string& value : values) {
      const auto& [sum, worst, best_sum, finite, of, curves] = trends[value];
      const double none = std::nan("");
      rows += fmt::format(
          "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", html(setting_text(value)),
          cell(finite ? sum / static_cast<double>(finite) : none, "fraction"), cell(finite ? worst : none, "fraction"),
          curves ? cell(best_sum / static_cast<double>(curves), "fraction") : "–",
          finite == of ? fmt::format("{}", of) : fmt::format("{} ({} not finite)", of, of - finite));
    }
    const std::string unit = swept_unit(name, results);
    out += fmt::format("<div class=\"swept\"><h3>{}</h3>\n", html(name));
    out += chart_place(fmt::format("sweep-{}", charts),
                       fmt::format("Error against {}; one line for each combination of the other swept settings.",
                                   html(setting_label(name))));
    out += fmt::format(
        "<div class=\"scroll fit\"><table class=\"numbers small-table\"><thead><tr><th>{}{}</th><th>Mean error "
        "<small>%</small></th>"
        "<th>Worst error <small>%</small></th><th>Mean error at best bias "
        "<small>%</small></th><th>Points</th></tr></thead><tbody>\n{}</tbody></table></div></div>\n",
        html(setting_label(name)), unit.empty() ? "" : fmt::format(" <small>{}</small>", html(unit)), rows);
  }
  if (labels.empty()) return "";
  return fmt::format("<section id=\"sweep\"><h2>Error against {}</h2>\n{}</section>\n", fmt::join(labels, ", "), out);
}

std::string budget_section(const Results& results, const ShownPoints& shown) {
  if (results.points.empty()) return "";
  const std::vector<CauseColor> causes = causes_of(results.points);
  double largest = 0;
  for (const PointRecord& point : shown.results.points) {
    double sum = 0;
    for (const CauseColor& cause : causes)
      if (const double value = metric_of(point, std::string(cause.name));
          is_part(cause.name) && value > 0 && std::isfinite(value))
        sum += value;
    largest = std::max(largest, sum);
  }
  // What every point shares does not tell the rows apart.
  std::vector<std::string> differing;
  for (const std::string& name : results.info.swept)
    if (values_of(results, name).size() > 1) differing.push_back(name);
  std::string legend, rows;
  for (const CauseColor& cause : causes)
    if (is_part(cause.name))
      legend += fmt::format("<span>{}{}</span>\n", swatch(std::string(cause.name)), html(cause.label));
  for (const PointRecord& point : shown.results.points) {
    std::vector<std::pair<std::string_view, double>> sizes;
    std::string parts, told;
    double sum = 0;
    for (const CauseColor& cause : causes) {
      const double value = metric_of(point, std::string(cause.name));
      if (!is_part(cause.name)) continue;
      if (std::isnan(value) && !point.metrics.contains(std::string(cause.name))) continue;
      told += fmt::format("{}{} {}", told.empty() ? "" : ", ", metric_label(cause.name), quantity(value, "fraction"));
      if (!std::isfinite(value) || value <= 0) continue;
      sum += value;
      sizes.emplace_back(cause.name, value);
    }
    // Percent of the bar, because flex factors that sum to less than 1 would not fill it.
    for (const auto& [name, value] : sizes)
      parts += fmt::format("<i class=\"c-{}\" style=\"flex-grow:{:.4f}\"></i>", name, 100 * value / sum);
    const auto phrase = [&](const std::vector<std::string>& names) {
      const std::string text = settings_phrase(point, names);
      return html(text.empty() ? fmt::format("point {}", point.id) : text);
    };
    const std::vector<std::string> at_bias = without_curve_parameter(point, differing);
    rows += fmt::format(
        "<div class=\"row\" data-point=\"{1}\" title=\"{0}\"><span class=\"name\"><a href=\"#p{1}\">{2}</a></span>"
        "<span class=\"track\"><span class=\"bar\" style=\"--size:{3:.5f}\">{4}</span></span><span "
        "class=\"value\">{5}</span></div>\n",
        html(told), point.id,
        at_bias.size() == differing.size() ? phrase(differing) : by_bias(phrase(differing), phrase(at_bias)),
        largest > 0 ? sum / largest : 0, parts, quantity(metric_of(point, "error"), "fraction"));
  }
  return fmt::format(
      "<section id=\"budget\"><h2>The error budget</h2>\n<p>The part of the error that each cause adds, {}, as a share "
      "of counted receivers. The number at the end is the whole error, mean |{} − R1|. With a filter, causes can "
      "cancel in it, "
      "and displacement can cancel with the others, so the bar can be longer.</p>\n{}"
      "<div class=\"legend\">{}</div>\n"
      "<div class=\"budget{}\"><input type=\"radio\" name=\"budget\" id=\"budget-size\" checked><label "
      "for=\"budget-size\">By size</label>"
      "<input type=\"radio\" name=\"budget\" id=\"budget-share\"><label for=\"budget-share\">By share</label>\n<div "
      "class=\"rows\">\n{}</div></div></section>\n",
      by_bias("with the bias as rendered",
              "with the recommended bias (causes that no curve gives are those of the bias as rendered)"),
      judged_rung(results.points.front()), shown.note, legend, results.points.size() > open_rows ? " many" : "", rows);
}

}  // namespace noonmark::report
