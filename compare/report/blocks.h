// What the sections of a page are made of: a section, a table, a list of terms, what is folded, a legend.
//
//   section("speed", "Speed", div(css("scroll"), table("numbers", heads({"Choice", "Cost"}), rows)));
#pragma once
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "compare/report/element.h"

namespace noonmark::report {

Markup section(std::string_view id, const Markup& title, const Markup& content);

// head: cells; rows: tr().
Markup table(std::string_view classes, const Markup& head, const Markup& rows);
Markup heads(std::initializer_list<Markup> names);
// "extent" and, in small letters, "m": its unit, or another short addition. Only the text if that is empty.
Markup with_small(const Markup& text, std::string_view addition);

// Shown with a click on its summary; open: from the start.
Markup folded(std::string_view classes, bool open, const Markup& summary, const Markup& content);

// list: term().
Markup terms(std::string_view classes, const Markup& list);
Markup term(const Markup& name, const Markup& meaning, std::string_view classes = "");

// One colour of a legend. cause: its metric, "acne"; label: text.
Markup legend_entry(std::string_view cause, std::string_view label);
// A square in the cause's colour.
Markup swatch(std::string_view cause);

// A link to a section, and one to the card of a point.
Markup section_link(std::string_view id, const Markup& label);
Markup point_link(int64_t id, const Markup& content);

}  // namespace noonmark::report
