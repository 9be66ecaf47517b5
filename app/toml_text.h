// A guard before toml++ 3.3: where white space may stand, it asks of every character beyond ASCII whether it is one,
// and for most of them that question is undefined behaviour (é and あ among them; the well-known one is U+FCBF).
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// Throws Error(usage) with path:line:column at the first character beyond ASCII that stands outside of strings and
// comments, where TOML has none; or in a """string""" behind a backslash or a line that one ended, where TOML allows
// it. Whatever else is wrong with the text is left to toml++.
void check_toml_text(std::string_view text, const std::string& path);

}  // namespace noonmark
