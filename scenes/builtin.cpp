#include "scenes/builtin.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "scenes/camera_frame.h"
#include "scenes/foliage.h"
#include "scenes/library.h"
#include "scenes/shapes.h"

namespace noonmark {
namespace {

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }

void add_floor(Scene& scene, double half_m, double y_m) {
  add_quad(scene, "floor", {-half_m, y_m, -half_m}, {0, 0, 2 * half_m}, {2 * half_m, 0, 0});
}

// The standard tutorial scene: an oblique light over a wide floor and three cubes. At bias 0 the floor is striped with
// acne; the map covers only the middle of the floor, so wrap and far plane show as well.
Scene cube_room(const SceneSettings&) {
  Scene scene;
  add_floor(scene, 25, -0.5);
  const auto place = [](glm::dvec3 at, double turn_deg) {
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), at);
    return turn_deg == 0 ? moved : glm::rotate(moved, radians(turn_deg), glm::normalize(glm::dvec3(1, 0, 1)));
  };
  add_box(scene, "floating cube", glm::dvec3(0.5), place({0, 1.5, 0}, 0));
  add_box(scene, "standing cube", glm::dvec3(0.5), place({2, 0, 1}, 0));
  add_box(scene, "turned cube", glm::dvec3(0.25), place({-1, 0, 2}, 60));
  scene.camera = {.eye_m = {-1.6, 2.8, 6.4}, .target_m = {1.0, 0.35, 0.6}, .fov_y_deg = 45};
  scene.light = {.position_m = {-2, 4, -1}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 20, .near_m = 1, .far_m = 7.5};
  return scene;
}

// A lone tilted plane under a light straight above: acne and nothing else, of exactly the size that law 1 gives. theta:
// between the plane's normal and the light; phi: azimuth of the slope in the map, against its u axis.
Scene plane(const SceneSettings& settings) {
  Scene scene;
  scene.light = {.position_m = {0, 10, 0}, .target_m = {0, 0, 0}};
  glm::dvec3 u, v;
  upright_axes({0, -1, 0}, {0, 1, 0}, u, v);
  const double theta = radians(settings.theta_deg), phi = radians(settings.phi_deg);
  const glm::dvec3 slope_way = std::cos(phi) * u + std::sin(phi) * v;
  const glm::dvec3 normal = glm::normalize(std::cos(theta) * glm::dvec3(0, 1, 0) + std::sin(theta) * slope_way);
  const glm::dvec3 across = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), slope_way));
  const glm::dvec3 down = glm::cross(across, normal);
  const double half_m = 3;
  add_quad(scene, "plane", -half_m * (across + down), 2 * half_m * down, 2 * half_m * across);
  scene.camera = {
      .eye_m = 7.0 * normal, .target_m = {0, 0, 0}, .up = glm::normalize(0.9 * across + 0.44 * down), .fov_y_deg = 35};
  scene.map = MapVolume{.extent_m = 10, .near_m = 5, .far_m = 15};
  return scene;
}

// Two walls on a floor, one seen from its shadowed side and one from its lit side. A bias lights a gap at the foot of
// the first (law 2: max(0, b sin(theta) - t / cos(psi)) along the light's trace) and none at the foot of the second.
Scene wall(const SceneSettings& settings) {
  Scene scene;
  const double t = settings.thickness_m;
  add_floor(scene, 5, 0);
  add_box(scene, "wall seen from its shadow", {0, 0, 0}, {t, 1.5, 3});
  add_box(scene, "wall seen from its light", {1, 0, -2}, {4, 1.5, -2 + t});
  scene.camera = {.eye_m = {7, 5, -5}, .target_m = {1.4, 0.2, 0.2}, .fov_y_deg = 38};
  scene.light = {.position_m = {-4, 4, -2}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 14, .near_m = -2, .far_m = 14};
  return scene;
}

// A thin plate above a floor. Its shadow is lost once its lit face stands less than b cos(theta) above the floor,
// however thick it is: the map stores the lit face. phi: turns it about the vertical, so that under a light straight
// above its edges cross the texels at that angle.
Scene plate(const SceneSettings& settings) {
  Scene scene;
  add_floor(scene, 3, 0);
  const double top = settings.height_m;
  const glm::dvec3 low(-0.8, top - settings.thickness_m, -0.6), high(0.8, top, 0.6);
  const glm::dmat4 placed = glm::translate(glm::dmat4(1), (low + high) / 2.0);
  add_box(scene, "plate", (high - low) / 2.0, glm::rotate(placed, radians(settings.phi_deg), glm::dvec3(0, 1, 0)));
  scene.camera = {.eye_m = {3.2, 2.6, 4.2}, .target_m = {0.2, 0.1, 0.1}, .fov_y_deg = 35};
  scene.light = {.position_m = {-3, 4, -1.5}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 9, .near_m = 0.5, .far_m = 10};
  return scene;
}

// Pillars 30 m apart: the frustum-size case. An extent of 20 m sees one pillar well and loses the others; 200 m holds
// them all and has ten times coarser texels.
Scene pillars(const SceneSettings&) {
  Scene scene;
  add_floor(scene, 80, 0);
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      add_box(scene, "pillar", {30.0 * i - 0.5, 0, 30.0 * j - 0.5}, {30.0 * i + 0.5, 4, 30.0 * j + 0.5});
  scene.camera = {.eye_m = {11, 5, 17}, .target_m = {0, 1, 0}, .fov_y_deg = 45};
  scene.light = {.position_m = {-30, 60, -20}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 200, .near_m = -40, .far_m = 180};
  return scene;
}

// One sphere, a closed convex solid: every slope from facing to grazing, and no occluder. It shows acne only. At the
// terminator there is a band that no bounded bias can cure (law 1).
Scene sphere(const SceneSettings&) {
  Scene scene;
  add_surface(scene, "sphere", 192, 96, true, [](double s, double t) {
    const double phi = 2 * std::numbers::pi * s, polar = std::numbers::pi * t;
    const double r = t == 0 || t == 1 ? 0 : std::sin(polar);  // sin(pi) is not 0 in floating point, and poles must weld
    return glm::dvec3(r * std::sin(phi), -std::cos(polar), r * std::cos(phi));
  });
  scene.camera = {.eye_m = {-1.5, 2.2, 3.6}, .target_m = {0, 0, 0}, .fov_y_deg = 30};
  scene.light = {.position_m = {-2, 4, -1}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 2.6, .near_m = 2, .far_m = 8};
  return scene;
}

// A bowl under a light straight above: concave, but no point of it shadows another. There is only acne. A rule that
// takes every hit on another triangle for an occluder would report aliasing here.
Scene bowl(const SceneSettings&) {
  Scene scene;
  add_surface(scene, "bowl", 96, 32, true, [](double s, double t) {
    const double phi = 2 * std::numbers::pi * s, polar = radians(80) * (1 - t);
    const double r = t == 1 ? 0 : std::sin(polar);
    return glm::dvec3(r * std::sin(phi), 1 - std::cos(polar), r * std::cos(phi));
  });
  scene.camera = {.eye_m = {0.6, 4.2, 1.8}, .target_m = {0, 0.3, 0}, .fov_y_deg = 30};
  scene.light = {.position_m = {0, 5, 0}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 2.6, .near_m = 3, .far_m = 6};
  return scene;
}

// A fence of wires thinner than a texel of the usual maps: the map loses or thickens each wire by chance, and more
// resolution does not help until a texel is thinner than a wire (law 5's saturation).
Scene fence(const SceneSettings&) {
  Scene scene;
  add_floor(scene, 4, 0);
  const double wire = 0.004, half = 1.5;
  for (int i = 0; i <= 60; ++i) {
    const double z = -half + 2 * half * i / 60;
    add_box(scene, "wire", {-wire / 2, 0.05, z - wire / 2}, {wire / 2, 1, z + wire / 2});
  }
  for (double y : {0.05, 1.0}) add_box(scene, "rail", {-0.02, y - 0.02, -half - 0.05}, {0.02, y + 0.02, half + 0.05});
  for (double z : {-half - 0.05, half + 0.05}) add_box(scene, "post", {-0.03, 0, z - 0.03}, {0.03, 1.1, z + 0.03});
  scene.camera = {.eye_m = {3.4, 2.2, 2.6}, .target_m = {0.4, 0.2, 0}, .fov_y_deg = 38};
  scene.light = {.position_m = {-3, 4, -1.2}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 11, .near_m = 0, .far_m = 10};
  return scene;
}

// A house front with six windows, cut as modellers do: a grid of wall pieces around the openings, with faces of their
// own for the reveals. Sills and a canopy cast shadows over the seams. Rotated (scene.turn_deg) and cut differently
// (scene.mesh), it has the seams and T-junctions of real meshes.
Scene facade(const SceneSettings&) {
  Scene scene;
  add_floor(scene, 4, 0);
  const double x[] = {-2.4, -1.9, -1.0, -0.45, 0.45, 1.0, 1.9, 2.4}, y[] = {0, 0.7, 1.5, 2.1, 2.9, 3.3}, depth = 0.2;
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 5; ++j) {
      const glm::dvec3 corner(x[i], y[j], 0), right(x[i + 1] - x[i], 0, 0), up(0, y[j + 1] - y[j], 0);
      const bool window = i % 2 == 1 && j % 2 == 1;
      const glm::dvec3 back(0, 0, window ? -depth : 0);
      add_quad(scene, window ? "pane" : "wall piece", corner + back, right, up);
      if (!window) continue;
      add_quad(scene, "reveal", corner, -back, up);
      add_quad(scene, "reveal", corner + right, up, -back);
      add_quad(scene, "reveal", corner, right, -back);
      add_quad(scene, "reveal", corner + up, -back, right);
      add_box(scene, "sill", {x[i] - 0.08, y[j] - 0.08, 0}, {x[i + 1] + 0.08, y[j] - 0.02, 0.12});
    }
  }
  add_box(scene, "canopy", {-0.7, 2.0, 0.4}, {0.7, 2.05, 1.2});
  scene.camera = {.eye_m = {1.8, 2.2, 6.4}, .target_m = {0, 1.5, 0}, .fov_y_deg = 38};
  scene.light = {.position_m = {-3, 5, 4}, .target_m = {0, 1.2, 0}};
  scene.map = MapVolume{.extent_m = 12, .near_m = -1, .far_m = 14};
  return scene;
}

// A spot light low over a long floor. Its texels widen with the distance, and one step of window depth becomes more
// metres (z^2 (far - near) / (far near) for 1). So one bias gives acne near the light and Peter Panning at the far end,
// where the steps of a shadow edge are also five times as large. Boxes stand on the floor and against the wall, and one
// leans over, so there are contacts at every distance.
Scene spot_room(const SceneSettings&) {
  Scene scene;
  add_floor(scene, 9, 0);
  add_box(scene, "wall", {0.5, 0, -4.2}, {7, 2.4, -4});
  const auto place = [](glm::dvec3 at, double turn_deg, glm::dvec3 about) {
    return glm::rotate(glm::translate(glm::dmat4(1), at), radians(turn_deg), glm::normalize(about));
  };
  add_box(scene, "near box", glm::dvec3(0.4), place({-3, 0.4, 0.4}, 30, {0, 1, 0}));
  add_box(scene, "post", {-0.6, 0, 0.8}, {-0.4, 1.8, 1});
  add_box(scene, "leaning box", glm::dvec3(0.5, 0.2, 0.5), place({1, 0.6, -1}, 35, {0.4, 0, 1}));
  add_box(scene, "box at the wall", {2, 0, -4}, {3.2, 0.9, -3});
  add_box(scene, "far box", glm::dvec3(0.6), place({5.4, 0.6, -0.6}, 20, {0, 1, 0}));
  scene.camera = {.eye_m = {0.2, 5, 11}, .target_m = {0.2, 0.6, -0.8}, .fov_y_deg = 45};
  scene.light = {.kind = LightKind::spot, .position_m = {-6, 3.5, 1.5}, .target_m = {0.5, 0.2, -0.8}, .cone_deg = 64};
  scene.map = MapVolume{.near_m = 1, .far_m = 22};
  return scene;
}

// The standard tutorial room for a point light: closed, 10 m wide, seen from inside, with five cubes around a light in
// the middle. Every wall takes shadows, across the seams of the cube map; one texel is twelve times as wide on a wall's
// corner as at near. The light is a centimetre beside the middle. From the exact middle the cubes' edges would lie in
// planes through the centres of texels (x/z = 5/7 and so on), and rounding would decide what those texels hold.
Scene point_room(const SceneSettings&) {
  Scene scene;
  add_box(scene, "room", glm::dvec3(5), glm::dmat4(1));
  for (glm::uvec3& t : scene.triangles) std::swap(t.y, t.z);  // its faces look inward
  const auto cube = [&](glm::dvec3 at, double half_m, double turn_deg) {
    const glm::dmat4 placed = glm::translate(glm::dmat4(1), at);
    add_box(scene, "cube", glm::dvec3(half_m),
            glm::rotate(placed, radians(turn_deg), glm::normalize(glm::dvec3(1, 0, 1))));
  };
  cube({4, -3.5, 0}, 0.5, 0);
  cube({2, 3, 1}, 0.75, 0);
  cube({-3, -1, 0}, 0.5, 0);
  cube({-1.5, 1, 1.5}, 0.5, 0);
  cube({-1.5, 2, -3}, 0.75, 60);
  scene.camera = {.eye_m = {-4.3, -2.5, 4.4}, .target_m = {1, 0.5, -1.5}, .fov_y_deg = 75};
  scene.light = {.kind = LightKind::point, .position_m = {0.013, 0.007, -0.011}, .target_m = {0, -1, 0}};
  scene.map = MapVolume{.near_m = 1, .far_m = 25};
  return scene;
}

constexpr BuiltinScene scenes[] = {
    {"cube-room", "the standard tutorial scene: acne stripes, Peter Panning, a map smaller than the floor", cube_room},
    {"plane",
     "acne alone, on a plane of any slope (scene.theta_deg, scene.phi_deg)",
     plane,
     {"scene.theta_deg", "scene.phi_deg"}},
    {"wall",
     "Peter Panning at the foot of a wall (scene.thickness_m), none at a lit foot",
     wall,
     {"scene.thickness_m"}},
    {"plate",
     "a plate whose shadow a bias can lose (scene.height_m, scene.thickness_m, scene.phi_deg)",
     plate,
     {"scene.height_m", "scene.thickness_m", "scene.phi_deg"}},
    {"pillars", "objects 30 m apart: extent against resolution", pillars},
    {"sphere", "every slope up to grazing, no occluder", sphere},
    {"bowl", "a concave receiver that does not shade itself", bowl},
    {"fence", "wires thinner than a texel", fence},
    {"foliage",
     "alpha masks: fronds on cards (scene.masks), leaflets near the size of a texel",
     foliage,
     {"scene.masks"}},
    {"facade", "a house front with windows: seams of many pieces, reveals, shadows that cross them", facade},
    {"spot-room", "spot light: one bias is acne near it and Peter Panning far away; coarser texels; contacts",
     spot_room},
    {"point-room", "point light in a closed room with five cubes: shadows on every wall, over the map's seams",
     point_room},
    {"lab", "a furnished room with three lights: a sun through windows, a spotlight on a drone, a lamp beside a cube",
     lab},
    {"street", "80 m in one picture, from a railing at the eye to houses: texels of one map against those of several",
     street},
    {"hills-walk", "80 m of hills with posts under a low sun: every slope at every distance, so one bias fits none",
     hills_walk},
    {"layers",
     "plates one above the other: where filtered maps leak (scene.plates, scene.gap_m, scene.step_m, scene.offset_m)",
     layers,
     {"scene.plates", "scene.gap_m", "scene.step_m", "scene.offset_m"}},
    {"crease",
     "a floor square to the light and a face that rises from it (scene.theta_deg): lit, and dark in filtered maps",
     crease,
     {"scene.theta_deg"}},
    {"stairs", "an open stair over a floor: many layers within one blur, so that filtered maps leak through all of it",
     stairs},
};

}  // namespace

std::span<const BuiltinScene> builtin_scenes() { return scenes; }

}  // namespace noonmark
