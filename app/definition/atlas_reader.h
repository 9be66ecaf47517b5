// Reads the [atlas] section of an experiment file.
#pragma once
#include <toml++/toml.h>

#include <string>

#include "compare/judge/atlas.h"

namespace noonmark {

// Throws Error(usage) with file:line:column for an unknown key, a missing one, a value of the wrong type, or a setting
// or metric that does not exist.
AtlasEntry read_atlas_entry(const toml::table& table, const std::string& path);

}  // namespace noonmark
