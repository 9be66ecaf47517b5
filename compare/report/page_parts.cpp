#include "compare/report/page_parts.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>

#include "compare/report/deflate.h"
#include "compare/report/text.h"
#include "report_files.h"

namespace noonmark::report {
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

std::string colour_rules(const std::vector<CauseColor>& causes) {
  std::string variables, classes;
  const auto add = [&](const CauseColor& color) {
    variables += fmt::format("--c-{}:#{:02x}{:02x}{:02x};", color.name, color.r, color.g, color.b);
    classes += fmt::format(".c-{0}{{background:var(--c-{0})}}\n", color.name);
  };
  for (const CauseColor& color : causes) add(color);
  for (const CauseColor& color : pixel_state_colors) add(color);
  return ":root{" + variables + "}\n" + classes;
}

// A data block of at most this many bytes is written as JSON, which the page's scripts read at once. A larger one is
// packed: the 5.3 MB of JSON in the report of experiments/laws.toml become 0.5 MB.
constexpr size_t largest_plain_block = 1 << 20;

// The HTML element that holds the data of the charts. report/page/data.js reads it.
std::string data_block(const nlohmann::json& data) {
  const std::string text = script_json(data);
  if (text.size() <= largest_plain_block)
    return "<script type=\"application/json\" id=\"noonmark-data\">" + text + "</script>";
  return "<script type=\"text/plain\" id=\"noonmark-data\" data-packed=\"deflate base64\">" + base64(deflated(text)) +
         "</script>";
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

}  // namespace

std::string fill_page(const PageParts& parts) {
  return fill(file("report/page/page.html"), [&](std::string_view name) -> std::string {
    if (name == "title") return parts.title;
    if (name == "subtitle") return parts.subtitle;
    if (name == "style") return colour_rules(parts.causes) + std::string(file("report/page/style.css"));
    if (name == "nav") return parts.navigation;
    if (name == "sections") return parts.sections;
    if (name == "data") return data_block(parts.data);
    if (name == "vega") return vega_script();
    if (name == "start") return std::string(file("report/page/data.js"));
    if (name == "script") {
      std::string script;
      for (const std::string& part : parts.scripts) script += file(fmt::format("report/page/{}.js", part));
      return script;
    }
    if (name == "version") return html(parts.version);
    throw std::logic_error("the report's template asks for " + std::string(name));
  });
}

std::string plain_page(const std::string& title, const std::string& body, const std::string& version,
                       Pictures pictures) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
      "http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; img-src {4}; style-src 'unsafe-inline'\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{0} · Noonmark</title>\n<style>\n{1}</style>\n</head>\n<body>\n"
      "<header><h1>{0}</h1></header>\n<main>\n{2}</main>\n<footer><p>Made by Noonmark {3}.</p></footer>\n</body>\n"
      "</html>\n",
      html(title), file("report/page/style.css"), body, html(version),
      pictures == Pictures::inside ? "data:" : "'self' file: data:");
}

}  // namespace noonmark::report
