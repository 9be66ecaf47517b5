// map.fit = view and casters as they are measured: no receiver of the picture has a coverage error.
#include <gtest/gtest.h>

#include "scenes/builtin.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

TEST(ViewFitMeasured, NoReceiverHasACoverageError) {
  Workbench bench(gl::DebugMode::fatal);
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const std::string name(builtin.name);
    Settings settings = small(name, 240, 136);
    const Scene& scene = bench.scene(settings.scene);
    if (scene.light.kind != LightKind::directional) continue;
    settings.map.fit = MapFit::view;
    // The scene's own camera, and one that sees a part of the scene only.
    const glm::dvec3 eye = scene.camera.eye_m, target = scene.camera.target_m;
    for (double nearer : {0.0, 0.6}) {
      settings.view.eye_m = eye + nearer * (target - eye);
      const Measurement m = bench.measure(settings, std::nullopt);
      EXPECT_EQ(metric(m, "coverage"), 0) << name;
      EXPECT_EQ(metric(m, "outside"), 0) << name;
    }
  }
}

// The map is kept from point to point while its settings stay: of this fit, the camera is one of them.
TEST(ViewFitMeasured, AnotherCameraGetsAnotherMap) {
  Settings near = small("cube-room", 160, 90);
  near.map.fit = MapFit::view;
  near.map.resolution = 64;
  Settings far = near;
  near.view.eye_m = glm::dvec3(1, 2, 2);
  far.view.eye_m = glm::dvec3(4, 8, 9);
  Workbench shared(gl::DebugMode::fatal), fresh(gl::DebugMode::fatal);
  shared.measure(far, std::nullopt);
  const auto again = shared.measure(near, std::nullopt).record.metrics,
             alone = fresh.measure(near, std::nullopt).record.metrics;
  for (const char* name : {"error", "acne", "residual", "tap_residual", "precision"})
    EXPECT_EQ(again.at(name), alone.at(name)) << name;
}

// Outside of the map there are receivers, and all of them are lit in truth.
TEST(CasterFitMeasured, NoReceiverHasACoverageError) {
  Workbench bench(gl::DebugMode::fatal);
  double most_outside = 0;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const std::string name(builtin.name);
    Settings settings = small(name, 240, 136);
    if (bench.scene(settings.scene).light.kind != LightKind::directional) continue;
    settings.map.fit = MapFit::casters;
    settings.map.resolution = 64;
    // Also where the grid moves by up to a texel: by placements, or by snapping.
    for (const double shift : {0.0, -1.0, 0.5, 1.0}) {
      settings.map.shift_u_texels = settings.map.shift_v_texels = shift;
      const Measurement m = bench.measure(settings, std::nullopt);
      EXPECT_EQ(metric(m, "coverage"), 0) << name << ", moved by " << shift << " texels";
      most_outside = std::max(most_outside, metric(m, "outside"));
    }
    settings.map.shift_u_texels = settings.map.shift_v_texels = 0;
    settings.map.snap = true;
    EXPECT_EQ(metric(bench.measure(settings, std::nullopt), "coverage"), 0) << name << ", snapped";
  }
  EXPECT_GT(most_outside, 0.5);
}

}  // namespace
}  // namespace noonmark::acceptance
