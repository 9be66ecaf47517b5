// Flicker as it is measured, under the conditions of law 33: the texel grid lies fixed in the world, the map's extent does
// not depend on the camera, depths are rounded alike in every frame, and the kernel does not turn with the pixel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/measured.h"
#include "tests/support/temporary_folder.h"

namespace noonmark::acceptance {
namespace {

// A walk with a turn that obeys all four conditions.
Settings steady() {
  return with({{"map.fit", "sphere"},
               {"map.reach_m", "25"},
               {"map.extent_scale", "1.1"},  // room for the kernel at the edge of the picture
               {"map.snap", "true"},
               {"map.depth_range", "scene"},
               {"map.resolution", "251"},
               {"map.format", "16"},
               {"filter.kind", "vogel"},
               {"motion.move_m", "-0.013,0.003,-0.011"},
               {"motion.turn_deg", "0.05,0.31,0.02"}},
              small("cube-room", 64, 36));
}

struct Sums {
  double flicker = 0, grid = 0, depth = 0, kernel = 0, coverage = 0, changed = 0, error = 0;
  double least_points = 1e9;
};

Sums over_frames(Workbench& bench, Settings settings, int frames) {
  Sums sums;
  for (int frame = 0; frame < frames; ++frame) {
    settings.view.motion.frame = frame;
    const Measurement m = bench.measure(settings, std::nullopt);
    sums.flicker += metric(m, "flicker");
    sums.grid += metric(m, "flicker_grid");
    sums.depth += metric(m, "flicker_depth");
    sums.kernel += metric(m, "flicker_kernel");
    sums.coverage += metric(m, "flicker_coverage");
    sums.changed += metric(m, "flicker_changed");
    sums.error += metric(m, "error");
    sums.least_points = std::min(sums.least_points, metric(m, "flicker_points"));
    EXPECT_EQ(metric(m, "flicker_truth"), 0) << frame;  // the light is still
  }
  return sums;
}

// Half of the lit pixels have acne: their verdicts hang on the last bit of a depth, so they show any change of rounding.
TEST(Motion, SnappedMapsDoNotFlicker) {
  Workbench bench(gl::DebugMode::fatal);
  const Sums sums = over_frames(bench, steady(), 200);
  EXPECT_EQ(sums.flicker, 0);
  EXPECT_EQ(sums.changed, 0);
  EXPECT_GT(
      sums.error,
      0.1 * 200);  // more than a tenth of the receivers are wrong in each frame, so there is error that could flicker
  EXPECT_GT(sums.least_points, 500);  // of 2304 pixels
}

// Four cascades in a street of 80 m: what keeps its cascade does not flicker (law 33), and a point of the world that goes
// from one cascade to another is of a class of its own.
Settings street() {
  return with({{"cascades.count", "4"},
               {"map.reach_m", "80"},
               {"view.near_m", "0.1"},  // a plane that is fitted anew in each frame moves the splits
               {"bias.unit", "texel"},
               {"filter.kind", "box"},
               {"motion.move_m", "0.002,0,-0.4"},
               {"motion.turn_deg", "0,0.7,0"}},
              with({{"scene.name", "street"}}, steady()));
}

TEST(Motion, SnappedCascadesFlickerOnlyWhereTheCascadeChanges) {
  Workbench bench(gl::DebugMode::fatal);
  double cascade = 0;
  Settings settings = street();
  for (int frame = 0; frame < 60; ++frame) {
    settings.view.motion.frame = frame;
    const Measurement m = bench.measure(settings, std::nullopt);
    EXPECT_EQ(metric(m, "flicker_grid"), 0) << frame;
    EXPECT_EQ(metric(m, "flicker_depth"), 0) << frame;
    EXPECT_EQ(metric(m, "flicker_kernel"), 0) << frame;
    EXPECT_EQ(metric(m, "flicker_coverage"), 0) << frame;
    EXPECT_EQ(metric(m, "cascade_choice_excess"), 0) << frame;
    EXPECT_GT(metric(m, "flicker_points"), 500) << frame;
    cascade += metric(m, "flicker_cascade");
  }
  EXPECT_GT(cascade, 0) << "no point changed its cascade in sight";
}

// A walk, a turn and a zoom to more than twice the size at once, over 200 frames. The maps are fitted to the widest angle.
TEST(Motion, SnappedCascadesOfOneAngleDoNotFlickerUnderAZoom) {
  Workbench bench(gl::DebugMode::fatal);
  Settings settings = with({{"view.fov_deg", "60"},
                            {"map.fit_fov_deg", "60"},
                            {"cascades.blend", "0.1"},
                            {"motion.move_m", "0.002,0,-0.1"},
                            {"motion.turn_deg", "0,0.2,0"},
                            {"motion.zoom", "1.004"}},
                           street());
  double cascade = 0;
  for (int frame = 0; frame < 200; ++frame) {
    settings.view.motion.frame = frame;
    const Measurement m = bench.measure(settings, std::nullopt);
    for (const char* part : {"flicker_grid", "flicker_depth", "flicker_kernel", "flicker_coverage"})
      EXPECT_EQ(metric(m, part), 0) << part << " " << frame;
    EXPECT_LE(metric(m, "cascade_choice_excess"), 1) << frame;
    EXPECT_GT(metric(m, "flicker_points"), 500) << frame;
    cascade += metric(m, "flicker_cascade");
  }
  EXPECT_GT(cascade, 0) << "no point changed its cascade in sight";
  // Fitted to each frame's own angle the maps shrink from frame to frame.
  settings = with({{"map.fit_fov_deg", "auto"}, {"motion.frame", "0"}}, settings);
  EXPECT_GT(metric(bench.measure(settings, std::nullopt), "flicker_grid"), 0);
}

TEST(Motion, CascadesThatAreNotSnappedFlickerByTheirGrids) {
  Workbench bench(gl::DebugMode::fatal);
  double grid = 0, depth = 0;
  for (int frame = 0; frame < 5; ++frame) {
    Settings settings = with({{"map.snap", "false"}, {"motion.frame", std::to_string(frame)}}, street());
    grid += metric(bench.measure(settings, std::nullopt), "flicker_grid");
    settings = with({{"map.depth_range", "fit"}, {"motion.frame", std::to_string(frame)}}, street());
    depth += metric(bench.measure(settings, std::nullopt), "flicker_depth");
  }
  EXPECT_GT(grid, 0);
  EXPECT_GT(depth, 0);
}

TEST(Motion, EachBrokenConditionBringsItsOwnClassAlone) {
  Workbench bench(gl::DebugMode::fatal);
  constexpr int frames = 10;
  // Receivers stand at the middle of their pixels, so a pixel changes where a frame turns by more than half of one.
  const Settings faster = with({{"motion.turn_deg", "0.05,1.3,0.02"}}, steady());
  for (const char* broken : {"map.snap=false", "map.fit=view", "map.depth_range=fit", "filter.rotate=true"}) {
    const std::string text = broken;
    const size_t equals = text.find('=');
    const Sums sums = over_frames(bench, with({{text.substr(0, equals), text.substr(equals + 1)}}, faster), frames);
    const bool depth = text.starts_with("map.depth_range"), kernel = text.starts_with("filter");
    EXPECT_GT(sums.flicker, 0) << broken;
    EXPECT_EQ(sums.grid, depth || kernel ? 0 : sums.flicker) << broken;
    EXPECT_EQ(sums.depth, depth ? sums.flicker : 0) << broken;
    EXPECT_EQ(sums.kernel, kernel ? sums.flicker : 0) << broken;
    EXPECT_EQ(sums.coverage, 0) << broken;
  }
}

// A texel of a level of a map of moments is a block of texels of the map, and the map moves by whole blocks.
TEST(Motion, OfALevelOfAMapOfMomentsKeepsItsGridAndDepths) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings level = with({{"lookup.kind", "vsm"},
                               {"filter.kind", "box"},
                               {"filter.size", "3"},
                               {"lookup.level", "2"},
                               {"map.resolution", "252"}},
                              steady());
  const Sums sums = over_frames(bench, level, 10);
  // A fetch's place is a float from 0 to 1, whose rounding is another one at another place of the same grid.
  EXPECT_LE(sums.grid, 0x1p-24);
  EXPECT_EQ(sums.depth, 0);
  EXPECT_GT(over_frames(bench, with({{"map.snap", "false"}}, level), 10).grid, 0x1p-14);
}

// A camera that zooms changes the extent: the grid's class alone.
TEST(Motion, AZoomMovesTheGrid) {
  Workbench bench(gl::DebugMode::fatal);
  const Sums zoom = over_frames(bench, with({{"motion.zoom", "1.01"}}, steady()), 5);
  EXPECT_GT(zoom.grid, 0);
  EXPECT_EQ(zoom.grid, zoom.flicker);
}

// The edge of a snapped map moves with the camera. Points that it passes are a class of their own.
TEST(Motion, TheEdgeOfTheMapIsAClassOfItsOwn) {
  Workbench bench(gl::DebugMode::fatal);
  const Sums sums = over_frames(bench, with({{"map.reach_m", "9"}, {"map.extent_scale", "1"}}, steady()), 10);
  EXPECT_GT(sums.coverage, 0);
  EXPECT_EQ(sums.coverage, sums.flicker);
}

// A sampler takes its place as a fraction of the map, which is exact if the texels are a power of two.
TEST(Motion, BlendingFiltersDoNotFlickerWithAPowerOfTwo) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* filter : {"hardware", "gaussian"}) {
    const Settings settings = with({{"filter.kind", filter}, {"map.resolution", "256"}}, steady());
    EXPECT_EQ(over_frames(bench, settings, 8).changed, 0) << filter;
  }
}

// An edge along the texels, unfiltered: it shows at the border of a texel, at any place of it by chance. If the grid moves
// by the part s of a texel across it, the border stays on the same side with probability 1 - s and moves by s texels, or
// it jumps back by 1 - s: 2 s (1 - s) texels on average over the alignments. Each frame moves the grid by the golden
// section of a texel, so that few frames have all alignments.
TEST(Motion, AnUnsnappedEdgeFlickersByItsClosedForm) {
  Workbench bench(gl::DebugMode::fatal);
  Settings settings = with({{"scene.height_m", "1.5"},
                            {"light.position_m", "-3,3,0"},  // the texels' rows lie along Z
                            {"view.eye_m", "0.7,8,-0.5"},
                            {"view.target_m", "0.7,0,-0.5"},
                            {"view.up", "0,0,-1"},
                            {"view.fov_deg", "30"},
                            {"map.fit", "sphere"},
                            {"map.reach_m", "8.5"},
                            {"map.resolution", "80"},
                            {"bias.unit", "texel"},
                            {"bias.constant", "1.5"}},
                           small("plate", 160, 160));
  const double texel = metric(bench.measure(settings, std::nullopt), "texel_m");
  const double s = (3 - std::sqrt(5.0)) / 2;
  settings.view.motion.move_m = glm::dvec3(0, 0, s * texel);
  const double pixel = 2 * 8 * std::tan(15 * std::numbers::pi / 180) / 160;
  ASSERT_GT(texel / pixel, 4);  // fine enough to see parts of a texel
  double changed = 0, edge = 0;
  constexpr int frames = 34;  // a Fibonacci number: the alignments are spread evenly
  for (int frame = 0; frame < frames; ++frame) {
    settings.view.motion.frame = frame;
    const Measurement m = bench.measure(settings, std::nullopt);
    EXPECT_EQ(metric(m, "flicker_grid"), metric(m, "flicker"));
    changed += metric(m, "flicker") * metric(m, "flicker_points");
    const Image<float>& truth = m.ladder.truth();
    const auto on_floor = [&](int x, int y) {
      return m.flicker->points.counted.at(x, y) && std::abs(m.receivers.position.at(x, y).y) < 1e-4f;
    };
    for (int y = 1; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x)
        edge += on_floor(x, y) && on_floor(x, y - 1) && truth.at(x, y) != truth.at(x, y - 1);
  }
  // The ends of the two edges, where they meet the ones across, and pixels at the plate: a twentieth of their length.
  EXPECT_NEAR(changed / (edge * texel / pixel), 2 * s * (1 - s), 0.05 * 2 * s * (1 - s));
}

// A glTF file whose animation moves the camera: frames are times. Its floor stands still; a mesh that moves is refused.
void write_moving_camera(const std::string& folder, bool moves_mesh) {
  const float numbers[] = {-5, 0, -5,   0,    0, 5,   5, 0, -5,  // the floor's corners, seen from above
                           -1, 1, -1,   0,    1, 1,   1, 1, -1,  // a caster above it
                           0,  2,                                // seconds
                           0,  6, 0.5f, 0.8f, 6, 0.5f};          // where the node is then
  std::ofstream(folder + "/moving.bin", std::ios::binary).write(reinterpret_cast<const char*>(numbers), sizeof numbers);
  std::ofstream(folder + "/moving.gltf") << fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1, 2]}}],
"nodes": [{{"mesh": 0}}, {{"mesh": 1}}, {{"camera": 0, "translation": [0, 6, 0.5], "rotation": [-0.7071068, 0, 0, 0.7071068]}}],
"cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.9, "znear": 0.1, "zfar": 20}}}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}, {{"primitives": [{{"attributes": {{"POSITION": 1}}}}]}}],
"animations": [{{"samplers": [{{"input": 2, "output": 3}}], "channels": [{{"sampler": 0, "target": {{"node": {0}, "path": "translation"}}}}]}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-5, 0, -5], "max": [5, 0, 5]}},
{{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, 1, -1], "max": [1, 1, 1]}},
{{"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]}},
{{"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 36}},
{{"buffer": 0, "byteOffset": 72, "byteLength": 8}}, {{"buffer": 0, "byteOffset": 80, "byteLength": 24}}],
"buffers": [{{"uri": "moving.bin", "byteLength": 104}}]}})",
      moves_mesh ? 1 : 2);
}

TEST(Motion, FollowsTheCameraOfAnAnimation) {
  Workbench bench(gl::DebugMode::fatal);
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  write_moving_camera(folder, false);
  Settings settings = with({{"scene.time_s", "0.5"},
                            {"motion.time_s", "0.25"},
                            {"light.azimuth_deg", "40"},
                            {"light.elevation_deg", "50"},
                            {"map.fit", "sphere"},
                            {"map.reach_m", "9"},
                            {"map.extent_scale", "1.1"},
                            {"map.resolution", "128"}},
                           small(folder + "/moving.gltf", 64, 36));
  const Measurement loose = bench.measure(settings, std::nullopt);
  EXPECT_GT(metric(loose, "flicker_points"), 500);
  EXPECT_GT(metric(loose, "flicker"), 0);
  EXPECT_NEAR(loose.camera.eye_m.x, 0.2, 1e-6);
  settings.map.snap = true;
  settings.map.depth_range = DepthRange::scene;
  EXPECT_EQ(metric(bench.measure(settings, std::nullopt), "flicker"), 0);

  write_moving_camera(folder, true);
  Workbench again(gl::DebugMode::fatal);
  expect_refused(ErrorKind::usage, {"motion.time_s"}, [&] { again.measure(settings, std::nullopt); });
}

// A room of single-sided faces that are seen from inside, 4 x 3 x 4 m, with a box in it that is seen from outside.
void write_room(const std::string& folder) {
  std::vector<float> corners;
  const auto add_box = [&](glm::vec3 low, glm::vec3 high) {
    for (int i = 0; i < 8; ++i)
      for (int axis = 0; axis < 3; ++axis) corners.push_back(i >> axis & 1 ? high[axis] : low[axis]);
  };
  add_box({-2, 0, -2}, {2, 3, 2});
  add_box({-0.5f, 0.2f, -0.5f}, {0.5f, 1.2f, 0.5f});
  std::vector<uint16_t> indices;
  for (const bool inward : {true, false})
    for (const auto& [a, b, c, d] : std::vector<std::array<uint16_t, 4>>{
             {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
      for (const uint16_t corner : {a, b, c, a, c, d})
        indices.push_back(static_cast<uint16_t>(corner + (inward ? 0 : 8)));
  for (size_t i = 0; i < 36; i += 3) std::swap(indices[i + 1], indices[i + 2]);
  std::ofstream file(folder + "/room.bin", std::ios::binary);
  file.write(reinterpret_cast<const char*>(corners.data()), static_cast<std::streamsize>(corners.size() * 4));
  file.write(reinterpret_cast<const char*>(indices.data()), static_cast<std::streamsize>(indices.size() * 2));
  std::ofstream(folder + "/room.gltf")
      << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 16, "type": "VEC3", "min": [-2, 0, -2], "max": [2, 3, 2]},
{"bufferView": 1, "componentType": 5123, "count": 72, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 192}, {"buffer": 0, "byteOffset": 192, "byteLength": 144}],
"buffers": [{"uri": "room.bin", "byteLength": 336}]})";
}

// The camera stands outside a room, sees through the backs of its nearest faces, and enlarges its picture a little. So
// the next frame sees every point that stays in the picture.
TEST(Motion, SeesThroughTheBacksOfSingleSidedFaces) {
  Workbench bench(gl::DebugMode::fatal);
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  write_room(folder);
  const Settings settings = with({{"view.eye_m", "1,5,9"},
                                  {"view.target_m", "0,1,0"},
                                  {"light.kind", "point"},
                                  {"light.position_m", "0.3,2.5,0.4"},
                                  {"map.resolution", "64"},
                                  {"motion.zoom", "1.0001"}},
                                 small(folder + "/room.gltf", 128, 72));
  const Measurement m = bench.measure(settings, std::nullopt);
  ASSERT_GT(metric(m, "counted"), 300);
  EXPECT_GT(metric(m, "flicker_points"), 0.99 * metric(m, "counted"));
  EXPECT_LT(metric(m, "flicker_hidden"),
            0.01 * metric(m, "counted"));  // at the edges of the box, where rounding decides
}

// What the near plane cuts off hides nothing in either frame.
TEST(Motion, SeesThroughWhatTheNearPlaneCutsOff) {
  Workbench bench(gl::DebugMode::fatal);
  Settings settings = with({{"view.eye_m", "0,1.5,4.5"},
                            {"view.target_m", "0,1,0"},
                            {"view.near_m", "0.1"},
                            {"map.resolution", "64"},
                            {"motion.zoom", "1.0001"}},
                           small("cube-room", 64, 36));
  const double with_the_turned_cube = metric(bench.measure(settings, std::nullopt), "counted");
  settings.view.near_m = 3.2;
  const Measurement m = bench.measure(settings, std::nullopt);
  ASSERT_NE(metric(m, "counted"), with_the_turned_cube) << "the near plane cuts nothing off";
  ASSERT_GT(metric(m, "counted"), 300);
  EXPECT_GT(metric(m, "flicker_points"), 0.99 * metric(m, "counted"));
}

}  // namespace
}  // namespace noonmark::acceptance
