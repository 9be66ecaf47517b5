// Measures the error that an engine will have with the lines that are printed for it. EngineAdvice::emulated are settings of
// Noonmark with the same effect as these lines in the engine, and they are measured as any settings are.
//
//   const EnginePromise recommended = measure_promises(bench, advised, under_conditions(answer, request), "error", say);
//   print(promise_text(advised[0], recommended));   // "error 0.31% with these lines (recommended: 0.29%)"
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "compare/ladder/bias_curves.h"
#include "measure/workbench.h"

namespace noonmark {

// The largest over the conditions and their placements. conditions: at least one, with the placements and the size of the
// picture to measure with. accuracy: a metric. Throws Error.
EnginePromise measured_promise(Workbench& bench, std::span<const Settings> conditions, const std::string& accuracy);

// What is measured of an engine that is emulated: its settings under each condition. Its map of more than 2048 texels is measured as it
// lies, at one placement, and one of more than 4096 under the first condition alone.
std::vector<Settings> under_engine(const EngineAdvice& advice, std::span<const Settings> conditions);

// Sets the promise of each piece of advice that has settings, each different technique measured once, and returns that of the
// conditions themselves: of the recommended technique. Settings that cannot be measured (a map that does not fit into memory)
// get the reason in why_not_emulated instead. say: progress, one line.
EnginePromise measure_promises(Workbench& bench, std::vector<EngineAdvice>& engines,
                               std::span<const Settings> conditions, const std::string& accuracy,
                               const std::function<void(const std::string&)>& say);

// One sentence without a full stop: the error with the lines, beside the recommended one. recommended: as measure_promises() returns it.
std::string promise_text(const EngineAdvice& advice, const EnginePromise& recommended);

// The same of the bounds that the lines break: "these lines are not an answer: acne 0.5% (bound 0.1%)". error: the most error, if one was
// asked for. Empty: they break none, or it is not known.
std::string broken_promise_text(const EngineAdvice& advice, const CurveOptions& bounds, std::optional<double> error);

}  // namespace noonmark
