// What standard output shows if it is a terminal: verdicts in colour, where it has colours and the user does not refuse them; its width.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace noonmark {

// Standard output is a terminal, TERM is not "dumb", and NO_COLOR is not set or empty (no-color.org).
bool terminal_has_colours();

// How many characters a line has; empty if it is no terminal, does not say it, or has fewer than 60.
std::optional<size_t> terminal_columns();

// The first word of each line that is a verdict, before its colon, in its colour: "held" and "better" green, "broken",
// "refused", "worse" and "missing" red, "warning" and "changed" yellow. Each colour is one of the terminal's own 8, so that
// it is readable on its background.
std::string with_coloured_verdicts(std::string_view text);

}  // namespace noonmark
