// Near and far of a camera that stands anywhere, and what settings.view changes.
#include "scenes/camera_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "scenes/builtin.h"
#include "scenes/camera_frame.h"
#include "scenes/library.h"
#include "scenes/receivers.h"
#include "scenes/shapes.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

// The depths, along the view, of all triangles that the ray meets, sorted.
std::vector<double> depths_met(const Scene& scene, const Ray& ray) {
  std::vector<double> depths;
  for (const glm::uvec3& t : scene.triangles) {
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double along = glm::dot(normal, a - ray.origin) / glm::dot(normal, ray.direction);
    if (!(along > 0) || !std::isfinite(along)) continue;
    const glm::dvec3 p = ray.origin + along * ray.direction;
    bool in = true;
    for (const auto& [q, r] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      in = in && glm::dot(glm::cross(r - q, p - q), normal) >= 0;
    if (in) depths.push_back(along);
  }
  std::sort(depths.begin(), depths.end());
  return depths;
}

int kind_of_error(const Scene& scene, const ViewSettings& view) {
  return kind_thrown([&] { effective_camera(scene, view); });
}

// Random triangles, small and large, near and far. Some cross the eye's plane, some lie behind it.
Scene soup_before_a_camera(std::mt19937& random, int triangles) {
  std::uniform_real_distribution<float> place(-5, 5), size(-2, 2);
  Scene scene;
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 at(place(random), place(random), place(random));
    const float scale = i % 5 == 0 ? 4.0f : 0.5f;
    for (int k = 0; k < 3; ++k)
      scene.positions.push_back(at + scale * glm::vec3(size(random), size(random), size(random)));
    const auto first = static_cast<uint32_t>(3 * i);
    scene.triangles.push_back({first, first + 1, first + 2});
  }
  return scene;
}

TEST(CameraFit, CutsOffNothingWhereverTheEyeStands) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> in(-1, 1);
  int met = 0, nearer_than_the_least = 0;
  for (int round = 0; round < 400; ++round) {
    const Scene scene = soup_before_a_camera(random, 40);
    ViewSettings view;
    view.width_px = 8 + round % 9;
    view.height_px = 6;
    const double reach = round % 3 == 0 ? 4 : round % 3 == 1 ? 15 : 500;  // inside the scene, next to it, far away
    view.eye_m = reach * glm::dvec3(in(random), in(random), in(random));
    view.target_m = 5.0 * glm::dvec3(in(random), in(random), in(random));
    view.fov_deg = 60 + 50 * in(random);
    const Camera camera = effective_camera(scene, view);
    ASSERT_GT(*camera.near_m, 0);
    ASSERT_GT(*camera.far_m, *camera.near_m);
    const CameraFrame frame = make_camera_frame(camera, view.width_px, view.height_px);
    for (int y = 0; y < view.height_px; ++y)
      for (int x = 0; x < view.width_px; ++x)
        for (const double depth : depths_met(scene, frame.pixel_ray(x, y, view.width_px, view.height_px))) {
          ++met;
          ASSERT_LT(depth, *camera.far_m);
          if (depth < 1e-4 * *camera.far_m)
            ++nearer_than_the_least;
          else
            ASSERT_GT(depth, *camera.near_m) << "round " << round;
        }
  }
  EXPECT_GT(met, 5000);
  EXPECT_LT(nearer_than_the_least, met / 1000);
}

// Surfaces outside the picture or behind the eye must not widen the range of depths.
TEST(CameraFit, HoldsNoMoreThanWhatIsInView) {
  Scene scene;
  add_quad(scene, "wall", {-50, -50, -10}, {100, 0, 0}, {0, 100, 0});
  add_quad(scene, "beside", {3, -1, -1}, {0, 0, 1}, {0, 2, 0});
  add_quad(scene, "behind", {-1, -1, 0.01}, {2, 0, 0}, {0, 2, 0});
  ViewSettings view;
  view.eye_m = {0, 0, 0};
  view.target_m = {0, 0, -1};
  const Camera camera = effective_camera(scene, view);
  EXPECT_NEAR(*camera.near_m, 10, 0.02);  // the margin: a thousandth
  EXPECT_NEAR(*camera.far_m, 10, 0.02);
}

TEST(CameraFit, OrthographicCamerasStartAtTheEye) {
  Scene scene;
  add_quad(scene, "wall", {-50, -50, -10}, {100, 0, 0}, {0, 100, 0});
  scene.camera = {.projection = Projection::orthographic, .eye_m = {0, 0, 0}, .target_m = {0, 0, -1}, .height_m = 4};
  EXPECT_NEAR(*effective_camera(scene, {}).near_m, 10, 0.02);
  add_quad(scene, "through the eye", {-1, 0, -2}, {2, 0, 0}, {0, 0, 4});
  EXPECT_EQ(*effective_camera(scene, {}).near_m, 0);
}

TEST(CameraFit, GivenPlanesStayAndTheOtherYields) {
  Scene scene;
  add_quad(scene, "wall", {-5, -5, -10}, {10, 0, 0}, {0, 10, 0});
  scene.camera = {.eye_m = {0, 0, 0}, .target_m = {0, 0, -1}};
  const auto planes = [&](std::optional<double> near_m, std::optional<double> far_m) {
    ViewSettings view;
    view.near_m = near_m;
    view.far_m = far_m;
    const Camera camera = effective_camera(scene, view);
    return std::pair(*camera.near_m, *camera.far_m);
  };
  EXPECT_EQ(planes(1, 2), (std::pair(1.0, 2.0)));
  EXPECT_EQ(planes(3, {}).first, 3);
  EXPECT_NEAR(planes(3, {}).second, 10, 0.02);
  EXPECT_EQ(planes(30, {}), (std::pair(30.0, 60.0))) << "the whole scene lies before near";
  EXPECT_EQ(planes({}, 4), (std::pair(2.0, 4.0))) << "the whole scene lies beyond far";
  EXPECT_NEAR(planes({}, 40).first, 10, 0.02);
  scene.camera.near_m = 1;
  scene.camera.far_m = 20;
  EXPECT_EQ(planes({}, 5), (std::pair(1.0, 5.0)));
  ViewSettings crossed;
  crossed.near_m = 20;
  EXPECT_EQ(kind_of_error(scene, crossed), 2) << "the scene's far is not beyond the given near";
  crossed.fit_depths = true;
  EXPECT_EQ(*effective_camera(scene, crossed).far_m, 40) << "the scene's far is replaced, as if the scene had none";
  ViewSettings fitted;
  fitted.fit_depths = true;
  EXPECT_NEAR(*effective_camera(scene, fitted).near_m, 10, 0.02);
  EXPECT_NEAR(*effective_camera(scene, fitted).far_m, 10, 0.02);
  fitted.far_m = 12;
  EXPECT_EQ(*effective_camera(scene, fitted).far_m, 12);
}

TEST(CameraFit, BuiltInScenesAreWholeFromWhereverTheyAreSeen) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = builtin.make({});
    ViewSettings view;
    for (const double distance : {0.0, 5e2, 5e5}) {
      if (distance > 0) view.eye_m = glm::dvec3(distance);
      const Camera camera = effective_camera(scene, view);
      const CameraFrame frame = make_camera_frame(camera, view.width_px, view.height_px);
      for (const glm::vec3& p : scene.positions) {
        const double depth = glm::dot(glm::dvec3(p) - frame.eye_m, frame.forward);
        EXPECT_LT(depth, *camera.far_m) << builtin.name;
        if (distance > 0) {
          EXPECT_GT(depth, *camera.near_m) << builtin.name;
        }
      }
    }
  }
}

TEST(CameraFit, UpTurnsThePicture) {
  const Scene scene = make_scene({});
  ViewSettings view;
  view.eye_m = {0, 5, 0};
  view.target_m = {0, 0, 0};
  for (const glm::dvec3 up : {glm::dvec3(1, 0, 0), glm::dvec3(0, 7, -2)}) {
    view.up = up;
    const CameraFrame frame = make_camera_frame(effective_camera(scene, view), 16, 9);
    const glm::dvec3 across = glm::normalize(up - glm::dot(up, frame.forward) * frame.forward);
    EXPECT_LT(glm::distance(frame.up, across), 1e-12);
  }
  view.up = {0, -3, 0};
  EXPECT_EQ(kind_of_error(scene, view), 2) << "parallel to the view";
  view.up = {1e-9, -3, 0};
  EXPECT_EQ(kind_of_error(scene, view), 2) << "almost parallel to the view";
  view.up.reset();
  EXPECT_EQ(kind_of_error(scene, view), 0) << "the scene's own up may be replaced";
}

// The bit of each triangle, against facing computed from the triangle's plane and the eye.
TEST(UnseenBacks, AreTheBacksOfSingleSidedTrianglesAlone) {
  std::mt19937 random(5);
  Scene scene = soup_before_a_camera(random, 100);
  scene.camera = {.eye_m = {1, 2, 9}, .target_m = {0, 0, 0}};
  EXPECT_TRUE(unseen_backs(scene, scene.camera).empty()) << "both sides of all triangles are seen";
  scene.single_sided.assign(100, false);
  EXPECT_TRUE(unseen_backs(scene, scene.camera).empty());
  for (size_t i = 0; i < 100; i += 3) scene.single_sided[i] = true;
  for (Projection projection : {Projection::perspective, Projection::orthographic}) {
    scene.camera.projection = projection;
    const std::vector<uint32_t> bits = unseen_backs(scene, scene.camera);
    ASSERT_EQ(bits.size(), 4u);
    size_t backs = 0;
    for (size_t i = 0; i < 100; ++i) {
      const glm::dvec3 a = scene.positions[3 * i], b = scene.positions[3 * i + 1], c = scene.positions[3 * i + 2];
      const glm::dvec3 to_eye = projection == Projection::perspective ? scene.camera.eye_m - a : glm::dvec3(1, 2, 9);
      const bool back = glm::determinant(glm::dmat3(b - a, c - a, to_eye)) < 0;
      EXPECT_EQ((bits[i / 32] >> (i % 32) & 1) != 0, back && i % 3 == 0) << i;
      backs += back && i % 3 == 0;
    }
    EXPECT_GT(backs, 5u);
    EXPECT_LT(backs, 30u);
  }
}

}  // namespace
}  // namespace noonmark
