// Writes values of an experiment file.
#pragma once
#include <string>

#include "technique/settings.h"

namespace noonmark {

// A basic string, with its quotes. Throws Error(usage) for text that is not UTF-8, which TOML cannot hold: the path of a
// model can be such text.
std::string toml_string(const std::string& text);

// The value of a setting, from its canonical text.
std::string toml_value(const Setting& row, const std::string& text);

}  // namespace noonmark
