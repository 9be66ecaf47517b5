// `noonmark recommend --texels`: a budget of texels for the lights of a frame (app/advise/texel_budget.h).
#pragma once
#include <cstdint>
#include <string>

#include "app/verbs/experiment_arguments.h"

namespace noonmark {

// whole: with the lights of one frame as its parts, or without parts: then all lights of its scene. Writes texels.toml and
// texels.json into `out` and prints the answer. Returns the exit code. Throws Error.
int recommend_texels(Experiment whole, int64_t texels, const ExperimentArguments& arguments, const std::string& out);

}  // namespace noonmark
