#include "app/advise/recommend_cost.h"

#include <cmath>

#include "compare/results/quantities.h"
#include "technique/cost.h"

namespace noonmark {

SeenShare seen_share(const PointRecord& measured) {
  const auto setting = [&](const char* name) { return number_of(setting_of(measured, name)).value(); };
  const double side = setting("map.resolution");
  return {metric_of(measured, "facing") / (setting("view.width_px") * setting("view.height_px")),
          metric_of(measured, "map_texels") / side / side / setting("cascades.count")};
}

double full_texel_work(const Settings& full, const SeenShare& seen) {
  const auto receivers = std::llround(seen.facing * full.view.width_px * full.view.height_px);
  const auto texels = std::llround(seen.map_squares * full.map.resolution * full.map.resolution * full.cascades.count);
  return static_cast<double>(frame_cost(full, 1, texels, receivers, 0).texel_work);
}

}  // namespace noonmark
