// Text of unknown origin in the formats that are written: one function for each format. For HTML it is report::html
// (compare/report/text.h), for a terminal printable() (scenes/text.h).
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// A cell of CSV that holds text: quoted where RFC 4180 asks for it; a text that a spreadsheet would take for a formula
// (it begins with = + - @, a tab or a line break, and is no number: "-5,4,5" is none) gets an apostrophe before it.
std::string csv_text(std::string_view text);

// A run of Markdown, within a table's cell too: one line, nothing in it is taken for markup.
std::string markdown(std::string_view text);

// Lines that Markdown shows unchanged: an indented block, which no run of backticks in a name can end.
std::string markdown_block(std::string_view lines);

// XML 1.0, for text and attributes alike. What XML cannot hold, and control characters, become U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace noonmark
