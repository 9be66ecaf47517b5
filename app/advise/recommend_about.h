// What an answer is about: what the search took from the user and what it assumed. An answer for the same model differs only if one of
// these differs.
//
//   request.about = about_text(experiment, request.conditions, bench.scene(request.conditions[0].scene));
//   for (const std::string& line : request.about) print(line);   // before the answer
#pragma once
#include <span>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "scenes/scene.h"

namespace noonmark {

// Sentences, one in each element: that the model has no ground (then what to do), the light and where it is from, the floor of
// scene.floor. conditions: at least one. scene: of the first. Throws Error.
std::vector<std::string> about_text(const Experiment& experiment, std::span<const Settings> conditions,
                                    const Scene& scene);

}  // namespace noonmark
