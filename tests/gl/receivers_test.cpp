// The receiver pass against results that are worked out by hand.
#include "scenes/receivers.h"

#include <algorithm>
#include <cmath>

#include "scenes/builtin.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

// Four unit quads with gaps, one for each quarter of the picture, seen from above.
Scene four_quads() {
  Scene scene;
  const auto add = [&](double x, double z) { add_quad(scene, "quad", {x - 0.5, 0, z + 0.5}, {1, 0, 0}, {0, 0, -1}); };
  add(-1, -1);  // top left: up is -Z
  add(1, -1);   // top right
  add(-1, 1);   // bottom left
  add(1, 1);    // bottom right
  return scene;
}

TEST_F(GlTest, PrimitivesAtKnownPixelsTopRowFirst) {
  renderer.load_scene(four_quads());
  // 4 m for 40 rows: 10 pixels a metre; 60 columns: 6 m. Quads cover columns 15-24 and 35-44, rows 5-14 and 25-34.
  const Image<uint32_t> image = renderer.render_primitives(camera_from_above(4), 60, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      const bool left = x >= 15 && x < 25, right = x >= 35 && x < 45, top = y >= 5 && y < 15,
                 bottom = y >= 25 && y < 35;
      uint32_t quad = no_primitive;
      if (top && left) quad = 0;
      if (top && right) quad = 1;
      if (bottom && left) quad = 2;
      if (bottom && right) quad = 3;
      const uint32_t seen = image.at(x, y) == no_primitive ? no_primitive : image.at(x, y) / 2;
      ASSERT_EQ(seen, quad) << "at pixel " << x << ", " << y;
    }
}

TEST_F(GlTest, BothSidesAreSeenAndTheNearestWins) {
  Scene scene;
  add_floor(scene, 0, 2);                                        // triangles 0 and 1, towards the camera
  add_quad(scene, "lid", {-2, 1, -2}, {2, 0, 0}, {0, 0, 4});     // 2 and 3: x < 0, away from the camera
  add_quad(scene, "below", {-2, -1, 2}, {4, 0, 0}, {0, 0, -4});  // 4 and 5: hidden
  renderer.load_scene(scene);
  const Image<uint32_t> image = renderer.render_primitives(camera_from_above(3), 30, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) ASSERT_EQ(image.at(x, y) / 2, x < 15 ? 1u : 0u) << x << ", " << y;
}

// The rasteriser snaps vertices to 1/256 of a pixel (OpenGL asks for 1/16), so an edge may move by that in x and y. A
// pixel whose centre is within twice this distance of an edge is not compared; every other pixel must be right.
constexpr double snapping_px = 2.0 / 256;

TEST_F(GlTest, PerspectivePrimitivesMeetTheirPixelsRay) {
  Scene scene;
  add_box(scene, "box", {-1, 0, -1}, {1, 1.5, 1});
  add_floor(scene, -0.5, 6);
  renderer.load_scene(scene);
  Camera camera;
  camera.eye_m = {4, 3, 6};
  camera.fov_y_deg = 50;
  camera.near_m = 0.1;
  camera.far_m = 100;
  const int width = 160, height = 90;
  const Image<uint32_t> image = renderer.render_primitives(camera, width, height);
  const CameraFrame frame = make_camera_frame(camera, width, height);
  const glm::dmat4 clip = frame.clip_from_world();
  int compared = 0, seen = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 centre(x + 0.5, y + 0.5);
      uint32_t best = no_primitive;
      double best_depth = INFINITY;
      bool near_edge = false;
      for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
        glm::dvec2 p[3];
        double w[3];
        for (int k = 0; k < 3; ++k) {
          const glm::dvec4 c = clip * glm::dvec4(glm::dvec3(scene.positions[scene.triangles[t][k]]), 1);
          ASSERT_GT(c.w, 0) << "the test's scene must lie in front of the camera";
          p[k] = {(c.x / c.w * 0.5 + 0.5) * width, (0.5 - c.y / c.w * 0.5) * height};
          w[k] = c.w;
        }
        const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
        const double area = cross(p[1] - p[0], p[2] - p[0]);
        double inside[3], one_over_w = 0;
        bool in = true;
        for (int k = 0; k < 3; ++k) {
          const glm::dvec2 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
          inside[k] = cross(b - a, centre - a) / area;
          const double distance = inside[k] * std::abs(area) / glm::length(b - a);
          near_edge |= std::abs(distance) < 2 * snapping_px;
          in &= inside[k] > 0;
          one_over_w += inside[k] / w[k];
        }
        if (in && 1 / one_over_w < best_depth) {
          best_depth = 1 / one_over_w;
          best = t;
        }
      }
      if (near_edge) continue;
      ++compared;
      seen += best != no_primitive;
      ASSERT_EQ(image.at(x, y), best) << "at pixel " << x << ", " << y;
    }
  EXPECT_GT(compared, width * height * 9 / 10);
  EXPECT_GT(seen, width * height / 4);
  EXPECT_LT(seen, compared) << "there must be some background too";
}

TEST_F(GlTest, AnEmptySceneIsBackground) {
  renderer.load_scene(Scene{});
  for (uint32_t p : renderer.render_primitives(camera_from_above(1), 8, 8).pixels) ASSERT_EQ(p, no_primitive);
}

TEST_F(GlTest, AnImpossiblePictureIsAUsageError) {
  std::string message;
  EXPECT_EQ(kind_thrown([&] { renderer.render_primitives(camera_from_above(1), 1 << 20, 4); }, &message),
            static_cast<int>(ErrorKind::usage));
  EXPECT_NE(message.find(std::to_string(renderer.info().max_map_resolution)), std::string::npos) << message;
}

// A pixel where the picture changes from one primitive to another. A GPU may clip with other near and far planes what it
// did not clip before, and moves the new vertices to its grid, so that a pixel at an edge may change sides.
bool at_an_edge(const Image<uint32_t>& image, size_t index) {
  const int x = static_cast<int>(index) % image.width, y = static_cast<int>(index) / image.width;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int beside_x = x + dx, beside_y = y + dy;
      if (beside_x < 0 || beside_y < 0 || beside_x >= image.width || beside_y >= image.height) continue;
      if (image.at(beside_x, beside_y) != image[index]) return true;
    }
  return false;
}

// Near and far only clip. A near plane at 1e-6 m, or a far plane at 1e9 m, must not change which surface a pixel sees.
TEST_F(GlTest, NearAndFarThatCutNothingOffChangeNothing) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    Scene scene = builtin.make({});
    renderer.load_scene(scene);
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
      scene.camera.projection = projection;
      scene.camera.height_m = 5;
      const Camera fitted = with_fitted_depths(scene, scene.camera, 160, 90);
      const Image<uint32_t> image = renderer.render_primitives(fitted, 160, 90);
      const auto seen =
          std::count_if(image.pixels.begin(), image.pixels.end(), [](uint32_t p) { return p != no_primitive; });
      EXPECT_GT(seen, 500) << builtin.name;
      const double least_near = projection == Projection::perspective ? 1e-6 : 0;
      for (const auto& [near_m, far_m] :
           {std::pair(*fitted.near_m, 1e9), {least_near, *fitted.far_m}, {least_near, 1e9}}) {
        Camera camera = fitted;
        camera.near_m = near_m;
        camera.far_m = far_m;
        const Image<uint32_t> other = renderer.render_primitives(camera, 160, 90);
        int different = 0, at_edges = 0;
        for (size_t i = 0; i < image.size(); ++i) {
          if (other[i] == image[i]) continue;
          ++(!renderer.info().software && at_an_edge(image, i) ? at_edges : different);
        }
        EXPECT_EQ(different, 0) << builtin.name << ", near " << near_m << ", far " << far_m;
        EXPECT_LE(at_edges, 2) << builtin.name << ", near " << near_m << ", far " << far_m;
      }
    }
  }
}

// Sheets one behind the other, apart by a fixed share of their distance: the nearer one hides the other at any
// distance.
TEST_F(GlTest, TheNearerOfTwoSheetsIsSeenHoweverFarOff) {
  // The vertex's depth, its reciprocal and its place in the plane may each be off by half a float step or two.
  constexpr double apart = 16 * 0x1p-24;
  for (double distance : {0.01, 1.0, 100.0, 1e4, 1e6}) {
    Scene scene;
    const double near_sheet = distance, far_sheet = distance * (1 + apart);
    add_quad(scene, "far", {-far_sheet, -far_sheet, -far_sheet}, {2 * far_sheet, 0, 0}, {0, 2 * far_sheet, 0});
    add_quad(scene, "near", {-near_sheet, -near_sheet, -near_sheet}, {2 * near_sheet, 0, 0}, {0, 2 * near_sheet, 0});
    add_quad(scene, "farther", {-far_sheet, -far_sheet, -far_sheet * 1.5}, {2 * far_sheet, 0, 0},
             {0, 2 * far_sheet, 0});
    renderer.load_scene(scene);
    Camera camera{.eye_m = {0, 0, 0}, .target_m = {0, 0, -1}, .near_m = 1e-3, .far_m = 1e7};
    const Image<uint32_t> image = renderer.render_primitives(camera, 64, 64);
    for (uint32_t p : image.pixels) ASSERT_EQ(p / 2, 1u) << distance;
  }
}

// Inside a closed room every pixel sees a surface, wherever the eye is, even if it is near a wall and looks along it.
TEST_F(GlTest, FittedDepthsCutNothingOffInsideARoom) {
  Scene room;
  add_box(room, "room", {-4, -2, -3}, {4, 2, 3});
  add_box(room, "pillar", {0.9, -2, 0.9}, {1, 2, 1});
  renderer.load_scene(room);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> in(-1, 1);
  for (int round = 0; round < 60; ++round) {
    ViewSettings view;
    view.width_px = 64;
    view.height_px = 36;
    view.eye_m = glm::dvec3(3.999, 1.999, 2.999) * glm::dvec3(in(random), in(random), in(random));
    view.target_m = *view.eye_m + glm::dvec3(in(random), in(random), in(random));
    view.fov_deg = 90 + 60 * in(random);
    const Camera camera = effective_camera(room, view);
    const Image<uint32_t> image = renderer.render_primitives(camera, view.width_px, view.height_px);
    ASSERT_EQ(std::count(image.pixels.begin(), image.pixels.end(), no_primitive), 0)
        << "round " << round << ", near " << *camera.near_m << ", far " << *camera.far_m;
  }
}

// The front face of a box has half the picture's height at every distance, because the field of view is chosen so.
TEST_F(GlTest, FittedDepthsCutNothingOffFromOutside) {
  Scene scene;
  add_box(scene, "box", {-1, -1, -1}, {1, 1, 1});
  renderer.load_scene(scene);
  ViewSettings view;
  view.width_px = view.height_px = 100;
  for (double distance : {1.2, 3.0, 10.0, 1e3, 1e5}) {
    scene.camera = {.eye_m = {0, 0, 1 + distance}, .fov_y_deg = 2 * glm::degrees(std::atan(2 / distance))};
    const Image<uint32_t> image = renderer.render_primitives(effective_camera(scene, view), 100, 100);
    const auto background = std::count(image.pixels.begin(), image.pixels.end(), no_primitive);
    EXPECT_NEAR(static_cast<double>(image.size()) - static_cast<double>(background), 50 * 50, 50 + 50 + 1)
        << distance << ": rounding may add or remove one row and one column";
  }
}

TEST_F(GlTest, BacksOfSingleSidedTrianglesAreSeenThrough) {
  Scene scene;
  add_floor(scene, 0, 2);                                     // triangles 0 and 1, towards the camera
  add_quad(scene, "lid", {-2, 1, -2}, {2, 0, 0}, {0, 0, 4});  // 2 and 3: x < 0, away from the camera
  renderer.load_scene(scene);
  Camera camera = camera_from_above(3);
  const auto quad_at = [&](const std::vector<bool>& single_sided, int x) {
    scene.single_sided = single_sided;
    return renderer.render_primitives(camera, 30, 30, unseen_backs(scene, camera)).at(x, 15) / 2;
  };
  EXPECT_EQ(quad_at({}, 5), 1u);
  EXPECT_EQ(quad_at({true, true, false, false}, 5), 1u);
  EXPECT_EQ(quad_at({false, false, true, true}, 5), 0u) << "the floor behind the lid";
  EXPECT_EQ(quad_at({true, true, true, true}, 25), 0u);
  camera.eye_m.y = -10;  // from below, where right is -X, the floor shows its back and the lid its front
  EXPECT_EQ(quad_at({true, true, true, true}, 25), 1u);
  EXPECT_EQ(quad_at({true, true, true, true}, 5), no_primitive / 2);
}

}  // namespace
}  // namespace noonmark::gl
