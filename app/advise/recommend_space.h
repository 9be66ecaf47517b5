// What a recommendation chooses from, where the user says nothing: kinds of bias, filters, and the views in which the
// answer must hold.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "measure/workbench.h"
#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

// A kind of bias, from the least to the most complicated; or a lookup in a filtered map with its bias
// (app/advise/recommend_filtered.h), which comes after all that compare.
struct BiasLevel {
  std::string name;                        // "one constant bias"
  std::function<void(Settings&)> apply;    // the settings have their filter already
  std::string lookup = "compare";          // lookup.kind
  std::vector<FilterSettings> blurs = {};  // of a filtered map, in the order of their reach
  bool filtered() const { return !blurs.empty(); }
};

std::vector<BiasLevel> bias_levels();

// In the order of their reach.
std::vector<FilterSettings> filters_to_try(LightKind light);

// Placements of a search, along each axis.
inline constexpr int searched_placements = 8;
// The same of a filtered map. There each placement costs as much as a point, and they differ little: over 4 x 4 placements
// the error of VSM in cube-room lies within 0.4% of its mean (docs/how-to/filtered-maps.md).
inline constexpr int filtered_placements = 4;

// The width of the pictures that are searched on, in pixels: at least least_searched_px, and as much as it takes to judge
// enough_receivers, but not more than the settings' own. So the default bound of 0.1% is 12 pixels, and not 2.
// bench: measures how many receivers the settings show. Throws Error.
inline constexpr int least_searched_px = 320;
inline constexpr double enough_receivers = 12000;
int searched_width_px(Workbench& bench, const Settings& settings);

// The same settings with a smaller picture of the same shape.
Settings small_picture(Settings settings, int width_px);

// The settings' own view, and views turned by -30, -15, 15 and 30 degrees: about the camera's target, or in place if the
// camera is inside the box of the scene, because it could leave a room.
std::vector<Settings> turned_views(const Settings& settings, const Scene& scene);

// The views between the outermost of them, and a little beyond, a few degrees apart.
std::vector<Settings> views_between(const Settings& settings, const Scene& scene);

}  // namespace noonmark
