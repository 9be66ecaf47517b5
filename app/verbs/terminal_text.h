// Verdicts in colour, where standard output is a terminal that has colours and the user does not refuse them.
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// Standard output is a terminal, TERM is not "dumb", and NO_COLOR is not set or empty (no-color.org).
bool terminal_has_colours();

// The first word of each line that is a verdict, before its colon, in its colour: "held" and "better" green, "broken",
// "refused", "worse" and "missing" red, "warning" and "changed" yellow. Each colour is one of the terminal's own 8, so that
// it is readable on its background.
std::string with_coloured_verdicts(std::string_view text);

}  // namespace noonmark
