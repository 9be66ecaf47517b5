#include "scenes/builtin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/shapes.h"

namespace noonmark {
namespace {

void add_light_from_above(Scene& scene) {
  scene.light = {.position_m = {0, 8, 0}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 8, .near_m = 2, .far_m = 10};
}

}  // namespace

// Horizontal plates over a floor. The lowest covers the edges of all others, so where those end, the floor is in full
// shadow and a filtered map sees casters at several depths: it leaks. The upper edges that face -x lie at x = 0,
// offset_m, 2 offset_m and so on, so that a blur of the width W has the share offset_m / W of every plate between the
// lowest and the highest.
Scene layers(const SceneSettings& settings) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  // No plate reaches down to the floor or to the plate below it.
  const double thickness_m = std::min({0.02, settings.gap_m / 2, settings.step_m / 2});
  for (int i = 0; i < settings.plates; ++i) {
    const double top = settings.gap_m + i * settings.step_m, upper = i - 1;
    const glm::dvec2 low = i == 0 ? glm::dvec2(-2, -1.5) : glm::dvec2(upper * settings.offset_m, -1 + 0.25 * upper),
                     high = i == 0 ? glm::dvec2(2, 1.5) : glm::dvec2(low.x + 2.5, low.y + 2);
    add_box(scene, "plate", {low.x, top - thickness_m, low.y}, {high.x, top, high.y});
  }
  scene.camera = {.eye_m = {-5, 1.7, 4.2}, .target_m = {0.2, 0.6, 0}, .fov_y_deg = 42};
  add_light_from_above(scene);
  // The map begins above all plates, also above the light, whose rays are parallel.
  const double highest = settings.gap_m + (settings.plates - 1) * settings.step_m;
  scene.map->near_m = std::min(scene.map->near_m, scene.light.position_m.y - highest - 0.5);
  return scene;
}

// A floor and a face that rises from it, both lit: no point shadows another. A blur across the crease mixes their
// depths, and a filtered map is too dark on both sides of it, whatever the angle.
Scene crease(const SceneSettings& settings) {
  Scene scene;
  const double theta = settings.theta_deg * std::numbers::pi / 180;
  add_quad(scene, "floor", {-4, 0, -3}, {0, 0, 6}, {4, 0, 0});
  add_quad(scene, "rising face", {0, 0, -3}, {0, 0, 6}, {2 * std::cos(theta), 2 * std::sin(theta), 0});
  scene.camera = {.eye_m = {-4.2, 2.6, 3.4}, .target_m = {-0.2, 0.3, 0}, .fov_y_deg = 45};
  add_light_from_above(scene);
  return scene;
}

// An open stair. Each tread reaches under the next one, so the floor below is in full shadow, and a blur of several
// treads holds as many depths of casters.
Scene stairs(const SceneSettings&) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  const double rise_m = 0.1875, going_m = 0.25;
  for (int i = 0; i < 12; ++i) {
    const double x = -1.5 + i * going_m, top = (i + 1) * rise_m;
    add_box(scene, "tread", {x, top - 0.04, -0.8}, {x + going_m + 0.04, top, 0.8});
  }
  scene.camera = {.eye_m = {3.6, 2.0, 4.6}, .target_m = {0.3, 0.7, 0}, .fov_y_deg = 42};
  add_light_from_above(scene);
  return scene;
}

}  // namespace noonmark
