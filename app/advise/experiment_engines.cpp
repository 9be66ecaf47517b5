#include "app/advise/experiment_engines.h"

#include <algorithm>
#include <set>

#include "app/advise/engines/engine_settings.h"
#include "app/advise/recommend_text.h"
#include "technique/light_frame.h"

namespace noonmark {

double farthest_in_views_m(Workbench& bench, std::span<const Settings> conditions) {
  std::set<std::string> known;  // conditions are many where lights or placements differ, and views are few
  double farthest_m = 0;
  for (const Settings& condition : conditions) {
    std::string key;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("scene.") || row.name.starts_with("view.") || row.name.starts_with("motion."))
        key += row.get(condition) + '\n';
    if (known.insert(key).second)
      farthest_m = std::max(farthest_m, farthest_in_view_m(condition, bench.scene(condition.scene)));
  }
  return farthest_m;
}

std::string experiment_engines(Workbench& bench, const Experiment& experiment, std::span<const Settings> points) {
  const bool one_choice = experiment.parts.empty() && std::all_of(experiment.swept.begin(), experiment.swept.end(),
                                                                  [](const Swept& swept) { return swept.condition; });
  if (!one_choice) return "";
  const double farthest_m = farthest_in_views_m(bench, points);
  const Settings& first = points.front();
  const Scene& scene = bench.scene(first.scene);
  return advice_engines(engine_advice(first, make_light_frame(scene, first), scene, farthest_m));
}

}  // namespace noonmark
