#include "compare/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compare/report/blocks.h"
#include "compare/report/cause_colors.h"
#include "compare/report/data.h"
#include "compare/report/lights_section.h"
#include "compare/report/opening.h"
#include "compare/report/point_data.h"
#include "compare/report/section_picture.h"
#include "compare/report/sections.h"
#include "compare/report/text.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark::report {
namespace {

using ReadFile = std::function<std::string(const std::string&)>;

std::string_view mime_of(const std::string& path) {
  if (path.ends_with(".png")) return "image/png";
  if (path.ends_with(".jpg") || path.ends_with(".jpeg")) return "image/jpeg";
  return "";
}

// The picture's bytes in the page, or why there are none.
Markup image_of(const PictureRecord& record, const ReadFile& read_file) {
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
  if (bytes.empty()) return element("p", css("missing"), prose("The picture {} is not shown: {}.", record.path, why));
  return element("img", Attribute("alt", fmt::format("{}: {}", record.name, record.caption)),
                 Attribute("src", fmt::format("data:{};base64,{}", mime_of(record.path), base64(bytes))));
}

Markup pictures_of(const PointRecord& point, const std::vector<std::string>& swept,
                   const std::map<int64_t, double>& biases, const ReadFile& read_file) {
  const std::string phrase = settings_phrase(point, swept);
  Markup worst, pictures;
  if (point.worst.x >= 0)
    worst = paragraph(css("small"), prose("Worst pixel: ({}, {}) from the top left, wrong by {}{}.", point.worst.x,
                                          point.worst.y, quantity(point.worst.error, "fraction"),
                                          point.worst.cause.empty() ? "" : ", " + metric_label(point.worst.cause)));
  for (const PictureRecord& record : pictures_for_page(point, biases))
    if (!record.name.starts_with(lights_pictures)) pictures += picture_figure(record, read_file);
  if (pictures.empty()) return "";
  return div(css("pictures"), Attribute("data-point", point.id),
             element("h3", prose("Point {}{}", point.id, phrase.empty() ? "" : ": " + phrase)), "\n", worst,
             div(css("stage"), "\n", pictures)) +
         "\n";
}

// The sections through pixels of a point; page/card.js shows the one of its worst pixel.
Markup sections_of(const PointRecord& point, const std::vector<std::string>& swept, const ReadFile& read_file) {
  Markup figures;
  for (const ImageRecord& image : point.images) {
    const std::optional<glm::ivec2> pixel = section_pixel(image.path);
    if (!pixel) continue;
    std::string bytes;
    try {
      bytes = read_file(image.path);
    } catch (const std::exception& error) {
      figures += paragraph(css("missing"), prose("The section {} is not shown: {}.", image.path, error.what()));
      continue;
    }
    figures +=
        element("figure", Attribute("data-x", pixel->x), Attribute("data-y", pixel->y),
                element("img", Attribute("alt", fmt::format("Section through pixel ({}, {})", pixel->x, pixel->y)),
                        Attribute("src", "data:image/svg+xml;base64," + base64(bytes)))) +
        "\n";
  }
  if (figures.empty()) return "";
  const std::string phrase = settings_phrase(point, swept);
  return element("h3", prose("Point {}{}", point.id, phrase.empty() ? "" : ": " + phrase)) +
         div(css("sections"), Attribute("data-point", point.id), "\n", figures) + "\n";
}

// The metrics that do not have the same value at every point: one with the same value needs no column. Each point is gone
// through once, beside the first one, because both have their metrics in the same order.
std::set<std::string, std::less<>> varying_metrics(const std::vector<PointRecord>& points) {
  const auto same = [](double a, double b) {  // as text
    return (a == b || (std::isnan(a) && std::isnan(b))) && std::signbit(a) == std::signbit(b);
  };
  std::set<std::string, std::less<>> varying;
  const std::map<std::string, double>& first = points.front().metrics;
  for (const PointRecord& point : points) {
    auto a = first.begin(), b = point.metrics.begin();
    while (a != first.end() || b != point.metrics.end()) {
      const int order = a == first.end() ? 1 : b == point.metrics.end() ? -1 : a->first.compare(b->first);
      if (order != 0)
        varying.insert(order < 0 ? (a++)->first : (b++)->first);
      else if (const double one = (a++)->second, other = b->second; !same(one, other))
        varying.insert((b++)->first);
      else
        ++b;
    }
  }
  return varying;
}

Markup term_if_known(const std::string& name, const std::string& value) {
  return value.empty() ? "" : term(name, value);
}

std::string listed(std::initializer_list<std::string> parts) {
  std::string out;
  for (const std::string& part : parts)
    if (!part.empty()) out += (out.empty() ? "" : ", ") + part;
  return out;
}

}  // namespace

Markup picture_figure(const PictureRecord& record, const ReadFile& read_file) {
  return element("figure", Attribute("data-name", record.name), image_of(record, read_file),
                 element("figcaption", bold(record.name), " ", record.caption)) +
         "\n";
}

Markup pictures_section(const ShownPoints& shown, const ReadFile& read_file) {
  const std::map<int64_t, double> biases = recommended_biases(shown);
  Markup sets, legend, sections;
  for (const PointRecord& point : shown.all.points)
    if (!point.pictures.empty()) {
      sets += pictures_of(point, shown.all.info.swept, biases, read_file);
      sections += sections_of(point, shown.all.info.swept, read_file);
    }
  if (sets.empty()) return "";
  for (const CauseColor& color : causes_of(shown.all.points))
    if (color.name != "aliasing" && color.name != "coverage") legend += legend_entry(color.name, color.label);
  for (const CauseColor& color : pixel_state_colors) legend += legend_entry(color.name, color.label);
  const auto key = [](const char* name) { return element("kbd", name); };
  return section(
      "pictures", "Pictures",
      paragraph(css("js-only small"), prose("Flip with {} {} or the number keys.", key("←"), key("→"))) +
          div(css("legend"), "\n", legend) + "\n" + div(css("picture-picker js-only")) + "\n" + sets +
          (sections.empty() ? Markup()
                            : folded("more", false, "Sections through the worst pixels of these points", sections)));
}

namespace {

// What the table of points has columns for.
struct Columns {
  bool parts = false;
  std::map<std::string, std::string> classes;  // of the swept settings
  std::vector<const Metric*> metrics;          // that differ between the points
};

Markup points_head(const Results& results, const Columns& columns) {
  Markup cells = th("Point");
  if (columns.parts) cells += th(css("text"), "Part");
  for (const std::string& name : results.info.swept)
    cells += th(css(columns.classes.at(name)), Attribute("title", name),
                with_small(setting_label(name), swept_unit(name, results)));
  for (const Metric* metric : columns.metrics)
    cells += th(Attribute("title", metric->help), with_small(metric_label(metric->name), head_unit(metric->unit)));
  return cells;
}

Markup points_row(const PointRecord& point, const Results& results, const Columns& columns) {
  Markup cells = row_head(point.id);
  if (columns.parts) cells += td(css("text"), point.part);
  for (const std::string& name : results.info.swept)
    cells += td(css(columns.classes.at(name)), setting_text(setting_of(point, name)));
  for (const Metric* metric : columns.metrics) {
    const auto value = point.metrics.find(std::string(metric->name));
    cells += value == point.metrics.end()
                 ? td("–")
                 : td(css(std::isfinite(value->second) ? "" : "fails"), cell(value->second, metric->unit));
  }
  return tr(Attribute("id", fmt::format("p{}", point.id)), cells);
}

}  // namespace

Markup points_section(const ShownPoints& shown) {
  if (shown.all.points.empty()) return "";
  Columns columns{!shown.all.points.front().part.empty(), text_classes(shown.all), {}};
  const std::vector<Metric> metrics = listed_metrics(shown.all);
  const auto varying = varying_metrics(shown.all.points);
  std::string same;
  for (const Metric& metric : metrics) {
    const std::string name(metric.name);
    if (shown.all.points.size() == 1 || varying.contains(name))
      columns.metrics.push_back(&metric);
    else if (shown.all.points.front().metrics.contains(name))
      same += fmt::format("{}{} {}", same.empty() ? "" : ", ", metric_label(name),
                          quantity(metric_of(shown.all.points.front(), name), metric.unit));
  }
  Markup rows;
  for (const PointRecord& point : shown.results.points) rows += points_row(point, shown.all, columns);
  // With JavaScript, page/points_table.js makes the rows when they are seen. Without, this table has them.
  Markup out =
      shown.note + paragraph(css("js-only small"), prose("Click a head to sort, a row for the point's card.")) +
      div(css("points-place js-only")) + "\n" +
      element("noscript", div(css("scroll tall"), table("numbers", points_head(shown.all, columns), rows))) + "\n" +
      paragraph(css("small"), prose("{} has what the experiment asks for; {} writes every column there.",
                                    code("shown.all.csv"), code("noonmark report FOLDER --all")));
  if (!same.empty()) out += paragraph(css("small"), prose("The same at every point: {}.", same));
  return section("points", shown.note.empty() ? "Every point" : "Points", out);
}

namespace {

Markup metric_terms(const std::vector<Metric>& metrics) {
  Markup list;
  for (const Metric& metric : metrics)
    list += term(with_small(metric_label(metric.name) + " " + code(metric.name), head_unit(metric.unit)),
                 std::string(metric.help) + also_text(metric));
  return list;
}

Markup swept_terms(const Results& results) {
  Markup list;
  for (const std::string& name : results.info.swept)
    for (const Setting& row : settings_table())
      if (row.name == name)
        list +=
            term(with_small(code(name), swept_unit(name, results)), prose("{} Range: {}.", row.help, row.range_text()));
  return list;
}

}  // namespace

namespace {

Markup ladder_in_words(const Results& results) {
  Markup out = paragraph(prose(
      "For every pixel that sees a surface facing the light, a ladder of methods answers the same question: how lit is "
      "the surface? Each rung differs from the one before in one respect. R0: the light with its size. R1: one exact "
      "ray to the light's centre. R2: the filter's taps at their exact places (and, if the technique moves the lookup, "
      "at the moved places). R3: the taps at the centres of their texels. R4: the technique on an exact depth map. R5: "
      "the result of the GPU. Each step is the effect of one cause. Fractions are fractions of the counted receivers, "
      "which face the light and have a truth that is not ambiguous."));
  for (const RungCause* cause : brought_causes(results.points))
    out +=
        paragraph(prose("{}, a picture on top of the ladder, is judged in place of the rung below it. Its step is "
                        "the cause {}.",
                        cause->rung, metric_label(cause->name)));
  return out;
}

Markup frames_in_words() {
  return paragraph(
      prose("Each point is a frame of another renderer. The truth at each of its receivers is one exact shadow ray, or "
            "many for a "
            "light with a size. The classes say where a pixel differs from it, the first that holds: {}, the truth is "
            "between lit and "
            "shadowed; {}, a true shadow edge is near; {}, the truth is lit and the frame is darker; {} and {}, the "
            "truth is dark "
            "and the frame is lighter, with the occluder near or far. Their sizes sum to the error. Fractions are "
            "fractions of the "
            "counted receivers, which have a surface in the scene and in the frame, face the light and have a truth "
            "that is not "
            "ambiguous.",
            bold("penumbra"), bold("edge"), bold("acne"), bold("contact"), bold("leak")));
}

}  // namespace

Markup meaning_section(const Results& results) {
  Markup out = judges_frames(results.points) ? frames_in_words() : ladder_in_words(results);
  std::vector<Metric> metrics = listed_metrics(results);
  std::erase_if(metrics, [](const Metric& metric) { return metric.is(Metric::made); });
  if (!metrics.empty())
    out += folded("glossary", false, prose("Each of the {} metrics in a sentence", metrics.size()),
                  terms("terms", metric_terms(metrics)));
  if (const Markup swept = swept_terms(results); !swept.empty())
    out += folded("glossary", false, "The swept settings", terms("terms", swept));
  return section("meaning", "What the numbers mean", out);
}

namespace {

// How the truth was found: means over the points that have one.
Markup truth_in_words(const Results& results) {
  double cells = 0, rays = 0, scan = 0;
  int points = 0;
  bool all_by_rays = true;
  for (const PointRecord& point : results.points) {
    const auto share = [&](const char* name) {
      const auto found = point.metrics.find(name);
      return found == point.metrics.end() ? 0 : found->second;
    };
    if (!(share("truth_by_cells") + share("truth_by_rays") + share("truth_by_scan") > 0)) continue;
    ++points;
    cells += share("truth_by_cells");
    rays += share("truth_by_rays");
    scan += share("truth_by_scan");
    const auto method = point.settings.find("truth.method");
    all_by_rays &= method != point.settings.end() && method->second == "rays";
  }
  if (points == 0) return {};
  if (all_by_rays)
    return paragraph(css("note"), prose("Embree's rays answered all of the truth ({}).", code("truth.method = rays")));
  // As of a point light, whose cubes have no certified squares and are not scanned.
  if (!(cells + scan > 0)) return paragraph(css("note"), prose("Embree's rays answered all of the truth."));
  const auto share = [&](double sum) { return fmt::format("{:.3g}%", 100 * sum / points); };
  return paragraph(
      css("note"),
      prose(
          "{} of the truth needed no ray: certified squares of the light's plane and the lack of silhouettes answered "
          "{}, scan conversion of the exact map in double answered {}; Embree's rays answered {}. {} asks a ray for "
          "everything and gives the same verdicts.",
          share(cells + scan), share(cells), share(scan), share(rays), code("truth.method = rays")));
}

// What the results were made with and from.
Markup made_terms(const Results& results, bool timed) {
  const RunInfo& info = results.info;
  std::string libraries;
  for (const auto& [name, version] : info.libraries)
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", name, version);
  const std::string triangles = fmt::format("{} triangles", cell(static_cast<double>(info.triangles), "count"));
  Markup list;
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, std::string>>{
           {"Command", info.command},
           {"Experiment", info.experiment},
           {"Noonmark", info.version + (info.commit.empty() ? "" : ", commit " + info.commit)},
           {"Scene", listed({info.scene_name, info.triangles > 0 ? triangles : ""})},
           {"Processor", info.host_cpu},
           {"OpenGL", listed({info.gl_renderer, info.gl_vendor, info.gl_version})},
           {"Times from", timed ? info.gl_timer : "not measured; set times = true in the experiment"},
           {"Embree", listed({info.embree_version, info.embree_isa})},
           {"Libraries", libraries}})
    list += term_if_known(name, value);
  return list;
}

}  // namespace

Markup making_section(const Results& results) {
  const RunInfo& info = results.info;
  const bool timed = std::any_of(results.points.begin(), results.points.end(),
                                 [](const PointRecord& point) { return point.metrics.contains("shadow_ms"); });
  Markup out = terms("made", made_terms(results, timed)) + "\n";
  for (const char* software : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (timed && info.gl_renderer.find(software) != std::string::npos)
      out += paragraph(css("note"), prose("{} renders on the processor: its times are {}. They order settings roughly "
                                          "as a GPU would, but they do not predict a GPU's milliseconds.",
                                          software, bold("software times")));
  out += truth_in_words(results);
  if (std::all_of(results.points.begin(), results.points.end(),
                  [](const PointRecord& p) { return p.pictures.empty(); }))
    out += paragraph(css("note"), prose("No point has pictures. The experiment's key {} says which points do: {} draws "
                                        "those of point 0.",
                                        code("pictures"), code("pictures = \"first\"")));
  // The settings that all points share, for a reader who wants to repeat the experiment.
  Markup fixed;
  if (!results.points.empty())
    for (const auto& [name, value] : results.points.front().settings)
      if (std::find(info.swept.begin(), info.swept.end(), name) == info.swept.end())
        fixed += term_if_known(name, value);
  if (!fixed.empty()) out += folded("more", false, "The settings that were not swept", terms("made", fixed));
  return section("making", "How it was made", out);
}

}  // namespace noonmark::report
