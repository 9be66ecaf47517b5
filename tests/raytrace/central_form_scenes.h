// Random spot and point lights for the property tests' random scenes (closed_form_scenes.h).
#pragma once
#include <array>

#include "tests/raytrace/closed_form_scenes.h"

namespace noonmark::test {

// Where the light stands. All places lie on the site's grid, so that a plane through the light goes through it exactly.
enum class LightPlace { outside, inside, near_the_floor, near_a_shape };

struct CentralSpec {
  SceneSpec scene;
  bool point = false;
  int place = 0;                                          // LightPlace
  int x = 0, y = 0, z = 0;                                // thousandths of 4 m: inside; of the spot's target
  int azimuth_deg = 0, elevation_deg = 45, distance = 0;  // outside: thousandths of 12 m
  int shape = 0, decade = 1;  // near a shape, or the floor: 10^-decade m; nearer than 0.1 mm Embree itself is unsure
  int cone_deg = 60, extent_percent = 100;
  int filter = 0;
};

inline std::ostream& operator<<(std::ostream& out, const CentralSpec& s) {
  static constexpr const char* places[] = {"outside", "inside", "near the floor", "near a shape"};
  return out << s.scene << "\n  " << (s.point ? "point light " : "spot light ") << places[s.place] << ' ' << s.x << ' '
             << s.y << ' ' << s.z << ", azimuth " << s.azimuth_deg << " elevation " << s.elevation_deg << " distance "
             << s.distance << ", shape " << s.shape << " decade " << s.decade << ", cone " << s.cone_deg << " map "
             << s.extent_percent << "%, filter " << s.filter;
}

inline rc::Gen<CentralSpec> any_central(bool point, int kinds) {
  using rc::gen::inRange, rc::gen::set;
  const auto place = inRange(-1000, 1001);
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::build<CentralSpec>(
          set(&CentralSpec::scene, any_scene(kinds)), set(&CentralSpec::point, rc::gen::just(point)),
          set(&CentralSpec::place, inRange(0, 4)), set(&CentralSpec::x, place), set(&CentralSpec::y, inRange(-50, 700)),
          set(&CentralSpec::z, place), set(&CentralSpec::azimuth_deg, inRange(0, 360)),
          set(&CentralSpec::elevation_deg, inRange(0, 91)), set(&CentralSpec::distance, inRange(20, 1001)),
          set(&CentralSpec::shape, inRange(0, most_shapes)), set(&CentralSpec::decade, inRange(1, 5)),
          set(&CentralSpec::cone_deg, inRange(20, 121)),
          set(&CentralSpec::extent_percent, rc::gen::oneOf(rc::gen::just(100), inRange(50, 150))),
          set(&CentralSpec::filter, inRange(0, 6))));
}

// Puts the light into the model's scene; the scene's camera stays.
inline void place_light(const CentralSpec& spec, const Site& site, Modelled& model) {
  const auto snapped = [&](glm::dvec3 p) { return glm::round(p / site.grid_m) * site.grid_m; };
  const glm::dvec3 anywhere = site.origin_m + 0.004 * glm::dvec3(spec.x, spec.y, spec.z);
  const double little = std::pow(10.0, -spec.decade);
  glm::dvec3 at = anywhere;
  switch (static_cast<LightPlace>(spec.place)) {
    case LightPlace::outside:
      at = site.origin_m + 0.012 * spec.distance * toward(spec.azimuth_deg, spec.elevation_deg);
      break;
    case LightPlace::inside:
      break;
    case LightPlace::near_the_floor:
      at.y = site.origin_m.y + little;
      break;
    case LightPlace::near_a_shape: {
      const Shape& s = model.inner[static_cast<size_t>(spec.shape) % model.inner.size()];
      if (s.kind == ShapeKind::sphere) {
        at = s.at + (s.radius + little) * toward(spec.azimuth_deg, spec.elevation_deg);
        break;
      }
      const FlatFace f = face_of(s, s.kind == ShapeKind::box ? spec.azimuth_deg % 6 : 0);
      const double u = 0.0005 * (spec.x + 1000), v = 0.0005 * (spec.z + 1000);
      at = f.at + u * f.u + v * f.v + little * glm::normalize(glm::cross(f.u, f.v));
      break;
    }
  }
  Light& light = model.scene.light;
  light.kind = spec.point ? LightKind::point : LightKind::spot;
  light.position_m = snapped(at);
  light.target_m = site.origin_m + 0.002 * glm::dvec3(spec.x, spec.y, spec.z);
  if (static_cast<LightPlace>(spec.place) == LightPlace::inside) light.target_m = site.origin_m;
  light.cone_deg = spec.cone_deg;
}

inline Settings settings_of(const CentralSpec& spec) {
  Settings s;
  s.map.resolution = spec.scene.resolution;
  s.map.extent_scale = 0.01 * (spec.point ? 100 : spec.extent_percent);
  FilterSettings& f = s.filter;
  const int size = spec.scene.seed % 2 ? 5 : 3;
  if (spec.point) {
    switch (spec.filter) {
      case 0:
      case 1:
        break;
      case 2:
        f = {.kind = "cube_grid", .offset_m = 0.1};
        break;
      case 3:
        f = {.kind = "cube_disk", .radius_m = 0.02};
        break;
      case 4:
        f = {.kind = "cube_disk", .radius_m = 0.5};
        break;
      case 5:
        f = {.kind = "cube_disk", .disk = DiskRadius::view_distance};
        break;
    }
    return s;
  }
  switch (spec.filter) {
    case 0:
      break;
    case 1:
      f = {.kind = "box", .size = size};
      break;
    case 2:
      f = {.kind = "box", .size = size, .step_texels = 1.5};
      break;
    case 3:
      f.kind = "hardware";
      break;
    case 4:
      f = {.kind = "gaussian", .size = size};
      break;
    case 5:
      f = {.kind = "poisson", .radius_texels = 3, .rotate = true};
      break;
  }
  return s;
}

}  // namespace noonmark::test
