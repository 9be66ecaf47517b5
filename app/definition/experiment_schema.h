// The JSON schema (draft 7) of the experiment file, for editors: they complete keys and settings, show their help and mark
// mistakes. TOML has the same data model; `#:schema FILE` in the first line names it (Taplo, Even Better TOML).
//
//   fmt::print("{}", experiment_schema());
#pragma once
#include <string>

namespace noonmark {

// Made from the rows of the settings (technique/settings.h), of the keys (app/definition/experiment_keys.h) and of the metrics. What a
// schema cannot say is left to the reader: settings that conflict, that are both fixed and swept, formulas, ranges that
// give no integers.
std::string experiment_schema();

}  // namespace noonmark
