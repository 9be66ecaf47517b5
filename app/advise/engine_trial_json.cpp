#include "app/advise/engine_trial_json.h"

namespace noonmark {

nlohmann::json promise_json(const EnginePromise& promise) {
  nlohmann::json one{{"error", promise.error}, {"acne", promise.acne}, {"peter_panning", promise.peter_panning}};
  if (const std::optional<FilteredShares>& shares = promise.filtered)
    one.update({{"leak", shares->leak}, {"over_darkening", shares->over_darkening}, {"reduction", shares->reduction}});
  return one;
}

nlohmann::json trial_json(const EngineTrial& trial) {
  nlohmann::json views = nlohmann::json::array();
  for (const TrialView& view : trial.views) {
    nlohmann::json one{{"view", view.name}, {"held", view.broken.empty() && view.refused.empty()}};
    if (view.promise) one["promised"] = promise_json(*view.promise);
    if (view.refused.empty()) one["measured"] = promise_json(view.measured), one["counted"] = view.counted;
    if (!view.broken.empty()) one["broken"] = view.broken;
    if (!view.refused.empty()) one["not_judged"] = view.refused;
    views.push_back(one);
  }
  nlohmann::json all{{"folder", trial.folder}, {"views", views}};
  if (!trial.no_frame.empty()) all["no_frame"] = trial.no_frame;
  return all;
}

}  // namespace noonmark
