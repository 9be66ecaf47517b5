#include "scenes/builtin.h"

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/shapes.h"

namespace noonmark {
namespace {

// A board on legs: a table, a bench.
void add_table(Scene& scene, const char* name, glm::dvec3 low, glm::dvec3 high, double board_m, double leg_m) {
  add_box(scene, name, {low.x, high.y - board_m, low.z}, high);
  for (const double x : {low.x, high.x - leg_m})
    for (const double z : {low.z, high.z - leg_m})
      add_box(scene, name, {x, low.y, z}, {x + leg_m, high.y - board_m, z + leg_m});
}

}  // namespace

// A furnished room of 8 x 3 x 6 m with three lights of three kinds: a sun through two windows, a spotlight on a drone that
// flies over the bench, and a lamp on the table beside a cube. Each has its own map, and no one setting is good for all: the
// sun's map covers the whole room for two patches of light, the spot's texels are wide at the far wall, and the lamp stands
// centimetres from what it lights. Cameras see the inside of the front wall only, so the camera stands outside.
Scene lab(const SceneSettings&) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -3}, {0, 0, 6}, {8, 0, 0});
  add_box(scene, "ceiling", {-4, 3, -3}, {4, 3.1, 3});
  add_box(scene, "right wall", {4, 0, -3}, {4.1, 3, 3});
  add_box(scene, "back wall", {-4, 0, -3.1}, {4, 3, -3});
  add_quad(scene, "front wall", {4, 0, 3}, {-8, 0, 0}, {0, 3, 0});
  // The left wall is cut around two windows, 0.2 m thick.
  const double z[] = {-3, -2.2, -0.9, 0.1, 1.4, 3}, sill = 0.9, lintel = 2.3;
  for (int i = 0; i < 5; ++i) {
    const bool window = i % 2 == 1;
    add_box(scene, "left wall", {-4.2, 0, z[i]}, {-4, window ? sill : 3, z[i + 1]});
    if (window) add_box(scene, "left wall", {-4.2, lintel, z[i]}, {-4, 3, z[i + 1]});
  }
  for (const int i : {1, 3}) {  // a cross of bars in each window
    const double middle = (z[i] + z[i + 1]) / 2;
    add_box(scene, "bar", {-4.12, sill, middle - 0.02}, {-4.08, lintel, middle + 0.02});
    add_box(scene, "bar", {-4.12, 1.58, z[i]}, {-4.08, 1.62, z[i + 1]});
  }
  add_table(scene, "table", {-0.6, 0, -1.1}, {1.0, 0.75, -0.3}, 0.04, 0.05);
  add_table(scene, "stool", {0.0, 0, 0.1}, {0.4, 0.45, 0.5}, 0.03, 0.03);
  add_table(scene, "bench", {2.2, 0, -2.4}, {3.6, 0.5, -1.4}, 0.06, 0.06);
  for (int shelf = 0; shelf < 4; ++shelf)
    add_box(scene, "shelf", {-3.2, 0.4 + 0.5 * shelf, -3}, {-1.6, 0.43 + 0.5 * shelf, -2.7});
  for (int book = 0; book < 9; ++book)
    add_box(scene, "book", {-3.1 + 0.08 * book, 0.93, -2.95}, {-3.05 + 0.08 * book, 1.16 + 0.03 * (book % 3), -2.78});
  const auto place = [](glm::dvec3 at, double turn_deg, glm::dvec3 about) {
    return glm::rotate(glm::translate(glm::dmat4(1), at), glm::radians(turn_deg), glm::normalize(about));
  };
  add_box(scene, "cube", glm::dvec3(0.09), place({0.45, 0.84, -0.75}, 30, {0, 1, 0}));
  add_box(scene, "crate", glm::dvec3(0.3), place({2.9, 0.8, -1.9}, 20, {0, 1, 0}));
  add_box(scene, "box", glm::dvec3(0.25), place({-1.9, 0.25, 0.6}, 40, {0, 1, 0}));
  // The lamp: a foot, a post, and a hat over the light.
  add_box(scene, "lamp", {0.02, 0.75, -0.82}, {0.18, 0.77, -0.66});
  add_box(scene, "lamp", {0.092, 0.77, -0.748}, {0.108, 1.2, -0.732});
  add_box(scene, "lamp", {-0.02, 1.2, -0.86}, {0.22, 1.21, -0.62});
  // The drone hangs in the air; its spotlight is below its body.
  const glm::dvec3 drone(1.6, 2.25, -0.6);
  add_box(scene, "drone", drone - glm::dvec3(0.12, 0, 0.12), drone + glm::dvec3(0.12, 0.06, 0.12));
  for (const double x : {-1.0, 1.0})
    for (const double along : {-1.0, 1.0}) {
      const glm::dvec3 end = drone + glm::dvec3(0.25 * x, 0.05, 0.25 * along);
      add_box(scene, "rotor", end - glm::dvec3(0.1, 0.005, 0.1), end + glm::dvec3(0.1, 0.005, 0.1));
    }
  for (const Part& part : scene.parts)
    for (uint32_t t = 0; t < part.triangle_count; ++t) scene.single_sided.push_back(part.name == "front wall");
  scene.camera = {.eye_m = {0.7, 2.2, 6.6}, .target_m = {0.0, 0.95, -1.2}, .fov_y_deg = 43};
  const auto add_light = [&](const char* name, const Light& light) { scene.lights.push_back({"", name, light, ""}); };
  add_light(
      "sun",
      {.position_m = {-9, 7, 2.5}, .target_m = {0, 0.8, -0.4}, .power = {.intensity = 1500, .color = {1, 0.93, 0.8}}});
  add_light("spot", {.kind = LightKind::spot,
                     .position_m = drone - glm::dvec3(0, 0.03, 0),
                     .target_m = {2.7, 0, -1.8},
                     .cone_deg = 62,
                     .power = {.intensity = 1800, .color = {0.85, 0.92, 1}, .range_m = 12, .inner_cone_deg = 40}});
  add_light("lamp", {.kind = LightKind::point,
                     .position_m = {0.17, 1.12, -0.74},
                     .target_m = {0.17, 0, -0.74},
                     .power = {.intensity = 420, .color = {1, 0.78, 0.5}, .range_m = 8}});
  scene.light = *scene.lights.front().value;
  return scene;
}

}  // namespace noonmark
