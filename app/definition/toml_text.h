// Text of a TOML file: what is written, and a guard before toml++ 3.3 of what is read. Where white space may stand, toml++ tests every character beyond ASCII for being white
// space, and for most of them that test is undefined behaviour (for é and あ too; the well-known case is U+FCBF).
#pragma once
#include <string>
#include <string_view>

#include "technique/settings.h"

namespace noonmark {

// Throws Error(usage) with path:line:column at the first character beyond ASCII outside of strings and comments, where
// TOML has no such characters. Also throws for one in a """string""" after a backslash that ends a line, where TOML
// allows it. All other mistakes in the text are left to toml++.
void check_toml_text(std::string_view text, const std::string& path);

// A basic string, with its quotes. Throws Error(usage) for text that is not UTF-8, which TOML cannot hold: the path of a
// model can be such text.
std::string toml_string(const std::string& text);

// The value of a setting, from its canonical text.
std::string toml_value(const Setting& row, const std::string& text);

}  // namespace noonmark
