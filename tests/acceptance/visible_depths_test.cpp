// Cascades between the depths that the picture shows (sample distribution shadow maps).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "scenes/camera_frame.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

// A camera that looks across a street at houses, which hide what lies behind them: the planes reach over that too.
Settings across_the_street(const std::vector<Assignment>& more = {}) {
  return with(
      more,
      with({{"view.eye_m", "0,1.6,-20"},
            {"view.target_m", "10,1.6,-22"},
            {"view.up", "0,1,0.25"},  // no row of pixels has one depth, which a near plane there would cut off in part
            {"map.fit", "sphere"},
            {"map.resolution", "128"},
            {"cascades.count", "3"},
            {"cascades.depths", "visible"},
            {"bias.unit", "texel"},
            {"bias.constant", "1.5"}},
           small("street", 160, 90)));
}

std::map<std::string, double> numbers(const Measurement& m) {
  std::map<std::string, double> all;
  for (const auto& [name, value] : m.record.metrics)
    if (!name.ends_with("_ms") && !std::isnan(value)) all[name] = value;
  return all;
}

// The slices lie from the nearest to the farthest receiver, and the point is the one with these depths given.
TEST(VisibleDepths, EqualTheSameDepthsGivenByHand) {
  for (const Assignment& fit : {Assignment{"map.fit", "sphere"}, Assignment{"map.fit", "corner_square"}}) {
    Workbench bench(gl::DebugMode::fatal);
    const Settings s = across_the_street({fit, {"cascades.blend", "0.2"}});
    const Measurement m = bench.measure(s, std::nullopt);
    const CameraFrame camera = make_camera_frame(m.camera, s.view.width_px, s.view.height_px);
    double least = 1e9, most = 0;
    for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
      if (m.receivers.primitive[i] == no_primitive) continue;
      const double depth = camera.in_axes(glm::dvec3(m.receivers.position[i])).z;
      least = std::min(least, depth);
      most = std::max(most, depth);
    }
    EXPECT_EQ(m.record.cascades.front().begin_m, least);
    EXPECT_EQ(m.record.cascades.back().end_m, most);
    const std::map<std::string, double> found = numbers(m);

    const Settings planes = with({{"cascades.depths", "planes"}}, s);
    const Measurement of_planes = bench.measure(planes, std::nullopt);
    EXPECT_GT(of_planes.record.cascades.back().end_m, 1.5 * most) << "the houses hide nothing";
    EXPECT_NE(numbers(of_planes), found);
    const Settings by_hand =
        with({{"view.near_m", fmt::format("{}", least)}, {"map.reach_m", fmt::format("{}", most)}}, planes);
    const std::map<std::string, double> given = numbers(bench.measure(by_hand, std::nullopt));
    ASSERT_EQ(given.at("clipped"), 0) << "the near plane cuts off the nearest pixel: another view.up is needed";
    for (const auto& [name, value] : found) EXPECT_EQ(given.at(name), value) << name;
  }
}

// The reach still ends them, and a bound that the picture cannot hold is refused with what it lies between.
TEST(VisibleDepths, EndAtTheReach) {
  Workbench bench(gl::DebugMode::fatal);
  EXPECT_EQ(bench.measure(across_the_street({{"map.reach_m", "9.5"}}), std::nullopt).record.cascades.back().end_m, 9.5);
  const Settings s = across_the_street({{"cascades.splits", "first_bound"}, {"cascades.first_m", "0.01"}});
  expect_refused(ErrorKind::usage, {"the nearest surface in the picture"}, [&] { bench.measure(s, std::nullopt); });
  EXPECT_THROW(
      bench.measure(across_the_street({{"cascades.splits", "manual"}, {"cascades.bounds_m", "5,9"}}), std::nullopt),
      Error);
}

// A camera that walks on sees other depths in each frame, so that the sizes change and snapping does not help (law 33 (a)). The
// whole flicker has two causes: the grids change, and receivers go to another cascade.
TEST(VisibleDepths, FlickerByTheirSizes) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings s = across_the_street({{"map.snap", "true"},
                                        {"map.depth_range", "scene"},
                                        {"map.resolution", "256"},
                                        {"map.extent_scale", "1.1"},
                                        {"bias.constant", "0"},
                                        {"motion.move_m", "0.05,0,-0.02"}});
  const auto grid_of = [&](const char* depths) {
    double grid = 0;
    for (int frame = 0; frame < 4; ++frame) {
      Settings at = with({{"cascades.depths", depths}, {"motion.frame", std::to_string(frame)}}, s);
      if (at.cascades.depths == CascadeDepths::planes) at.view.near_m = 0.5, at.map.reach_m = 20;
      const Measurement m = bench.measure(at, std::nullopt);
      grid += metric(m, "flicker_grid");
      EXPECT_EQ(metric(m, "flicker_depth"), 0);
      EXPECT_GT(metric(m, "flicker_points"), 500);
      // The next frame's maps are those of its own picture.
      if (frame > 0 || at.cascades.depths == CascadeDepths::planes) continue;
      at.view.motion.frame = 1;
      EXPECT_NE(bench.measure(at, std::nullopt).record.cascades[1].metrics.at("texel_m"),
                m.record.cascades[1].metrics.at("texel_m"));
    }
    return grid;
  };
  EXPECT_EQ(grid_of("planes"), 0);
  EXPECT_GT(grid_of("visible"), 0.001);
}

}  // namespace
}  // namespace noonmark::acceptance
