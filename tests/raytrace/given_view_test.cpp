// What another renderer's camera sees, and its receivers put onto the scene.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "raytrace/tracer.h"
#include "scenes/camera_fit.h"
#include "scenes/nearest_in_triangle.h"
#include "tests/support/builtin_scenes.h"

namespace noonmark::test {
namespace {

constexpr int width = 64, height = 36;

ViewMatrix view_of_scene(const Scene& scene) {
  ViewSettings settings;
  settings.width_px = width;
  settings.height_px = height;
  return ViewMatrix(make_camera_frame(effective_camera(scene, settings), width, height).clip_from_world());
}

// The first triangle by brute force in double, with its distance; within `tie` of another one there is none.
uint32_t first_by_brute_force(const Scene& scene, const Ray& ray, bool& sure) {
  uint32_t first = no_primitive;
  double least = std::numeric_limits<double>::infinity();
  sure = true;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double slope = glm::dot(n, ray.direction);
    if (slope == 0 || (!scene.single_sided.empty() && scene.single_sided[t] && slope > 0)) continue;
    const double along = glm::dot(n, a - ray.origin) / slope;
    if (along < 0) continue;
    const glm::dvec3 p = ray.origin + along * ray.direction;
    double inside = std::numeric_limits<double>::infinity();  // distance to the nearest edge, negative outside
    for (const auto& [from, to] : {std::pair(a, b), {b, c}, {c, a}})
      inside =
          std::min(inside, glm::dot(glm::cross(n, to - from), p - from) / (glm::length(n) * glm::length(to - from)));
    if (std::abs(inside) < 1e-4) sure = false;
    if (inside < 0) continue;
    if (std::abs(along - least) < 1e-4) sure = false;
    if (along < least) {
      least = along;
      first = t;
    }
  }
  return first;
}

TEST(GivenView, SeesWhatBruteForceSees) {
  for (const char* name : {"cube-room", "wall", "sphere"}) {
    const Scene scene = make_scene({.name = name});
    const raytrace::Tracer tracer(scene);
    const ViewMatrix view = view_of_scene(scene);
    const Image<uint32_t> seen = tracer.seen_primitives(view, width, height);
    int compared = 0;
    for (int y = 0; y < height; y += 3)
      for (int x = 0; x < width; x += 3) {
        bool sure = true;
        const uint32_t wanted = first_by_brute_force(scene, view.pixel_ray(x, y, width, height), sure);
        if (!sure) continue;
        EXPECT_EQ(seen.at(x, y), wanted) << name << " " << x << " " << y;
        ++compared;
      }
    EXPECT_GT(compared, 100) << name;
  }
}

// A camera behind a single-sided wall sees through it.
TEST(GivenView, SeesNoBacksOfSingleSidedTriangles) {
  Scene scene = make_scene({.name = "cube-room"});
  const raytrace::Tracer both(scene);
  const ViewMatrix view = view_of_scene(scene);
  const Image<uint32_t> before = both.seen_primitives(view, width, height);
  scene.single_sided.assign(scene.triangles.size(), true);
  for (glm::uvec3& t : scene.triangles) std::swap(t.y, t.z);  // every front is a back now
  const raytrace::Tracer turned(scene);
  const Image<uint32_t> after = turned.seen_primitives(view, width, height);
  int seen_before = 0;
  for (size_t i = 0; i < before.size(); ++i) {
    if (before[i] == no_primitive) continue;
    ++seen_before;
    EXPECT_NE(after[i], before[i]);
  }
  EXPECT_GT(seen_before, 100);
}

TEST(GivenView, NothingBeyondFarIsSeen) {
  const Scene scene = make_scene({.name = "cube-room"});
  const raytrace::Tracer tracer(scene);
  ViewSettings settings;
  settings.width_px = width;
  settings.height_px = height;
  Camera camera = effective_camera(scene, settings);
  camera.far_m = *camera.near_m * 1.001;
  const Image<uint32_t> seen =
      tracer.seen_primitives(ViewMatrix(make_camera_frame(camera, width, height).clip_from_world()), width, height);
  for (const uint32_t primitive : seen.pixels) EXPECT_EQ(primitive, no_primitive);
}

TEST(GivenView, PointsComeBackToTheirTriangles) {
  const Scene scene = make_scene({.name = "cube-room"});
  const raytrace::Tracer tracer(scene);
  const ViewMatrix view = view_of_scene(scene);
  const ReceiverImage receivers = resolve_receivers(scene, view, tracer.seen_primitives(view, width, height));
  constexpr double off_m = 1e-3;
  Image<glm::dvec3> points(width, height, glm::dvec3(0));
  Image<uint8_t> present(width, height, 0);
  for (size_t i = 0; i < points.size(); ++i) {
    present[i] = receivers.primitive[i] != no_primitive && i % 5 != 0;
    points[i] = glm::dvec3(receivers.position[i]) + off_m * glm::dvec3(receivers.normal[i]);
  }
  const raytrace::OnSurface found = tracer.on_surface(points, present, view);
  for (size_t i = 0; i < points.size(); ++i) {
    if (!present[i]) {
      EXPECT_EQ(found.receivers.primitive[i], no_primitive);
      continue;
    }
    ASSERT_NE(found.receivers.primitive[i], no_primitive);
    // The receiver's own rounding, and that of its normal, are in the distance.
    EXPECT_LE(found.moved_m[i], off_m + 0x1p-22 * glm::length(points[i]));
    // The nearest of all triangles, by brute force.
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t t = 0; t < scene.triangles.size(); ++t)
      least = std::min(least, glm::length(nearest_of_triangle(points[i], corner(scene, t, 0), corner(scene, t, 1),
                                                              corner(scene, t, 2)) -
                                          points[i]));
    EXPECT_NEAR(found.moved_m[i], least, 1e-6);
  }
}

}  // namespace
}  // namespace noonmark::test
