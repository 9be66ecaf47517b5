#include "compare/report/report.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "compare/report/answer.h"
#include "compare/report/cause_colors.h"
#include "compare/report/data.h"
#include "compare/report/sections.h"
#include "compare/report/shown.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"
#include "report_files.h"

namespace noonmark {
namespace {

// Vega (Debian: libjs-vega; BSD-3-Clause) is the one well-maintained charting library that Debian packages in separate
// parts, so that the page carries only the parts in use. Its expressions run without eval, so the page may forbid eval.
// Debian ships it as CommonJS modules; page/vega.js links them in any order.
constexpr std::array vega_modules{
    "vega-util",      "vega-time",       "vega-format",          "vega-loader",     "vega-dataflow",
    "vega-canvas",    "vega-scale",      "vega-scenegraph",      "vega-statistics", "vega-expression",
    "vega-selection", "vega-functions",  "vega-event-selector",  "vega-parser",     "vega-runtime",
    "vega-view",      "vega-transforms", "vega-view-transforms", "vega-encode",     "vega-interpreter"};

std::string_view file(const std::string& name) {
  const std::string_view text = report_files::embedded(name);
  if (text.empty()) throw std::logic_error("the report's file " + name + " is not in the program");
  return text;
}

std::string vega_script() {
  std::string out(file("report/page/vega.js"));
  for (const char* module : vega_modules) {
    std::string_view text = file(fmt::format("{}.min.js", module));
    // Without this, the map's address would make developer tools request it.
    if (const size_t map = text.rfind("//# sourceMappingURL="); map != std::string_view::npos)
      text = text.substr(0, map);
    out += fmt::format("noonmarkVega.define(\"{}\",function(exports,module,require){{{}\n}});\n", module, text);
  }
  return out;
}

std::string colour_rules(const Results& results) {
  std::string variables, classes;
  const auto add = [&](const CauseColor& color) {
    variables += fmt::format("--c-{}:#{:02x}{:02x}{:02x};", color.name, color.r, color.g, color.b);
    classes += fmt::format(".c-{0}{{background:var(--c-{0})}}\n", color.name);
  };
  for (const CauseColor& color : causes_of(results.points)) add(color);
  for (const CauseColor& color : pixel_state_colors) add(color);
  return ":root{" + variables + "}\n" + classes;
}

// Replaces each {{name}} of the template once. Inserted text is not searched again.
template <class Lookup>
std::string fill(std::string_view page, Lookup&& lookup) {
  std::string out;
  while (true) {
    const size_t open = page.find("{{");
    out += page.substr(0, open);
    if (open == std::string_view::npos) return out;
    const size_t close = page.find("}}", open);
    if (close == std::string_view::npos) throw std::logic_error("the report's template has an open {{");
    out += lookup(page.substr(open + 2, close - open - 2));
    page.remove_prefix(close + 2);
  }
}

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
  if (!info.started.empty()) out += " · " + report::html(info.started);
  return out;
}

using report::ShownPoints;
using ReadFile = std::function<std::string(const std::string& path)>;

struct Section {
  const char* id;
  const char* label;  // in the page's head
  std::string (*html)(const Results&, const ShownPoints&, const ReadFile&);
  bool compares;  // compares points with each other, which has no meaning across parts
};
template <std::string (*make)(const Results&)>
std::string plain(const Results& results, const ShownPoints&, const ReadFile&) {
  return make(results);
}
template <std::string (*make)(const Results&, const ShownPoints&)>
std::string by_point(const Results& results, const ShownPoints& shown, const ReadFile&) {
  return make(results, shown);
}
std::string pictures(const Results& results, const ShownPoints&, const ReadFile& read_file) {
  return report::pictures_section(results, read_file);
}
constexpr Section all_sections[] = {
    {"answer", "Answer", plain<report::answer_section>, false},
    {"bias", "Bias", by_point<report::bias_section>, true},
    {"sweep", "Resolution", by_point<report::sweep_section>, true},
    {"budget", "Causes", by_point<report::budget_section>, true},
    {"cost", "Speed", by_point<report::cost_section>, true},
    {"pictures", "Pictures", pictures, false},
    {"points", "Points", by_point<report::points_section>, false},
    {"meaning", "Meaning", plain<report::meaning_section>, false},
    {"making", "Making", plain<report::making_section>, false},
};

std::vector<Section> sections_of(const Results& results) {
  const bool parts = !results.points.empty() && !results.points.front().part.empty();
  std::vector<Section> sections;
  for (const Section& section : all_sections)
    if (!parts || !section.compares) sections.push_back(section);
  return sections;
}

std::string navigation(const Results& results) {
  std::string links;
  for (const Section& section : sections_of(results))
    links += fmt::format("<a href=\"#{}\">{}</a>", section.id, section.label);
  return links;
}

}  // namespace

std::string render_report(const Results& results,
                          const std::function<std::string(const std::string& path)>& read_file) {
  const std::string& given = !results.info.title.empty() ? results.info.title : results.info.scene_name;
  const ShownPoints shown = report::shown_points(results);
  const std::string title = report::html(given.empty() ? "Shadow-map errors" : given);
  return fill(file("report/page/page.html"), [&](std::string_view name) -> std::string {
    if (name == "title") return title;
    if (name == "subtitle") return subtitle(results);
    if (name == "style") return colour_rules(results) + std::string(file("report/page/style.css"));
    if (name == "nav") return navigation(results);
    if (name == "sections") {
      std::string sections;
      for (const Section& section : sections_of(results)) sections += section.html(results, shown, read_file);
      return sections;
    }
    if (name == "data") return report::script_json(report::chart_data(results, shown));
    if (name == "vega") return vega_script();
    if (name == "script") {
      std::string script;
      for (const char* part : {"charts", "chart_bias", "chart_sweep", "chart_laws", "page"})
        script += file(fmt::format("report/page/{}.js", part));
      return script;
    }
    if (name == "version") return report::html(results.info.version);
    throw std::logic_error("the report's template asks for " + std::string(name));
  });
}

}  // namespace noonmark
