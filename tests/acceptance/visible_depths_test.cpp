// Cascades between the depths that the picture shows (sample distribution shadow maps).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "scenes/camera_frame.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

// A camera before a wall that hides most of the floor behind it: the planes reach over all of the floor.
Settings before_the_wall(const std::vector<Assignment>& more = {}) {
  return with(more, with({{"view.eye_m", "0.3,1.2,4"},
                          {"view.target_m", "0,0.9,0"},
                          {"map.fit", "sphere"},
                          {"map.resolution", "128"},
                          {"cascades.count", "3"},
                          {"cascades.depths", "visible"},
                          {"bias.unit", "texel"},
                          {"bias.constant", "1.5"}},
                         small("wall", 160, 90)));
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
    const Settings s = before_the_wall({fit, {"cascades.blend", "0.2"}});
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
    EXPECT_GT(of_planes.record.cascades.back().end_m, 1.2 * most) << "the wall hides nothing";
    EXPECT_GT(of_planes.record.cascades.back().metrics.at("texel_m"), 0);
    EXPECT_NE(numbers(of_planes), found);
    const Settings by_hand =
        with({{"view.near_m", fmt::format("{}", least)}, {"map.reach_m", fmt::format("{}", most)}}, planes);
    EXPECT_EQ(numbers(bench.measure(by_hand, std::nullopt)), found);
  }
}

// The reach still ends them, and a bound that the picture cannot hold is refused with what it lies between.
TEST(VisibleDepths, EndAtTheReach) {
  Workbench bench(gl::DebugMode::fatal);
  EXPECT_EQ(bench.measure(before_the_wall({{"map.reach_m", "3.9"}}), std::nullopt).record.cascades.back().end_m, 3.9);
  const Settings s = before_the_wall({{"cascades.splits", "first_bound"}, {"cascades.first_m", "0.01"}});
  try {
    bench.measure(s, std::nullopt);
    ADD_FAILURE() << "it is not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the nearest surface in the picture"), std::string::npos) << error.what();
  }
  EXPECT_THROW(bench.measure(before_the_wall({{"cascades.splits", "manual"}, {"cascades.bounds_m", "3.5,4"}}),
                             std::nullopt),
               Error);
}

// A camera that walks on sees other depths in each frame, so that the sizes change and snapping does not help (law 33 (a)). All
// of the change is that of the grids, and of receivers that go to another cascade.
TEST(VisibleDepths, FlickerByTheirSizes) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings s = before_the_wall({{"map.snap", "true"},
                                      {"map.depth_range", "scene"},
                                      {"map.resolution", "256"},
                                      {"map.extent_scale", "1.1"},
                                      {"bias.constant", "0"},
                                      {"motion.move_m", "0.01,0,-0.05"}});
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
