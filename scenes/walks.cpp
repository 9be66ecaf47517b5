#include "scenes/builtin.h"

#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"

namespace noonmark {
namespace {

// A box on a square foot of 2 half_m, upright from y = low_m to high_m.
void add_pole(Scene& scene, const char* name, double x, double z, double half_m, double low_m, double high_m) {
  add_box(scene, name, {x - half_m, low_m, z - half_m}, {x + half_m, high_m, z + half_m});
}

// Three rails on posts along z, from near_z down to far_z.
void add_railing(Scene& scene, double x, double near_z, double far_z, double height_m, double step_m) {
  const double half_m = 0.02;
  for (const double share : {0.4, 0.7, 1.0}) {
    const double y = share * height_m;
    add_box(scene, "rail", {x - half_m, y - 2 * half_m, far_z}, {x + half_m, y, near_z});
  }
  for (int i = 0; near_z - i * step_m > far_z; ++i)
    add_pole(scene, "rail post", x - 0.03, near_z - 0.05 - i * step_m, 0.03, 0, height_m - 0.01);
}

}  // namespace

// A street of 80 m, seen along its length by a walker whose hand is on a railing 0.2 m beside the eye: the picture reaches
// from 0.2 m to 78 m. Posts and boxes stand at distances that grow by a fifth from one to the next, so that each octave of
// distance has four of both; a passage under a roof is dark but for a slit; houses and a second railing are far away.
Scene street(const SceneSettings&) {
  Scene scene;
  add_quad(scene, "floor", {-12, 0, -78}, {0, 0, 80}, {24, 0, 0});
  add_railing(scene, -0.22, -0.1, -19, 1.5, 2.1);
  add_railing(scene, 4, -38, -74, 1.1, 3);
  double z = -2.4;
  for (int i = 0; i < 19; ++i, z *= 1.2) {
    add_pole(scene, "post", -1.9, z, 0.07, 0, 2.6);
    const double side_m = 0.35 + 0.1 * (i % 3);
    add_box(scene, "box", {1.55 + 0.25 * (i % 4), 0, 1.12 * z - side_m},
            {1.55 + 0.25 * (i % 4) + side_m, 0.5 + 0.35 * (i % 3), 1.12 * z});
  }
  for (const double from : {-23.0, -27.3}) add_box(scene, "roof", {-3.4, 3.1, from - 4}, {3.4, 3.25, from});
  for (const double x : {-3.2, 3.2})
    for (const double at : {-23.3, -27.2, -31.0}) add_pole(scene, "pillar", x, at, 0.15, 0, 3.15);
  add_box(scene, "passage wall", {-3.4, 0, -30.8}, {-3.2, 1.1, -23.5});
  add_box(scene, "house", {-11, 0, -58}, {-6, 6.5, -46});
  add_box(scene, "house", {6, 0, -76}, {11, 5, -62});
  add_box(scene, "house", {5.5, 0, -34}, {10, 4.5, -22});
  scene.camera = {.eye_m = {0, 1.6, 0}, .target_m = {0.15, 1.25, -12}, .fov_y_deg = 60};
  scene.light = {.position_m = {-44, 55, -18}, .target_m = {0, 0, -38}};
  scene.map = MapVolume{.extent_m = 90, .near_m = 45, .far_m = 100};
  return scene;
}

// A walk over hills: the ground has slopes of up to 16 degrees at every distance, and the sun stands 30 degrees high, so
// that one bias in metres is acne far away or Peter Panning near by. Posts stand at distances that grow by a seventh.
Scene hills_walk(const SceneSettings&) {
  Scene scene;
  const auto height_m = [](double x, double z) {
    return 0.6 * std::sin(0.35 * x) * std::cos(0.23 * z) + 0.08 * std::sin(1.1 * x + 0.7 * z) - 0.015 * z;
  };
  add_surface(scene, "ground", 36, 84, false, [&](double s, double t) {
    const double x = 36 * s - 18, z = 4 - 84 * t;
    return glm::dvec3(x, height_m(x, z), z);
  });
  double z = -3;
  for (int i = 0; i < 24; ++i, z *= 1.143) {
    // Multiples of the golden ratio are spread evenly over the width that is in view.
    const double turns = 0.618034 * (i + 1), x = (turns - std::floor(turns) - 0.5) * std::min(-1.5 * z, 32.0);
    add_pole(scene, "post", x, z, 0.1 + 0.03 * (i % 3), height_m(x, z) - 0.4, height_m(x, z) + 1.8 + 0.5 * (i % 4));
  }
  scene.camera = {.eye_m = {0, height_m(0, 0) + 1.6, 0}, .target_m = {0, 1.2, -12}, .fov_y_deg = 60};
  scene.light = {.position_m = {-48, 29, -22}, .target_m = {0, 0, -38}};
  scene.map = MapVolume{.extent_m = 94, .near_m = 25, .far_m = 95};
  return scene;
}

}  // namespace noonmark
