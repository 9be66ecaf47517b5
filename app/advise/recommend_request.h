// What a search is asked for: an experiment and the wishes of a user become a request. What the search took from the user and what it
// assumed stands in the request as sentences: an answer for the same model differs only if one of these differs.
//
//   const AdviceRequest request = request_of(experiment, {.views = 1}, bench, [](const std::string& step) { print(step); });
//   for (const std::string& line : request.about) print(line);   // before the answer
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/recommend.h"
#include "app/definition/experiment.h"
#include "measure/workbench.h"
#include "scenes/scene.h"

namespace noonmark {

struct AdviceWishes {
  std::optional<double> acne, peter_panning;  // bounds; empty: the experiment's
  std::optional<double> error, budget;        // AdviceRequest
  std::optional<double> edges, patch;         // bounds for the eye
  std::optional<AnswerKind> answer;           // empty: best with a budget, otherwise least
  int views = 5;                              // of a scene; 1: its own only
  std::vector<std::string> lookups;           // searched_lookups() to try; empty: those that compare
  bool cascades = false;                      // also tries cascade_counts
  std::vector<std::string> engines;           // EngineAdvice::engine that must be able to lay the cascades
};

// The conditions, the settings to try, and the bounds. The experiment has no parts. Throws Error.
AdviceRequest request_of(const Experiment& experiment, const AdviceWishes& wishes, Workbench& bench,
                         const std::function<void(const std::string&)>& say);

// AdviceRequest::about: that the model has no ground (then what to do), the light and where it is from, the floor of
// scene.floor. conditions: at least one. scene: of the first. Throws Error.
std::vector<std::string> about_text(const Experiment& experiment, std::span<const Settings> conditions,
                                    const Scene& scene);

}  // namespace noonmark
