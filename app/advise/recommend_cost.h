// The work of settings in a picture of full size, from a small picture of the same view.
#pragma once
#include "compare/results/records.h"
#include "technique/settings.h"

namespace noonmark {

// What a view and a light have in common for all settings.
struct SeenShare {
  double facing = 0;  // share of the pixels that look up
  double map_squares =
      1;  // texels of a map, in squares of map.resolution: 6 for a cube; of several maps that of one of them
};
SeenShare seen_share(const PointRecord& measured);

// texel_work (technique/cost.h).
double full_texel_work(const Settings& full, const SeenShare& seen);

}  // namespace noonmark
