// The causes of filtered maps in two scenes, compared with those that another program found. That program tests every triangle
// in double precision, uses neither OpenGL nor a ray tracer, and has its own formulas. It leaves out receivers that are less
// than a kernel away from the map's border. No receiver there leaks or is too dark. So the test compares the sums over
// all receivers, not the shares.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scenes/camera_fit.h"
#include "scenes/gltf/write_glb.h"
#include "scenes/shapes.h"
#include "tests/support/measured.h"
#include "tests/support/temporary_folder.h"

namespace noonmark::acceptance {
namespace {

void add_centred_box(Scene& scene, const char* name, glm::dvec3 middle, glm::dvec3 half, double turn_deg = 0) {
  const glm::dmat4 placed = glm::translate(glm::dmat4(1), middle);
  const double turn = turn_deg * std::numbers::pi / 180;
  add_box(scene, name, half, turn == 0 ? placed : glm::rotate(placed, turn, glm::dvec3(1, 0, 0)));
}

Scene floor_alone() {
  Scene scene;
  add_quad(scene, "floor", {-6, 0, -6}, {0, 0, 12}, {12, 0, 0});
  scene.camera = {
      .eye_m = {0, 6, 8}, .target_m = {0, 0, 0}, .fov_y_deg = 45};  // which the tests replace, and the light
  scene.light = {.position_m = {0, 8, 0}, .target_m = {0, 0, 0}};
  return scene;
}

// Two plates one above the other, a wall, a row of posts and a sphere.
Scene overlapping_casters() {
  Scene scene = floor_alone();
  add_centred_box(scene, "plate", {0, 0.4, 0}, {1.2, 0.03, 0.8});
  add_centred_box(scene, "plate", {0.5, 1.2, 0.3}, {1.0, 0.03, 0.5});
  add_centred_box(scene, "wall", {-2.2, 0.75, 0.5}, {0.15, 0.75, 1.0});
  for (int i = 0; i < 9; ++i) add_centred_box(scene, "post", {1.6 + i * 0.18, 0.5, -1.2}, {0.03, 0.5, 0.03});
  add_surface(scene, "sphere", 32, 16, true, [](double s, double t) {
    const double a = 2 * std::numbers::pi * s, b = std::numbers::pi * t, r = t == 0 || t == 1 ? 0 : std::sin(b);
    return 0.4 * glm::dvec3(r * std::cos(a), std::cos(b), r * std::sin(a)) + glm::dvec3(-1, 0.4, -1.6);
  });
  return scene;
}

// A wall that faces the light, and four plates at slopes of 20 to 74 degrees.
Scene lit_creases() {
  Scene scene = floor_alone();
  add_centred_box(scene, "wall", {0, 1, -2}, {3, 1, 0.1});
  for (int i = 0; i < 4; ++i)
    add_centred_box(scene, "plate", {-2.1 + 1.4 * i, 0.8, 0.6}, {0.55, 0.02, 0.6}, 20 + 18 * i);
  return scene;
}

struct Figures {
  const char* name;
  std::vector<Assignment> lookup;
  double leak, over_darkening, peter_panning, reduction;  // in percent of the independent ladder's receivers
};

struct View {
  Scene scene;
  double receivers;  // that the independent ladder counts
  std::vector<Assignment> settings;
};

void expect_figures(const View& view, std::initializer_list<Figures> all) {
  const TemporaryFolder folder;
  const Camera camera = effective_camera(view.scene, {});
  const Settings base = with({{"scene.name", folder.write("scene.glb", glb_of(view.scene, camera, view.scene.light))},
                              {"view.width_px", "240"},
                              {"view.height_px", "180"},
                              {"view.projection", "orthographic"},
                              {"view.height_m", "4.8"},
                              {"view.up", "0,1,0"},  // and not those of the file's camera
                              {"view.near_m", "1"},
                              {"view.far_m", "40"},
                              {"light.kind", "directional"},
                              {"light.target_m", "0,0.3,0"},
                              {"map.resolution", "256"},
                              {"map.extent_m", "10"},
                              {"map.roll_deg", "20"},
                              {"map.shift_u_texels", "0.37"},
                              {"map.shift_v_texels", "0.21"},
                              {"map.format", "32f"},
                              {"filter.kind", "box"},
                              {"filter.size", "5"},
                              {"bias.unit", "m"},
                              {"bias.constant", "0"}},
                             with(view.settings));
  Workbench bench(gl::DebugMode::fatal);
  for (const Figures& figures : all) {
    const Measurement m = bench.measure(with(figures.lookup, base), std::nullopt);
    const auto expect = [&](const char* name, double percent) {
      // A hundredth: pixels at edges, which fall to another side in floats, and the last digit of the numbers.
      EXPECT_NEAR(metric(m, name) * metric(m, "counted"), percent / 100 * view.receivers,
                  0.01 * percent / 100 * view.receivers + 0.1)
          << figures.name << ' ' << name;
    };
    expect("leak", figures.leak);
    expect("over_darkening", figures.over_darkening);
    expect("peter_panning", figures.peter_panning);
    expect("reduction", figures.reduction);
  }
}

const std::vector<Assignment> exponential = {
    {"lookup.kind", "evsm4"}, {"lookup.exponent", "40"}, {"lookup.negative_exponent", "5"}, {"lookup.floor", "1e-4"}};
const std::vector<Assignment> four_moments = {
    {"lookup.kind", "msm"}, {"lookup.moment_bias", "3e-7"}, {"bias.constant", "0.01171875"}};  // 0.3 texels
const std::vector<Assignment> biased_moments = {{"lookup.kind", "msm"}, {"lookup.moment_bias", "6e-5"}};
const std::vector<Assignment> variance = {{"lookup.kind", "vsm"}, {"lookup.v_min", "0"}};
const std::vector<Assignment> reduced = {{"lookup.kind", "vsm"}, {"lookup.v_min", "1e-6"}, {"lookup.reduction", "0.2"}};
const std::vector<Assignment> one_exponential = {{"lookup.kind", "esm"}, {"lookup.exponent", "40"}};

TEST(MomentFigures, OfOverlappingCastersAreThoseOfAnIndependentLadder) {
  expect_figures({overlapping_casters(),
                  40156,
                  {{"view.eye_m", "3.59550841996,7.99026824325,8.38951964657"},
                   {"view.target_m", "0,0.2,0"},
                   {"light.position_m", "-8.57142857143,17.4428571429,-5.71428571429"},
                   {"map.near_m", "15.9714285714"},
                   {"map.far_m", "24.5428571429"}}},
                 {{"vsm", variance, 0.2042, 0.0229, 0, 0},
                  {"vsm reduced", reduced, 0.0063, 0.0229, 0, 0.5502},
                  {"esm", one_exponential, 0.4768, 0.0165, 0, 0},
                  {"evsm4", exponential, 0.0734, 0.1218, 0.0001, 0},
                  {"msm", four_moments, 0.0278, 0.2092, 0.0644, 0},
                  {"msm biased", biased_moments, 0.0278, 0.0884, 0.1075, 0}});
}

TEST(MomentFigures, OfLitCreasesAreThoseOfAnIndependentLadder) {
  expect_figures({lit_creases(),
                  42669,
                  {{"view.eye_m", "-2.52282398989,7.4377659722,8.9605899621"},
                   {"view.target_m", "0,0.5,-0.5"},
                   {"light.position_m", "2.32670020299,15.8113346866,12.4090677493"},
                   {"map.near_m", "15.8119396346"},
                   {"map.far_m", "24.653400406"}}},
                 {{"vsm", variance, 0.0141, 0.7621, 0, 0},
                  {"vsm reduced", reduced, 0.0007, 0.7621, 0, 0.5235},
                  {"esm", one_exponential, 0.1349, 0.2361, 0, 0},
                  {"evsm4", exponential, 0.0056, 1.0401, 0, 0},
                  {"msm", four_moments, 0.0012, 3.0953, 0.0158, 0},
                  {"msm biased", biased_moments, 0.0012, 0.8218, 0.0256, 0}});
}

}  // namespace
}  // namespace noonmark::acceptance
