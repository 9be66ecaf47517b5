#include "app/advise/experiment_engines.h"

#include <algorithm>

#include "app/advise/engines/engine_settings.h"
#include "app/advise/recommend_text.h"
#include "technique/light_frame.h"

namespace noonmark {

std::string experiment_engines(Workbench& bench, const Experiment& experiment, const Settings& first) {
  const bool one_choice = experiment.parts.empty() && std::all_of(experiment.swept.begin(), experiment.swept.end(),
                                                                  [](const Swept& swept) { return swept.condition; });
  if (!one_choice) return "";
  const Scene& scene = bench.scene(first.scene);
  return advice_engines(engine_advice(first, make_light_frame(scene, first), scene));
}

}  // namespace noonmark
