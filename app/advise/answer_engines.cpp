#include "app/advise/answer_engines.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/advise/engine_promise.h"
#include "app/advise/map_places.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// Placements, along each axis, at which what an engine does is measured. There are up to eight engines, and the answer itself was
// searched at four times as many and verified at others.
constexpr int promised_placements = 4;

// The lines must hold in each view.
std::vector<EngineAdvice> engines_of(Workbench& bench, const Tried& tried, const AdviceRequest& request) {
  const Scene& scene = bench.scene(tried.settings.scene);
  return engine_advice(tried.settings, make_light_frame(scene, tried.settings), scene,
                       depths_in_views(bench, request.conditions));
}

std::vector<Settings> promised_under(const Tried& tried, const AdviceRequest& request) {
  std::vector<Settings> conditions = under_conditions(tried, request);
  for (Settings& condition : conditions)
    condition.map.placements = std::min(condition.map.placements, promised_placements);
  return conditions;
}

// Without the full stop of what the engine cannot.
std::string no_lines(const EngineAdvice& advice) {
  std::string why = advice.cannot.front();
  if (why.ends_with('.')) why.pop_back();
  return fmt::format("of {}: {}", advice.engine, why);
}

std::string not_known(const EngineAdvice& advice) {
  return fmt::format("what {} does with its lines is not known: {}", advice.engine, advice.why_not_emulated);
}

}  // namespace

std::vector<EngineAdvice> measured_engines(Workbench& bench, const Tried& answer, const AdviceRequest& request,
                                           const std::function<void(const std::string&)>& say) {
  std::vector<EngineAdvice> engines = engines_of(bench, answer, request);
  const EnginePromise recommended =
      measure_promises(bench, engines, promised_under(answer, request), request.accuracy, say);
  for (EngineAdvice& engine : engines) {
    engine.promised = promise_text(engine, recommended);
    engine.broken = broken_promise_text(engine, request.curve, request.error);
  }
  return engines;
}

Elsewhere in_engines(Workbench& bench, std::span<const WantedEngine> engines, const Tried& tried,
                     const AdviceRequest& request) {
  Elsewhere found;
  const Scene& scene = bench.scene(tried.settings.scene);
  const LightFrame frame = make_light_frame(scene, tried.settings);
  const SeenDepths seen = depths_in_views(bench, request.conditions);
  for (const WantedEngine& wanted : engines) {
    EngineAdvice advice = advice_for_engine(engine_word(wanted.engine), tried.settings, frame, scene, seen);
    if (advice.lines.empty()) return {no_lines(advice)};
    if (!advice.emulated && wanted.is_run) continue;
    if (!advice.emulated) return {not_known(advice)};
    advice.promise = measured_promise(bench, under_engine(advice, promised_under(tried, request)), request.accuracy);
    if (const std::string broken = broken_promise_text(advice, request.curve, request.error); !broken.empty())
      return {fmt::format("in {} {}", advice.engine, broken)};
    found.does.push_back(as_engine(advice, tried.settings));
  }
  return found;
}

std::string why_never_in_engines(Workbench& bench, std::span<const WantedEngine> engines, Settings settings) {
  if (settings.maps() == 1) return "";
  settings.filter = {"none", {}};  // every engine has it, or one of its own that Noonmark knows
  settings.bias = {};
  settings.bias["constant"] = 1;
  const Scene& scene = bench.scene(settings.scene);
  for (const WantedEngine& wanted : engines) {
    const EngineAdvice advice =
        advice_for_engine(engine_word(wanted.engine), settings, make_light_frame(scene, settings), scene);
    if (advice.lines.empty()) return no_lines(advice);
    if (!advice.emulated && !wanted.is_run) return not_known(advice);
  }
  return "";
}

}  // namespace noonmark
