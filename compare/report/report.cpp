#include "compare/report/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "compare/report/answer.h"
#include "compare/report/blocks.h"
#include "compare/report/cascades_section.h"
#include "compare/report/cause_colors.h"
#include "compare/report/data.h"
#include "compare/report/flicker_section.h"
#include "compare/report/function_figure.h"
#include "compare/report/lights_section.h"
#include "compare/report/live_section.h"
#include "compare/report/lookup_section.h"
#include "compare/report/page_parts.h"
#include "compare/report/part_answers.h"
#include "compare/report/phase_section.h"
#include "compare/report/recommendation_box.h"
#include "compare/report/sections.h"
#include "compare/report/shown.h"
#include "compare/report/speed_section.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::Markup;

std::string subtitle(const Results& results) {
  const RunInfo& info = results.info;
  std::set<std::string> parts;
  for (const PointRecord& point : results.points)
    if (!point.part.empty()) parts.insert(point.part);
  std::string out;
  if (!parts.empty())
    out = fmt::format("{} part{} · ", parts.size(), parts.size() == 1 ? "" : "s");
  else if (!info.scene_name.empty())
    out = (info.scene_name.find(", ") == info.scene_name.npos ? "Scene " : "Scenes ") + info.scene_name + " · ";
  out += fmt::format("{} point{}", results.points.size(), results.points.size() == 1 ? "" : "s");
  std::string swept;
  // Not if there are parts: each part sweeps its own settings.
  for (const std::string& name : parts.empty() ? info.swept : std::vector<std::string>())
    swept += fmt::format("{}{} ({})", swept.empty() ? "" : " × ", report::setting_label(name),
                         values_of(results, name).size());
  if (!swept.empty()) out += " · " + swept;
  return out;
}

using report::ShownPoints;
using ReadFile = std::function<std::string(const std::string& path)>;

struct Section {
  const char* id;
  const char* label;  // in the page's head; null: answer_label()
  Markup (*make)(const Results&, const ShownPoints&, const ReadFile&);
  bool compares;  // compares all points with each other, which has no meaning across parts
  const char* fold =
      nullptr;  // what a click unfolds, behind the first screen and the answers; null: the section is open
};
template <Markup (*make)(const Results&)>
Markup plain(const Results& results, const ShownPoints&, const ReadFile&) {
  return make(results);
}
template <Markup (*make)(const Results&, const ShownPoints&)>
Markup by_point(const Results& results, const ShownPoints& shown, const ReadFile&) {
  return make(results, shown);
}
Markup pictures(const Results& results, const ShownPoints& shown, const ReadFile& read_file) {
  return report::pictures_section(results, shown, read_file);
}
Markup lights(const Results& results, const ShownPoints&, const ReadFile& read_file) {
  return report::lights_section(results, read_file);
}
// A report without a live picture and without a diagram opens with the strips of its motion, or with the chart of cost
// against error.
bool opens_with_motion(const Results& results) {
  return !report::has_live_picture(results) && !report::has_diagram(results) && report::has_flicker(results);
}
// Parts are measured to be compared, so there the chart stands above all, unless laws say what their points show. Otherwise it is
// the first figure only where there is no other.
bool opens_with_speed(const Results& results, const ShownPoints& shown) {
  if (report::has_diagram(results) || report::has_flicker(results) || !report::has_speed_chart(shown)) return false;
  return report::has_parts(results) ? results.laws.empty()
                                    : !report::has_live_picture(results) && !report::has_function_chart(shown);
}
Markup motion(const Results& results, const ShownPoints&, const ReadFile&) {
  return report::has_flicker(results) ? report::flicker_section(results, opens_with_motion(results)) : "";
}
Markup speed(const Results& results, const ShownPoints& shown, const ReadFile&) {
  return report::speed_section(results, shown, opens_with_speed(results, shown));
}
constexpr Section all_sections[] = {
    {"phase", "Diagram", by_point<report::phase_section>, false, "How the diagram was made"},
    {"answer", nullptr, by_point<report::answer_section>, false},
    {"lights", "Lights", lights, false},
    {"cascades", "Cascades", plain<report::cascades_section>, false},
    {"motion", "Motion", motion, false},
    {"bias", "Bias", by_point<report::bias_section>, false, "The usable window of every point"},
    {"reduction", "Reduction", by_point<report::reduction_section>, false},
    {"over", "Other settings", by_point<report::over_section>, false},
    {"places", "Places", by_point<report::places_section>, true},
    {"cost", "Speed", speed, false},
    {"pictures", "Pictures", pictures, false, "Pictures"},
    {"points", "Points", by_point<report::points_section>, false, "Every point in a table"},
    {"meaning", "Meaning", plain<report::meaning_section>, false, "What the numbers mean"},
    {"making", "Making", plain<report::making_section>, false, "How these results were made"},
};

struct ShownSection {
  std::string id, label;
  Markup content;
};

// A section without content is left out, in the page's head too.
std::vector<ShownSection> sections_of(const Results& results, const ShownPoints& shown, const ReadFile& read_file) {
  const bool parts = !results.points.empty() && !results.points.front().part.empty();
  std::vector<ShownSection> sections;
  for (const Section& section : all_sections) {
    if (parts && section.compares) continue;
    const std::string label = section.label ? section.label : report::answer_label(results, shown);
    if (Markup content = section.make(results, shown, read_file); !content.empty())
      sections.push_back(
          {section.id, label, section.fold ? report::folded("fold", false, section.fold, content) : content});
  }
  return sections;
}

// What the first screen shows: the verdict and the answer, then the error as a function of what was swept, then the live picture
// and the phase diagram. A report of parts may begin with the chart of cost against error, one without a live picture and a diagram
// with the strips of its motion.
Markup first_screen(const Results& results, const ShownPoints& shown, const ReadFile& read_file) {
  using namespace report;
  const bool live = has_live_picture(results), diagram = has_diagram(results);
  const auto figure = [](const Markup& content) { return div(content) + "\n"; };
  Markup figures, answer = answer_sentence(results, shown);
  if (live) figures += div(Attribute("id", "live"), live_figure(results, shown, read_file)) + "\n";
  if (diagram) figures += figure(first_diagram());
  Markup leading;
  if (opens_with_speed(results, shown)) leading = figure(speed_chart());
  if (opens_with_motion(results)) leading = figure(flicker_strips(results));
  if (const Markup of_lights = lights_sentence(results); !of_lights.empty()) answer += " " + of_lights;
  if (has_flicker(results)) answer += " " + flicker_sentence(results);
  const char* const beside = live && diagram ? "side-by-side two" : live || diagram ? "side-by-side" : "alone";
  return div(css("first-screen"), "\n", verdict_line(results), paragraph(css("said"), answer), leading,
             function_chart(shown), div(css(beside), figures)) +
         "\n";
}

}  // namespace

std::string render_report(const Results& results,
                          const std::function<std::string(const std::string& path)>& read_file) {
  const std::string& given = !results.info.title.empty() ? results.info.title : results.info.scene_name;
  const ShownPoints shown = report::shown_points(results);
  const std::vector<ShownSection> sections = sections_of(results, shown, read_file);
  Markup body = first_screen(results, shown, read_file), links;
  for (const ShownSection& section : sections) {
    body += section.content;
    links += report::section_link(section.id, section.label);
  }
  std::vector<CauseColor> causes;
  for (const CauseColor& color : causes_of(results.points)) causes.push_back(color);
  return report::fill_page(
      {.title = given.empty() ? "Shadow-map errors" : given,
       .subtitle = subtitle(results),
       .navigation = links,
       .sections = body,
       .data = report::chart_data(results, shown),
       .causes = causes,
       .scripts = {"charts", "keyboard", "function", "chart_lookup", "speed_marks", "chart_speed", "chart_laws",
                   "chart_phase", "live", "bias_choice", "save", "align", "card", "points_table", "page"},
       .version = results.info.version});
}

}  // namespace noonmark
