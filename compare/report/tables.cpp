#include "compare/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <initializer_list>

#include "compare/report/cause_colors.h"
#include "compare/report/opening.h"
#include "compare/report/point_data.h"
#include "compare/report/sections.h"
#include "compare/report/text.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark::report {
namespace {

std::string_view mime_of(const std::string& path) {
  if (path.ends_with(".png")) return "image/png";
  if (path.ends_with(".jpg") || path.ends_with(".jpeg")) return "image/jpeg";
  return "";
}

std::string picture(const PictureRecord& record, const std::function<std::string(const std::string&)>& read_file) {
  std::string bytes, why = "it is empty";
  if (mime_of(record.path).empty()) {
    why = "browsers cannot show this kind of file";
  } else {
    try {
      bytes = read_file(record.path);
    } catch (const std::exception& error) {
      why = error.what();
    }
  }
  const std::string shown =
      bytes.empty()
          ? fmt::format("<p class=\"missing\">The picture {} is not shown: {}.</p>", html(record.path), html(why))
          : fmt::format("<img alt=\"{}: {}\" src=\"data:{};base64,{}\">", html(record.name), html(record.caption),
                        mime_of(record.path), base64(bytes));
  return fmt::format("<figure data-name=\"{0}\">{1}<figcaption><b>{0}</b> {2}</figcaption></figure>\n",
                     html(record.name), shown, html(record.caption));
}

// A metric with the same value at every point needs no column.
bool varies(const Results& results, const std::string& name) {
  const auto text = [&](const PointRecord& point) {
    return point.metrics.contains(name) ? fmt::format("{}", point.metrics.at(name)) : "";
  };
  return std::any_of(results.points.begin(), results.points.end(),
                     [&](const PointRecord& point) { return text(point) != text(results.points.front()); });
}

std::string pair(const std::string& name, const std::string& value) {
  return value.empty() ? "" : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html(name), html(value));
}

std::string joined(std::initializer_list<std::string> parts) {
  std::string out;
  for (const std::string& part : parts)
    if (!part.empty()) out += (out.empty() ? "" : ", ") + part;
  return out;
}

}  // namespace

std::string pictures_section(const Results& results, const ShownPoints& shown,
                             const std::function<std::string(const std::string&)>& read_file) {
  const std::map<int64_t, double> biases = recommended_biases(shown.groups);
  std::string sets;
  for (const PointRecord& point : results.points) {
    if (point.pictures.empty()) continue;
    const std::string phrase = settings_phrase(point, results.info.swept);
    sets += fmt::format("<div class=\"pictures\" data-point=\"{0}\"><h3>Point {0}{1}</h3>\n", point.id,
                        phrase.empty() ? "" : ": " + html(phrase));
    if (point.worst.x >= 0)
      sets += fmt::format("<p class=\"small\">Worst pixel: ({}, {}) from the top left, wrong by {}{}.</p>\n",
                          point.worst.x, point.worst.y, quantity(point.worst.error, "fraction"),
                          point.worst.cause.empty() ? "" : ", " + html(metric_label(point.worst.cause)));
    sets += "<div class=\"stage\">\n";
    for (const PictureRecord& record : pictures_for_page(point, biases)) sets += picture(record, read_file);
    sets += "</div></div>\n";
  }
  if (sets.empty()) return "";
  std::string out =
      "<section id=\"pictures\"><h2>Pictures</h2>\n"
      "<p class=\"js-only small\">Flip with <kbd>←</kbd> <kbd>→</kbd> or the number keys.</p>\n<div "
      "class=\"legend\">\n";
  for (const CauseColor& color : causes_of(results.points))
    if (color.name != "aliasing" && color.name != "coverage")
      out += fmt::format("<span>{}{}</span>\n", swatch(std::string(color.name)), html(color.label));
  for (const CauseColor& color : pixel_state_colors)
    out += fmt::format("<span>{}{}</span>\n", swatch(std::string(color.name)), html(color.label));
  return out + "</div>\n<div class=\"picture-picker js-only\"></div>\n" + sets + "</section>\n";
}

std::string engines_section(const Results& results) {
  if (results.info.engines.empty()) return "";
  return fmt::format(
      "<section id=\"engines\"><h2>In other engines</h2>\n<p>The settings of this experiment in each engine's own "
      "fields, "
      "and what an engine cannot express.</p>\n<details class=\"glossary\"><summary>What to type</summary>\n"
      "<pre class=\"engines\">{}</pre></details></section>\n",
      html(results.info.engines));
}

std::string points_section(const Results& results, const ShownPoints& shown) {
  if (results.points.empty()) return "";
  std::string out = fmt::format("<section id=\"points\"><h2>{}</h2>\n", shown.note.empty() ? "Every point" : "Points");
  const std::vector<Metric> metrics = metrics_of(results.points);
  std::vector<const Metric*> columns;
  std::string same;
  for (const Metric& metric : metrics) {
    const std::string name(metric.name);
    if (results.points.size() == 1 || varies(results, name))
      columns.push_back(&metric);
    else if (results.points.front().metrics.contains(name))
      same += fmt::format("{}{} {}", same.empty() ? "" : ", ", html(metric_label(name)),
                          quantity(metric_of(results.points.front(), name), metric.unit));
  }
  const bool parts = !results.points.front().part.empty();  // with parts the page has no chart of bias curves
  out += shown.note;
  // With JavaScript, page/points_table.js makes the rows when they are seen. Without, this table has them.
  out += "<p class=\"js-only small\">Click a head to sort, a row for the point's card.</p>\n";
  out += "<div class=\"points-place js-only\"></div>\n<noscript>";
  out += "<div class=\"scroll tall\"><table class=\"numbers\"><thead><tr><th>Point</th>";
  if (parts) out += "<th class=\"text\">Part</th>";
  const std::map<std::string, std::string> classes = text_classes(results);
  for (const std::string& name : results.info.swept) {
    const std::string unit = swept_unit(name, results);
    out += fmt::format("<th{} title=\"{}\">{}{}</th>", classes.at(name), html(name), html(setting_label(name)),
                       unit.empty() ? "" : fmt::format(" <small>{}</small>", html(unit)));
  }
  for (const Metric* metric : columns)
    out +=
        fmt::format("<th title=\"{}\">{}{}</th>", html(metric->help), html(metric_label(metric->name)),
                    head_unit(metric->unit).empty() ? "" : fmt::format(" <small>{}</small>", head_unit(metric->unit)));
  out += "</tr></thead><tbody>\n";
  for (const PointRecord& point : shown.results.points) {
    out += fmt::format("<tr id=\"p{0}\"><th scope=\"row\">{0}</th>", point.id);
    if (parts) out += fmt::format("<td class=\"text\">{0}</td>", html(point.part));
    for (const std::string& name : results.info.swept) {
      const std::string value = setting_of(point, name);
      out += fmt::format("<td{}>{}</td>", classes.at(name), html(setting_text(value)));
    }
    for (const Metric* metric : columns) {
      const std::string name(metric->name);
      if (!point.metrics.contains(name)) {
        out += "<td>–</td>";
        continue;
      }
      const double value = point.metrics.at(name);
      out += fmt::format("<td{}>{}</td>", std::isfinite(value) ? "" : " class=\"fails\"", cell(value, metric->unit));
    }
    out += "</tr>\n";
  }
  out += "</tbody></table></div></noscript>\n";
  out += "<p class=\"small only-print\">Paper has room for the first columns; results.csv has all.</p>\n";
  if (!same.empty()) out += fmt::format("<p class=\"small\">The same at every point: {}.</p>\n", same);
  return out + "</section>\n";
}

std::string meaning_section(const Results& results) {
  std::string out =
      "<section id=\"meaning\"><h2>What the numbers mean</h2>\n<p>For every pixel that sees a surface facing the "
      "light, a ladder of methods answers the same question: how lit is the surface? Each rung differs from the one "
      "before in one respect. R0: the light with its size. R1: one exact ray to the light's centre. R2: the filter's "
      "taps at their exact places (and, if the technique moves the lookup, at the moved places). R3: the taps at the "
      "centres of their texels. R4: the technique on an exact depth map. R5: the result of the GPU. Each step is the "
      "effect of one cause. Fractions are fractions of the counted receivers, which face the light and have a truth "
      "that is not "
      "ambiguous.</p>\n";
  for (const RungCause* cause : brought_causes(results.points))
    out += fmt::format(
        "<p>{}, a picture on top of the ladder, is judged in place of the rung below it. Its step is the "
        "cause {}.</p>\n",
        html(cause->rung), html(metric_label(cause->name)));
  const std::vector<Metric> metrics = metrics_of(results.points);
  std::string terms;
  for (const Metric& metric : metrics)
    terms += fmt::format(
        "<div><dt>{} <code>{}</code>{}</dt><dd>{}</dd></div>\n", html(metric_label(metric.name)), html(metric.name),
        head_unit(metric.unit).empty() ? "" : fmt::format(" <small>{}</small>", head_unit(metric.unit)),
        html(metric.help));
  if (!terms.empty())
    out += fmt::format(
        "<details class=\"glossary\"><summary>Each of the {} metrics in a sentence</summary><dl class=\"terms\">\n{}"
        "</dl></details>\n",
        metrics.size(), terms);
  std::string swept;
  for (const std::string& name : results.info.swept)
    for (const Setting& row : settings_table())
      if (row.name == name)
        swept += fmt::format(
            "<div><dt><code>{}</code>{}</dt><dd>{} Range: {}.</dd></div>\n", html(name),
            swept_unit(name, results).empty() ? "" : fmt::format(" <small>{}</small>", html(swept_unit(name, results))),
            html(row.help), html(row.range_text()));
  if (!swept.empty())
    out += "<details class=\"glossary\"><summary>The swept settings</summary><dl class=\"terms\">\n" + swept +
           "</dl></details>\n";
  return out + "</section>\n";
}

std::string making_section(const Results& results) {
  const RunInfo& info = results.info;
  std::string out = "<section id=\"making\"><h2>How it was made</h2>\n<dl class=\"made\">\n";
  out += pair("Command", info.command) + pair("Experiment", info.experiment);
  out += pair("Noonmark", info.version + (info.commit.empty() ? "" : ", commit " + info.commit));
  out +=
      pair("Scene",
           joined({info.scene_name, fmt::format("{} triangles", cell(static_cast<double>(info.triangles), "count"))}));
  out += pair("Processor", info.host_cpu);
  out += pair("OpenGL", joined({info.gl_renderer, info.gl_vendor, info.gl_version}));
  const bool timed = std::any_of(results.points.begin(), results.points.end(),
                                 [](const PointRecord& point) { return point.metrics.contains("shadow_ms"); });
  out += pair("Times from", timed ? info.gl_timer : "not measured; set times = true in the experiment");
  out += pair("Embree", joined({info.embree_version, info.embree_isa}));
  std::string libraries;
  for (const auto& [name, version] : info.libraries)
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", name, version);
  out += pair("Libraries", libraries) + "</dl>\n";
  for (const char* software : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (timed && info.gl_renderer.find(software) != std::string::npos)
      out += fmt::format(
          "<p class=\"note\">{} renders on the processor: its times are <b>software times</b>. They order settings "
          "roughly as a GPU would, but they do not predict a GPU's milliseconds.</p>\n",
          software);
  // The settings that all points share, for a reader who wants to repeat the experiment.
  std::string fixed;
  if (!results.points.empty())
    for (const auto& [name, value] : results.points.front().settings)
      if (std::find(info.swept.begin(), info.swept.end(), name) == info.swept.end()) fixed += pair(name, value);
  if (!fixed.empty())
    out += "<details class=\"more\"><summary>The settings that were not swept</summary><dl class=\"made\">\n" + fixed +
           "</dl></details>\n";
  return out + "</section>\n";
}

}  // namespace noonmark::report
