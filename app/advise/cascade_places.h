// The ways to lay cascades over a view that a recommendation compares with single maps.
//
//   const CascadePlaces found = cascade_places(bench, request.conditions, cascade_counts, {}, width_px, say);
//   request.places.insert(request.places.end(), found.places.begin(), found.places.end());
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/map_places.h"
#include "measure/workbench.h"

namespace noonmark {

// The counts that are tried.
inline constexpr int cascade_counts[] = {2, 3, 4};

// One place for each count. Its cascades are spheres that are snapped, so that they stand still in the world, with a bias in
// texels, which is right in all of them (law 31). They end at map.reach_m, or where the farthest receiver of all conditions
// lies. Their ends are numbers of their own (cascades.splits = manual), the same in every frame: those of the practical scheme
// whose lambda has the least error under the first condition, of a few. Empty, with why_not: the light is not directional, the
// conditions differ in the camera's near plane by more than the splits can hold, or nothing is in view. Throws Error.
//
// engines: those in which the settings must hold (EngineAdvice::engine). Each whose cascades Noonmark has settings for has places of
// its own in place of these: with its fits and ends, and the bias that one number of its gives each cascade, so that the window
// of the bias is that of its number.
struct CascadePlaces {
  std::vector<MapPlace> places;
  std::string why_not;
};
CascadePlaces cascade_places(Workbench& bench, std::span<const Settings> conditions, std::span<const int> counts,
                             std::span<const std::string> engines, int width_px,
                             const std::function<void(const std::string&)>& say);

}  // namespace noonmark
