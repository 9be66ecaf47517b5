// Settings whose numbers are easy to follow, and what an engine's lines say of them: shared by the tests of the engines' advice.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_settings.h"
#include "scenes/camera_fit.h"
#include "scenes/library.h"

namespace noonmark::test {

// Numbers are written with 6 significant digits, so each is at most 5e-6 of itself off; formulas here multiply at most
// two of them.
inline constexpr double written = 1.1e-5;

struct Case {
  Settings settings;
  Scene scene;
  LightFrame frame;
};

// A map whose numbers are easy to follow: 16 m wide, 512 texels of 1/32 m, depths from 2 m to 42 m.
inline Settings simple(LightChoice kind = LightChoice::directional) {
  Settings s;
  s.scene.name = "plane";
  s.light.kind = kind;
  s.light.position_m = glm::dvec3(0, 20, 0.5);
  s.light.target_m = glm::dvec3(0, 0, 0.5);
  s.light.cone_deg = 60;
  s.view.target_m = glm::dvec3(0, 10, 0.5);  // 10 m from the light on its axis
  s.map.resolution = 512;
  s.map.near_m = 2;
  s.map.far_m = 42;
  if (kind == LightChoice::directional) s.map.extent_m = 16;
  return s;
}

inline Case make(const Settings& settings) {
  Case c{settings, make_scene(settings.scene), {}};
  c.scene.light = effective_light(c.scene, settings);
  c.frame = make_light_frame(c.scene, settings);
  return c;
}

inline EngineAdvice advice(const Settings& settings, const std::string& engine) {
  const Case c = make(settings);
  return advice_for_engine(engine_word(engine), c.settings, c.frame, c.scene);
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

// The number that follows this text in the lines; NaN if there is none.
inline double typed(const EngineAdvice& advice, const std::string& before) {
  const std::string all = joined(advice.lines);
  const size_t at = all.find(before);
  if (at == std::string::npos) {
    ADD_FAILURE() << "'" << before << "' is not in\n" << all;
    return std::nan("");
  }
  return std::stod(all.substr(at + before.size()));
}

inline void expect_written(double value, double expected) {
  EXPECT_NEAR(value, expected, written * std::abs(expected));
}

inline constexpr double texel_m = 16.0 / 512;

inline Settings constant_m(double metres, LightChoice kind = LightChoice::directional) {
  Settings s = simple(kind);
  s.bias.unit = BiasUnit::m;
  s.bias["constant"] = metres;
  return s;
}

// The picture's frustum of these settings: half its diagonal at one metre, and the farthest that is in view.
struct Frustum {
  double half_diagonal, farthest_m;
};

inline Frustum frustum(const Settings& settings) {
  const Case c = make(settings);
  const Camera camera = effective_camera(c.scene, settings.view);
  const double tangent = std::tan(camera.fov_y_deg * std::numbers::pi / 360);
  const double aspect = static_cast<double>(settings.view.width_px) / settings.view.height_px;
  return {tangent * std::sqrt(1 + aspect * aspect), farthest_in_view_m(settings, c.scene)};
}

// The width of Filament's and Godot's map without its border: a sphere about the middle of the frustum's corners.
inline double middle_sphere_m(const Frustum& seen, double far_m) {
  return 2 * std::sqrt(far_m * far_m / 4 + seen.half_diagonal * seen.half_diagonal * far_m * far_m);
}

}  // namespace noonmark::test
