// What engines do with the settings of an answer: the lines to type, and whether the bounds hold with them.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "app/advise/recommend.h"
#include "measure/workbench.h"

namespace noonmark {

// Advice for every engine, with what its lines promise under the searched conditions. say: progress, one line. Throws Error.
std::vector<EngineAdvice> measured_engines(Workbench& bench, const Tried& answer, const AdviceRequest& request,
                                           const std::function<void(const std::string&)>& say);

// An engine in which settings must hold.
struct WantedEngine {
  std::string engine;  // EngineAdvice::engine
  // The engine draws frames after the search, and these are judged. So settings stay in the search if Noonmark cannot
  // measure what the engine does with their lines.
  bool is_run = false;
};

// Why these settings are no answer for one of the engines: it has no lines for them, what it does with them breaks a bound under a
// searched condition, or that is not known. If they are one for all: what each does. Throws Error.
Elsewhere in_engines(Workbench& bench, std::span<const WantedEngine> engines, const Tried& tried,
                     const AdviceRequest& request);

// Why no settings like these can be an answer for one of the engines: it lays one map, or not so many, or Noonmark has no
// settings for what it lays. A sentence; empty: there is no such reason. Throws Error.
std::string why_never_in_engines(Workbench& bench, std::span<const WantedEngine> engines, Settings settings);

}  // namespace noonmark
