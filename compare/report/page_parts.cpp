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

std::string vega_script() {
  std::string out(page_file("report/page/vega.js"));
  for (const char* module : vega_modules) {
    std::string_view text = page_file(fmt::format("{}.min.js", module));
    // Without this, the map's address would make developer tools request it.
    if (const size_t map = text.rfind("//# sourceMappingURL="); map != std::string_view::npos)
      text = text.substr(0, map);
    out += fmt::format("noonmarkVega.define(\"{}\",function(exports,module,require){{{}\n}});\n", module, text);
  }
  return out;
}

// A data block of at most this many bytes is written as JSON, which the page's scripts read at once. A larger one is
// packed, to about a fifth.
constexpr size_t largest_plain_block = 1 << 18;

Markup json_block(std::string_view id, const std::string& safe_json) {
  return element("script", Attribute("type", "application/json"), Attribute("id", id), Markup::unescaped(safe_json));
}

// report/page/data.js unpacks it.
Markup packed_block(std::string_view id, const std::string& text) {
  return element("script", Attribute("type", "text/plain"), Attribute("id", id),
                 Attribute("data-packed", "deflate base64"), base64(deflated(text)));
}

// The element that holds the data of the charts. report/page/data.js reads it.
Markup chart_block(const nlohmann::json& data) {
  const std::string text = script_json(data);
  return text.size() <= largest_plain_block ? json_block("noonmark-data", text) : packed_block("noonmark-data", text);
}

std::logic_error unknown(std::string_view name) {
  return std::logic_error("a page's template asks for " + std::string(name));
}

}  // namespace

std::string_view page_file(const std::string& name) {
  const std::string_view text = report_files::embedded(name);
  if (text.empty()) throw std::logic_error("the report's file " + name + " is not in the program");
  return text;
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

std::string fill_template(std::string_view page, const std::function<std::string(std::string_view)>& text_of) {
  std::string out;
  while (true) {
    const size_t open = page.find("{{");
    out += page.substr(0, open);
    if (open == std::string_view::npos) return out;
    const size_t close = page.find("}}", open);
    if (close == std::string_view::npos) throw std::logic_error("a page's template has an open {{");
    out += text_of(page.substr(open + 2, close - open - 2));
    page.remove_prefix(close + 2);
  }
}

std::string page_head(const PageHead& head) {
  return fill_template(page_file("report/page/head.html"), [&](std::string_view name) -> std::string {
    if (name == "title") return head.title.html();
    if (name == "subtitle") return head.subtitle.html().empty() ? "" : paragraph(css("subtitle"), head.subtitle).html();
    if (name == "brand") return Markup(head.brand).html();
    if (name == "style") return head.style;
    if (name == "version") return Markup(head.version).html();
    if (name == "pictures") return head.pictures;
    if (name == "scripts") return head.scripts ? "; script-src 'unsafe-inline'" : "";
    throw unknown(name);
  });
}

std::string fill_page(const PageParts& parts) {
  return fill_template(page_file("report/page/page.html"), [&](std::string_view name) -> std::string {
    if (name == "head")
      return page_head({.title = parts.title,
                        .subtitle = parts.subtitle,
                        .style = colour_rules(parts.causes) + std::string(page_file("report/page/style.css")),
                        .version = parts.version});
    if (name == "nav") return parts.navigation.html();
    if (name == "sections") return parts.sections.html();
    if (name == "data") return chart_block(parts.data).html();
    if (name == "code") {
      std::string code = vega_script() + "function noonmarkRun(noonmarkData) {\n";
      for (const std::string& part : parts.scripts) code += page_file(fmt::format("report/page/{}.js", part));
      return packed_block("noonmark-code", code + "}\n").html();
    }
    if (name == "start") return std::string(page_file("report/page/data.js"));
    if (name == "version") return Markup(parts.version).html();
    throw unknown(name);
  });
}

std::string plain_page(const PlainPageParts& parts) {
  return fill_template(page_file("report/page/plain.html"), [&](std::string_view name) -> std::string {
    if (name == "head") {
      std::string style(page_file("report/page/style.css"));
      if (!parts.style.empty()) style += page_file(fmt::format("report/page/{}.css", parts.style));
      return page_head({.title = parts.title, .style = std::move(style), .version = parts.version, .scripts = false});
    }
    if (name == "body") return parts.body.html();
    if (name == "version") return Markup(parts.version).html();
    throw unknown(name);
  });
}

Markup data_block(std::string_view id, const nlohmann::json& data) { return json_block(id, script_json(data)); }

}  // namespace noonmark::report
