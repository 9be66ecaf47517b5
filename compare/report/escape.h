// Writes text of unknown origin safely, with one function for each format. The one for HTML is
// report::Markup (compare/report/element.h), the one for a terminal is printable() (base/text.h).
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// A cell of CSV that holds text, quoted if RFC 4180 requires it. It is one line: control characters are printable()
// (base/text.h). An apostrophe is added before a text that a spreadsheet would treat as a formula: it begins with
// = + - @ and is not a number ("-5,4,5" is not one).
std::string csv_text(std::string_view text);

// One line of Markdown, also for a table's cell. No part of it is read as markup.
std::string markdown(std::string_view text);

// Lines that Markdown shows unchanged, as an indented block, because backticks in a name cannot end such a block.
std::string markdown_block(std::string_view lines);

// The entity for a character that HTML and XML can read as markup (& < > " '); "" for other characters.
std::string_view markup_entity(std::string_view character);

// XML 1.0, for text and for attributes. Line breaks and tabs become references; other control characters, and characters
// that XML cannot hold, U+FFFD. A name is made printable() first, so that it is one line in a log of the server.
std::string xml_text(std::string_view text);

}  // namespace noonmark
