// Tracer::seen_by against every triangle met in double, with the camera's rule written a second time: of single-sided
// triangles the camera sees the front, and what is nearer than its near plane hides nothing.
#include <gtest/gtest.h>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

glm::dvec3 corner(const Scene& scene, uint32_t triangle, int k) {
  return scene.positions[scene.triangles[triangle][k]];
}

glm::dvec3 way_to_viewer(const Camera& camera, glm::dvec3 from) {
  return camera.projection == Projection::perspective ? camera.eye_m - from : camera.eye_m - camera.target_m;
}

double depth_of(const Camera& camera, glm::dvec3 p) {
  return glm::dot(p - camera.eye_m, glm::normalize(camera.target_m - camera.eye_m));
}

// How surely the point is seen: above 0 it is seen, below 0 it is hidden; about 0 rounding may decide.
double seen(const Scene& scene, const ReceiverImage& receivers, size_t i, const Camera& camera) {
  const glm::dvec3 p(receivers.position[i]), to_viewer = way_to_viewer(camera, p);
  double margin = glm::dot(glm::dvec3(receivers.normal[i]), glm::normalize(to_viewer));
  margin = std::min(margin, depth_of(camera, p) - *camera.near_m);
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2),
                     n = glm::cross(b - a, c - a);
    const bool back = glm::dot(n, to_viewer) <= 0;
    if (back && !scene.single_sided.empty() && scene.single_sided[t]) continue;
    const double along = glm::dot(n, a - p) / glm::dot(n, to_viewer);
    const double ahead = along * glm::length(to_viewer);
    if (!(ahead > 1e-4)) continue;  // P's own plane
    const glm::dvec3 at = p + along * to_viewer;
    double inside = std::min(ahead, depth_of(camera, at) - *camera.near_m);
    for (const auto& [from, to] : {std::pair(a, b), {b, c}, {c, a}})
      inside =
          std::min(inside, glm::dot(glm::cross(to - from, at - from), n) / (glm::length(n) * glm::length(to - from)));
    margin = std::min(margin, -inside);
  }
  return margin;
}

// A room that is seen from inside, with boxes that are seen from outside, a screen of two faces back to back, and one
// of two equal faces, of which one has two sides.
Scene room() {
  Scene scene;
  const auto from_inside = [&](const std::function<void()>& add) {
    const size_t first = scene.triangles.size();
    add();
    for (size_t t = first; t < scene.triangles.size(); ++t) std::swap(scene.triangles[t].y, scene.triangles[t].z);
  };
  from_inside([&] { add_box(scene, "room", {-2, 0, -2}, {2, 3, 2}); });
  add_box(scene, "low", {-1, 0.1, -1}, {-0.2, 0.9, -0.1});
  add_box(scene, "high", {0.3, 0.2, -0.5}, {0.8, 1.9, 0.4});
  add_quad(scene, "screen", {-1.5, 0.3, 0.8}, {1, 0, 0.3}, {0, 1, 0});
  from_inside([&] { add_quad(scene, "back", {-1.5, 0.3, 0.8}, {1, 0, 0.3}, {0, 1, 0}); });
  add_quad(scene, "one", {0.9, 0.2, 1}, {0.7, 0, 0}, {0, 0.9, 0.2});
  scene.single_sided.assign(scene.triangles.size(), true);
  add_quad(scene, "two", {0.9, 0.2, 1}, {0.7, 0, 0}, {0, 0.9, 0.2});
  scene.single_sided.resize(scene.triangles.size(), false);
  return scene;
}

void expect_as_in_double(const Scene& scene, const Camera& camera, bool expects_hidden) {
  const Tracer tracer(scene);
  const ReceiverImage receivers =
      random_receivers(scene, glm::normalize(way_to_viewer(camera, glm::dvec3(0))), false, 6000, 11);
  const SeenReceivers result = tracer.seen_by(receivers, camera);
  int shown = 0, hidden = 0, ambiguous = 0;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    ambiguous += result.ambiguous[i];
    const double margin = seen(scene, receivers, i, camera);
    if (result.ambiguous[i] || std::abs(margin) < 1e-5) continue;
    ASSERT_EQ(result.seen[i] == 1, margin > 0)
        << "receiver " << i << " on " << receivers.primitive[i] << ", " << margin;
    ++(margin > 0 ? shown : hidden);
  }
  EXPECT_GT(shown, 500);
  if (expects_hidden) {
    EXPECT_GT(hidden, 500);
  }
  EXPECT_LT(ambiguous, 60);
}

Camera camera_at(glm::dvec3 eye, double near_m, Projection projection = Projection::perspective) {
  Camera camera{.projection = projection, .eye_m = eye, .target_m = {0, 1, 0}};
  camera.near_m = near_m, camera.far_m = 50;
  return camera;
}

TEST(SeenBy, IsTheCamerasRule) {
  const Scene scene = room();
  expect_as_in_double(scene, camera_at({1, 2, 1.5}, 0.01), true);  // inside the room
  expect_as_in_double(scene, camera_at({3, 5, 7}, 0.01), true);    // through the backs
  expect_as_in_double(scene, camera_at({3, 5, 7}, 0.01, Projection::orthographic), true);
}

TEST(SeenBy, LetsTheNearPlaneCutOff) {
  Scene scene = room();
  scene.single_sided.clear();
  expect_as_in_double(scene, camera_at({1, 3, 7}, 6.2), true);
  expect_as_in_double(scene, camera_at({1, 3, 7}, 6.2, Projection::orthographic), true);
}

}  // namespace
}  // namespace noonmark::raytrace
