#include "compare/report/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <type_traits>

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
  Markup (*make)(const ShownPoints&, const ReadFile&);
  bool compares;  // compares all points with each other, which has no meaning across parts
  const char* fold =
      nullptr;  // what a click unfolds, behind the first screen and the answers; null: the section is open
};
// A section is made of what it asks for.
template <auto section>
Markup made(const ShownPoints& shown, const ReadFile& read_file) {
  if constexpr (std::is_invocable_v<decltype(section), const ShownPoints&, const ReadFile&>)
    return section(shown, read_file);
  else if constexpr (std::is_invocable_v<decltype(section), const ShownPoints&>)
    return section(shown);
  else if constexpr (std::is_invocable_v<decltype(section), const Results&, const ReadFile&>)
    return section(shown.all, read_file);
  else
    return section(shown.all);
}
// A report without a live picture and without a diagram opens with the strips of its motion, or with the chart of cost
// against error.
bool opens_with_motion(const Results& results) {
  return !report::has_live_picture(results) && !report::has_diagram(results) && report::has_flicker(results);
}
// Parts are measured to be compared, so there the chart stands above all, unless laws say what their points show. Otherwise it is
// the first figure only where there is no other.
bool opens_with_speed(const ShownPoints& shown) {
  if (report::has_diagram(shown.all) || report::has_flicker(shown.all) || !report::has_speed_chart(shown)) return false;
  return report::has_parts(shown.all) ? !shown.headline
                                      : !report::has_live_picture(shown.all) && !report::has_function_chart(shown);
}
Markup motion(const Results& results) {
  return report::has_flicker(results) ? report::flicker_section(results, opens_with_motion(results)) : "";
}
Markup speed(const ShownPoints& shown) { return report::speed_section(shown, opens_with_speed(shown)); }
constexpr Section all_sections[] = {
    {"phase", "Diagram", made<report::phase_section>, false, "How the diagram was made"},
    {"answer", nullptr, made<report::answer_section>, false},
    {"lights", "Lights", made<report::lights_section>, false},
    {"cascades", "Cascades", made<report::cascades_section>, false},
    {"motion", "Motion", made<motion>, false},
    {"bias", "Bias", made<report::bias_section>, false, "The usable window of every point"},
    {"reduction", "Reduction", made<report::reduction_section>, false},
    {"over", "Other settings", made<report::over_section>, false},
    {"places", "Places", made<report::places_section>, true},
    {"cost", "Speed", made<speed>, false},
    {"pictures", "Pictures", made<report::pictures_section>, false, "Pictures"},
    {"points", "Points", made<report::points_section>, false, "Every point in a table"},
    {"meaning", "Meaning", made<report::meaning_section>, false, "What the numbers mean"},
    {"making", "Making", made<report::making_section>, false, "How these results were made"},
};

struct ShownSection {
  std::string id, label;
  Markup content;
};

// A section without content is left out, in the page's head too.
std::vector<ShownSection> sections_of(const ShownPoints& shown, const ReadFile& read_file) {
  const bool parts = !shown.all.points.empty() && !shown.all.points.front().part.empty();
  std::vector<ShownSection> sections;
  for (const Section& section : all_sections) {
    if (parts && section.compares) continue;
    const std::string label = section.label ? section.label : report::answer_label(shown);
    if (Markup content = section.make(shown, read_file); !content.empty())
      sections.push_back(
          {section.id, label, section.fold ? report::folded("fold", false, section.fold, content) : content});
  }
  return sections;
}

// What the first screen shows: the verdict and the answer, then the error as a function of what was swept, then the live picture
// and the phase diagram. A report of parts may begin with the chart of cost against error, one without a live picture and a diagram
// with the strips of its motion.
Markup first_screen(const ShownPoints& shown, const ReadFile& read_file) {
  using namespace report;
  const bool live = has_live_picture(shown.all), diagram = has_diagram(shown.all);
  const auto figure = [](const Markup& content) { return div(content) + "\n"; };
  Markup figures, answer = answer_sentence(shown);
  if (live) figures += div(Attribute("id", "live"), live_figure(shown, read_file)) + "\n";
  if (diagram) figures += figure(first_diagram());
  Markup leading;
  if (opens_with_speed(shown)) leading = figure(speed_chart());
  if (opens_with_motion(shown.all)) leading = figure(flicker_strips(shown.all));
  if (const Markup of_lights = lights_sentence(shown.all); !of_lights.empty()) answer += " " + of_lights;
  if (has_flicker(shown.all)) answer += " " + flicker_sentence(shown.all);
  const char* const beside = live && diagram ? "side-by-side two" : live || diagram ? "side-by-side" : "alone";
  return div(css("first-screen"), "\n", verdict_line(shown), answer.empty() ? Markup() : paragraph(css("said"), answer),
             leading, function_chart(shown), div(css(beside), figures)) +
         "\n";
}

}  // namespace

std::string render_report(const Results& results,
                          const std::function<std::string(const std::string& path)>& read_file) {
  const std::string& given = !results.info.title.empty() ? results.info.title : results.info.scene_name;
  const ShownPoints shown = report::shown_points(results);
  const std::vector<ShownSection> sections = sections_of(shown, read_file);
  Markup body = first_screen(shown, read_file), links;
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
       .data = report::chart_data(shown),
       .causes = causes,
       .scripts = {"charts", "keyboard", "function", "chart_lookup", "speed_marks", "chart_speed", "chart_laws",
                   "chart_phase", "live", "bias_choice", "save", "align", "card", "points_table", "page"},
       .version = results.info.version});
}

}  // namespace noonmark
