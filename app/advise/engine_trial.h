// A recommendation tried in the engine itself: the printed lines are run in an adapter (app/advise/engine_adapters.h), and the
// engine's own frames are judged under the searched views, beside what was promised.
//
//   const TrialPlan plan = plan_trial(bench, request.conditions, {"three"}, "");   // before the search
//   try_engines(bench, plan, advised, {.bounds = request.curve, .accuracy = "error_soft"}, out, say);
//   for (const std::string& line : trial_text(advised[0])) print(line);
//   return broken_in_engine(advised) ? 1 : 0;
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/advise/engine_adapters.h"
#include "app/advise/engines/engine_settings.h"
#include "compare/ladder/bias_curves.h"
#include "measure/workbench.h"

namespace noonmark {

// The engines, and the views in which they are tried.
struct TrialPlan {
  std::vector<std::string> names;  // engine_adapter()
  AdapterTools tools;
  std::vector<Settings> views;  // one scene and one light, each with its camera
};

// What a frame must keep.
struct TrialBounds {
  CurveOptions bounds;
  std::optional<double> error = {};  // the most error, if one was asked for
  std::string accuracy;              // the metric that was promised
};

// Throws Error(usage) if something is missing, or if an adapter cannot show these conditions. folder: find_adapters().
TrialPlan plan_trial(Workbench& bench, const std::vector<Settings>& conditions, const std::vector<std::string>& names,
                     const std::string& folder);

// The folder of the frames below that of the recommendation, and what may be removed of an earlier one.
inline constexpr const char* trial_folder = "recommended-engines";

// Sets EngineAdvice::trial of the plan's engines, and EngineAdvice::broken if a bound breaks there. out: the recommendation's folder. An adapter that gives no frame ends nothing: the trial says so. Throws Error.
void try_engines(Workbench& bench, const TrialPlan& plan, std::vector<EngineAdvice>& engines, const TrialBounds& bounds,
                 const std::string& out, const std::function<void(const std::string&)>& say);

// The table of an engine, and a sentence for each bound that breaks there. Empty: it was not tried.
std::vector<std::string> trial_text(const EngineAdvice& engine);

// Whether lines do not hold in their engine.
bool broken_in_engine(const std::vector<EngineAdvice>& engines);

// Throws Error(device) if an adapter gave no frame.
void require_frames(const std::vector<EngineAdvice>& engines);

}  // namespace noonmark
