// What was found, for programs (recommend_text.h).
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/advise/engine_trial_json.h"
#include "app/advise/recommend_lookups.h"
#include "app/advise/recommend_text.h"
#include "compare/results/quantities.h"
#include "scenes/library.h"

namespace noonmark {
namespace {
using nlohmann::json;

json tried_json(const Tried& tried) {
  json one{{"settings", settings_map(tried.settings)}, {"bias_kind", tried.level}, {"texel_work", tried.cost}};
  if (tried.bias) {
    one["error"] = tried.error;
    one["screened_error"] = tried.screened_error;
    one["bias"] = {{"parameter", tried.bias->parameter}, {"unit", tried.bias->unit},
                   {"value", tried.bias->value},         {"from", tried.bias->window.low},
                   {"to", tried.bias->window.high},      {"narrow", tried.bias->narrow},
                   {"fragile", is_fragile(*tried.bias)}};
  }
  if (tried.reduction) {
    one["error"] = tried.error;
    one["screened_error"] = tried.screened_error;
    one["reduction"] = {
        {"value", tried.reduction->value}, {"from", tried.reduction->low}, {"to", tried.reduction->high}};
  }
  if (tried.as_is) one["error"] = tried.error, one["screened_error"] = tried.screened_error;
  if (tried.eye)
    one["eye"] = {{"edge_displacement_mean_pixels", tried.eye->edge_mean_pixels},
                  {edge_metric, tried.eye->edge_p95_pixels},
                  {patch_metric, tried.eye->wrong_patch},
                  {"flip", tried.eye->flip}};
  if (!tried.why_not.empty()) one["why_not"] = tried.why_not, one["held"] = tried.held;
  return one;
}

json answer_json(const Answer& answer) {
  json one = tried_json(answer.tried);
  one["verified"] = {
      {"conditions", answer.conditions},           {"searched_placements", answer.placements},
      {"placements", answer.verified.placements},  {"rendered_placements", answer.verified.rendered},
      {"worst_acne", answer.verified.worst_acne},  {"worst_peter_panning", answer.verified.worst_peter_panning},
      {"worst_error", answer.verified.worst_error}};
  if (answer.tried.filtered()) {
    const FilteredShares& worst = answer.verified.filtered;
    one["verified"]["worst_leak"] = worst.leak;
    one["verified"]["worst_over_darkening"] = worst.over_darkening;
    one["verified"]["worst_reduction"] = worst.reduction;
    if (answer.verified.worst)
      one["verified"]["worst_error_causes"] = {
          {"precision", metric_of(*answer.verified.worst, "precision")},
          {"moment_precision", metric_of(*answer.verified.worst, "moment_precision")}};
  }
  return one;
}

json engine_json(const EngineAdvice& engine) {
  json one{{"engine", engine.engine},
           {"version", engine.version},
           {"lines", engine.lines},
           {"cannot", engine.cannot},
           {"source", engine.source}};
  if (engine.emulated) one["settings"] = settings_map(*engine.emulated);
  if (!engine.broken.empty()) one["broken"] = engine.broken;
  if (engine.promise)
    one["promise"] = promise_json(*engine.promise), one["promise"]["all_views"] = engine.promise->all_views;
  if (engine.trial) one["tried"] = trial_json(*engine.trial);
  if (!engine.why_not_emulated.empty()) one["why_not_measured"] = engine.why_not_emulated;
  return one;
}
}  // namespace

std::string subject_of(const Settings& settings) {
  const std::string& name = settings.scene.name;
  return names_file(name) ? std::filesystem::absolute(name).lexically_normal().string() : name;
}

std::string subject_in(const std::string& advice) {
  const nlohmann::json found = nlohmann::json::parse(advice, nullptr, false);
  return found.is_object() && found.contains("scene") && found["scene"].is_string() ? found["scene"].get<std::string>()
                                                                                    : "";
}

std::string advice_json(const Advice& advice, const std::vector<EngineAdvice>& engines) {
  json all;
  all["text"] = advice_text(advice);
  all["rejected"] = rejected_text(advice);
  all["notes"] = advice.request.about;
  all["scene"] = subject_of(advice.request.conditions.front());
  all["accuracy"] = advice.request.accuracy;
  all["answer"] = json();
  all["lookups"] = json::array();
  for (const LookupFate& fate : lookup_fates(advice)) {
    json one{{"lookup", fate.lookup}, {"outcome", outcome_name(fate.outcome)}, {"why", fate.why}};
    if (fate.best) one["best"] = tried_json(*fate.best);
    all["lookups"].push_back(one);
  }
  all["answers"] = json::object();
  for (const Answer& answer : advice.answers) {
    const json one = answer_json(answer);
    for (AnswerKind kind : answer.kinds) all["answers"][answer_name(kind)] = one;
    if (&answer == advice.answer()) all["answer"] = one, all["answer"]["kind"] = answer_name(advice.request.answer);
  }
  if (!advice.answers.empty()) all["budget"] = advice.budget;
  all["wrong_without_shadows"] = advice.shadowed;
  if (advice.nearest) {
    all["nearest"] = tried_json(*advice.nearest);
    if (advice.nearest->worst)
      all["nearest"]["worst"] = {{"x", advice.nearest->worst->worst.x},
                                 {"y", advice.nearest->worst->worst.y},
                                 {"cause", advice.nearest->worst->worst.cause}};
  }
  all["engines"] = json::array();
  for (const EngineAdvice& engine : engines) {
    all["engines"].push_back(engine_json(engine));
  }
  all["tried"] = json::array();
  for (const Tried& tried : advice.tried) all["tried"].push_back(tried_json(tried));
  return all.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace noonmark
