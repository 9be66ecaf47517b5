#include "app/advise/seen_depths.h"

#include <algorithm>
#include <set>
#include <string>

#include "scenes/camera_fit.h"
#include "technique/light_frame.h"

namespace noonmark {

SeenDepths depths_in_views(Workbench& bench, std::span<const Settings> conditions) {
  std::set<std::string> known;  // conditions are many where lights or placements differ, and views are few
  SeenDepths seen;
  for (const Settings& condition : conditions) {
    std::string key;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("scene.") || row.name.starts_with("view.") || row.name.starts_with("motion."))
        key += row.get(condition) + '\n';
    if (!known.insert(key).second) continue;
    const Scene& scene = bench.scene(condition.scene);
    seen.nearest_m = std::min(seen.nearest_m, *effective_camera(scene, condition.view).near_m);
    seen.farthest_m = std::max(seen.farthest_m, farthest_in_view_m(condition, scene));
  }
  return seen;
}

}  // namespace noonmark
