#include "compare/report/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "compare/report/answer.h"
#include "compare/report/cause_colors.h"
#include "compare/report/data.h"
#include "compare/report/flicker_section.h"
#include "compare/report/live_section.h"
#include "compare/report/page_parts.h"
#include "compare/report/phase_section.h"
#include "compare/report/recommendation_box.h"
#include "compare/report/sections.h"
#include "compare/report/shown.h"
#include "compare/report/speed_section.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

std::string subtitle(const Results& results) {
  const RunInfo& info = results.info;
  std::set<std::string> parts;
  for (const PointRecord& point : results.points)
    if (!point.part.empty()) parts.insert(point.part);
  std::string out;
  if (!parts.empty())
    out = fmt::format("{} part{} · ", parts.size(), parts.size() == 1 ? "" : "s");
  else if (!info.scene_name.empty())
    out = "Scene " + report::html(info.scene_name) + " · ";
  out += fmt::format("{} point{}", results.points.size(), results.points.size() == 1 ? "" : "s");
  std::string swept;
  // Not if there are parts: each part sweeps its own settings.
  for (const std::string& name : parts.empty() ? info.swept : std::vector<std::string>())
    swept += fmt::format("{}{} ({})", swept.empty() ? "" : " × ", report::html(report::setting_label(name)),
                         values_of(results, name).size());
  if (!swept.empty()) out += " · " + swept;
  return out;
}

using report::ShownPoints;
using ReadFile = std::function<std::string(const std::string& path)>;

struct Section {
  const char* id;
  const char* label;  // in the page's head; null: answer_label()
  std::string (*html)(const Results&, const ShownPoints&, const ReadFile&);
  bool compares;  // compares all points with each other, which has no meaning across parts
};
template <std::string (*make)(const Results&)>
std::string plain(const Results& results, const ShownPoints&, const ReadFile&) {
  return make(results);
}
template <std::string (*make)(const Results&, const ShownPoints&)>
std::string by_point(const Results& results, const ShownPoints& shown, const ReadFile&) {
  return make(results, shown);
}
std::string pictures(const Results& results, const ShownPoints& shown, const ReadFile& read_file) {
  return report::pictures_section(results, shown, read_file);
}
// A report without a live picture and without a diagram opens with the strips of its motion, or with the chart of cost
// against error.
bool opens_with_motion(const Results& results) {
  return !report::has_live_picture(results) && !report::has_diagram(results) && report::has_flicker(results);
}
bool opens_with_speed(const Results& results, const ShownPoints& shown) {
  return !report::has_live_picture(results) && !report::has_diagram(results) && !report::has_flicker(results) &&
         report::has_speed_chart(results, shown);
}
std::string motion(const Results& results, const ShownPoints&, const ReadFile&) {
  return report::has_flicker(results) ? report::flicker_section(results, opens_with_motion(results)) : "";
}
std::string speed(const Results& results, const ShownPoints& shown, const ReadFile&) {
  return report::speed_section(results, shown, opens_with_speed(results, shown));
}
constexpr Section all_sections[] = {
    {"phase", "Diagram", by_point<report::phase_section>, false},
    {"answer", nullptr, plain<report::answer_section>, false},
    {"engines", "Engines", plain<report::engines_section>, false},
    {"motion", "Motion", motion, false},
    {"bias", "Bias", by_point<report::bias_section>, true},
    {"sweep", "Sweep", by_point<report::sweep_section>, true},
    {"budget", "Causes", by_point<report::budget_section>, true},
    {"cost", "Speed", speed, false},
    {"pictures", "Pictures", pictures, false},
    {"points", "Points", by_point<report::points_section>, false},
    {"meaning", "Meaning", plain<report::meaning_section>, false},
    {"making", "Making", plain<report::making_section>, false},
};

struct ShownSection {
  std::string id, label, html;
};

// A section without content is left out, in the page's head too.
std::vector<ShownSection> sections_of(const Results& results, const ShownPoints& shown, const ReadFile& read_file) {
  const bool parts = !results.points.empty() && !results.points.front().part.empty();
  std::vector<ShownSection> sections;
  for (const Section& section : all_sections) {
    if (parts && section.compares) continue;
    const std::string label = section.label ? section.label : report::answer_label(results);
    if (std::string html = section.html(results, shown, read_file); !html.empty())
      sections.push_back({section.id, label, std::move(html)});
  }
  return sections;
}

std::string navigation(const std::vector<ShownSection>& sections) {
  std::string links;
  for (const ShownSection& section : sections)
    links += fmt::format("<a href=\"#{}\">{}</a>", section.id, section.label);
  return links;
}

// What the first screen shows: the verdict and the answer. Below them stand the live picture and the phase diagram; a
// report without both has the strips of its motion there, or else the chart of cost against error.
std::string first_screen(const Results& results, const ShownPoints& shown, const ReadFile& read_file) {
  const bool live = report::has_live_picture(results), diagram = report::has_diagram(results);
  std::string figures;
  if (live) figures += "<div id=\"live\">" + report::live_figure(results, shown, read_file) + "</div>\n";
  if (diagram) figures += "<div>" + report::first_diagram() + "</div>\n";
  if (opens_with_speed(results, shown)) figures = "<div>" + report::speed_chart() + "</div>\n";
  if (opens_with_motion(results)) figures = "<div>" + report::flicker_strips(results) + "</div>\n";
  return fmt::format("<div class=\"first-screen\">\n{}<p class=\"said\">{}{}</p>\n<div class=\"{}\">{}</div></div>\n",
                     report::verdict_line(results), report::answer_sentence(results, shown),
                     report::has_flicker(results) ? " " + report::flicker_sentence(results) : "",
                     live && diagram   ? "side-by-side two"
                     : live || diagram ? "side-by-side"
                                       : "alone",
                     figures);
}

}  // namespace

std::string render_report(const Results& results,
                          const std::function<std::string(const std::string& path)>& read_file) {
  const std::string& given = !results.info.title.empty() ? results.info.title : results.info.scene_name;
  const ShownPoints shown = report::shown_points(results);
  const std::string title = report::html(given.empty() ? "Shadow-map errors" : given);
  const std::vector<ShownSection> sections = sections_of(results, shown, read_file);
  std::string body = first_screen(results, shown, read_file);
  for (const ShownSection& section : sections) body += section.html;
  std::vector<CauseColor> causes;
  for (const CauseColor& color : causes_of(results.points)) causes.push_back(color);
  return report::fill_page(
      {.title = title,
       .subtitle = subtitle(results),
       .navigation = navigation(sections),
       .sections = body,
       .data = report::chart_data(results, shown),
       .causes = causes,
       .scripts = {"charts", "keyboard", "chart_bias", "chart_sweep", "speed_marks", "chart_speed", "chart_laws",
                   "chart_phase", "live", "bias_choice", "save", "align", "card", "points_table", "page"},
       .version = results.info.version});
}

}  // namespace noonmark
