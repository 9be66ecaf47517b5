// From which distance two surfaces count as two: the documents say two float steps of the coordinate along their normal.
#include "raytrace/vertex_rounding.h"

#include <gtest/gtest.h>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// A plate that hovers over a floor by some float steps. Heights at the lower end of floats of one exponent, so that a
// float's step is 2^-23 of them.
Scene hovering(float floor_m, int steps) {
  Scene scene;
  const float plate_m = floor_m + static_cast<float>(steps) * floor_m * 0x1p-23f;
  add_quad(scene, "floor", {-2, floor_m, -2}, {0, 0, 4}, {4, 0, 0});
  add_quad(scene, "plate", {-1, plate_m, -1}, {0, 0, 2}, {2, 0, 0});
  scene.light = {.position_m = {1, floor_m + 4.0, 0.5}, .target_m = {0, floor_m, 0}};
  return scene;
}

// The share of the floor below the plate that is dark.
double dark_below(const Scene& scene) {
  const LightFrame frame = frame_of(scene);
  std::vector<Placed> points;
  for (int i = 0; i < 100; ++i) {
    const double x = -0.9 + 0.018 * i, z = -0.8 + 0.016 * (i * 37 % 100);
    points.push_back({{x, scene.positions[scene.triangles[0].x].y, z}, x > z ? 1u : 0u});
  }
  const ReceiverImage receivers = receivers_at(scene, points, frame.direction_to_light(), true);
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, {});
  int dark = 0;
  for (size_t i = 0; i < points.size(); ++i) dark += !truth.lit[i];
  return dark / 100.0;
}

TEST(VertexRounding, SurfacesWithinTwoFloatStepsAreOne) {
  for (const float height : {8.f, 1024.f}) {
    EXPECT_EQ(dark_below(hovering(height, 1)), 0) << height;
    EXPECT_EQ(dark_below(hovering(height, 2)), 0) << height;
    EXPECT_EQ(dark_below(hovering(height, 3)), 1) << height;
    EXPECT_TRUE(may_be_one_plane(hovering(height, 2), 0, 2)) << height;
    EXPECT_FALSE(may_be_one_plane(hovering(height, 3), 0, 2)) << height;
  }
}

}  // namespace
}  // namespace noonmark::raytrace
