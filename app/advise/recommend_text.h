// The recommendation for its readers: as sentences, as an experiment file, and as JSON.
#pragma once
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "app/advise/recommend.h"

namespace noonmark {

// Sentences, one in each element.
std::vector<std::string> advice_text(const Advice& advice);

// An experiment that `noonmark check` passes: the settings of one of the answers, the conditions, the placements and the bounds.
// folder: where the file will stand; the path of a scene's file is relative to it.
std::string advice_experiment(const Answer& answer, const Advice& advice, const std::string& folder);

// What to type into one engine, and as a comment what error it gives, or why there is nothing to type.
std::vector<std::string> engine_lines(const EngineAdvice& engine);

// What to type into other engines, and what each cannot express. There must be an answer.
std::string advice_engines(const std::vector<EngineAdvice>& engines);

// Everything that was found, one object. engines: empty without an answer.
std::string advice_json(const Advice& advice, const std::vector<EngineAdvice>& engines);

}  // namespace noonmark
