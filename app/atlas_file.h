// The [atlas] section of an experiment file: which known failure the experiment is about.
//
//   if (const std::optional<AtlasEntry> entry = load_atlas_entry("experiments/atlas/grazing-sun.toml")) ...
#pragma once
#include <optional>
#include <string>

#include "compare/judge/atlas.h"

namespace noonmark {

// Empty if the file has no such section. Throws Error(usage) as load_experiment() does.
std::optional<AtlasEntry> load_atlas_entry(const std::string& path);

}  // namespace noonmark
