#include "compare/report/blocks.h"

#include <string>

namespace noonmark::report {

Markup section(std::string_view id, const Markup& title, const Markup& content) {
  return element("section", Attribute("id", id), element("h2", title), "\n", content) + "\n";
}

Markup table(std::string_view classes, const Markup& head, const Markup& rows) {
  return element("table", css(classes), element("thead", element("tr", head)), element("tbody", "\n", rows));
}

Markup heads(std::initializer_list<Markup> names) {
  Markup cells;
  for (const Markup& name : names) cells += th(name);
  return cells;
}

Markup with_small(const Markup& text, std::string_view addition) {
  return addition.empty() ? text : text + " " + small(addition);
}

Markup folded(std::string_view classes, bool open, const Markup& summary, const Markup& content) {
  return element("details", css(classes), Attribute("open", open), element("summary", summary), "\n", content) + "\n";
}

Markup terms(std::string_view classes, const Markup& list) { return element("dl", css(classes), "\n", list); }

Markup term(const Markup& name, const Markup& meaning, std::string_view classes) {
  return div(css(classes), element("dt", name), element("dd", meaning)) + "\n";
}

Markup legend_entry(std::string_view cause, std::string_view label) { return span(swatch(cause), label) + "\n"; }

Markup swatch(std::string_view cause) { return element("i", css(fmt::format("sw c-{}", cause))); }

Markup section_link(std::string_view id, const Markup& label) {
  return element("a", Attribute("href", fmt::format("#{}", id)), label);
}

Markup point_link(int64_t id, const Markup& content) {
  return element("a", Attribute("href", fmt::format("#p{}", id)), content);
}

}  // namespace noonmark::report
