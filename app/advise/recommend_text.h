// The recommendation for its readers: as sentences, as an experiment file, and as JSON.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "app/advise/recommend.h"

namespace noonmark {

// The answer as sentences, one in each element: what to set, the answers as a table, what must be known before it is used, and what it is
// for (AdviceRequest::about); or that nothing holds.
std::vector<std::string> answer_text(const Advice& advice);

// What was measured and why it is the answer, for readers who ask; empty without an answer.
std::vector<std::string> reasons_text(const Advice& advice);

// What became of each lookup that was asked for, a sentence for each under a heading; empty if one was.
std::vector<std::string> lookups_text(const Advice& advice);

// Why what is cheaper or simpler than the answer is none; empty without an answer. Sentences as above, for readers who ask.
std::vector<std::string> rejected_text(const Advice& advice);

// An experiment that `noonmark check` passes: the settings of one of the answers, the conditions, the placements and the bounds.
// folder: where the file will stand; the path of a scene's file is relative to it.
std::string advice_experiment(const Answer& answer, const Advice& advice, const std::string& folder);

// The settings that are not the same in all of these conditions.
std::vector<const Setting*> differing_settings(std::span<const Settings> conditions);

// What to type into one engine, and as a comment what error it gives, or why there is nothing to type. If the lines break a bound, the
// first comment says so.
std::vector<std::string> engine_lines(const EngineAdvice& engine);

// What to type into other engines, and what each cannot express. There must be an answer.
std::string advice_engines(const std::vector<EngineAdvice>& engines);

// Everything that was found, one object. engines: empty without an answer.
std::string advice_json(const Advice& advice, const std::vector<EngineAdvice>& engines);

// What an answer is for: the absolute path of the scene's file, or the name of the built-in scene; and the same of a text of
// advice_json(), empty if it does not say it.
std::string subject_of(const Settings& settings);
std::string subject_in(const std::string& advice);

}  // namespace noonmark
