// A picture's pixels against the camera's matrix, and the receivers at their centres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "base/error.h"
#include "scenes/camera_frame.h"
#include "scenes/receivers.h"
#include "scenes/shapes.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

int kind_of_error(const Camera& camera) {
  return kind_thrown([&] { make_camera_frame(camera, 16, 9); });
}

Camera some_camera(Projection projection) {
  return {.projection = projection,
          .eye_m = {3, 2, 5},
          .target_m = {0.5, -0.2, 0.1},
          .fov_y_deg = 40,
          .height_m = 6,
          .near_m = 0.5,
          .far_m = 60};
}

TEST(CameraFrame, PixelRaysMeetTheMatrixAtPixelCentres) {
  for (Projection projection : {Projection::perspective, Projection::orthographic}) {
    const int width = 37, height = 20;
    const CameraFrame frame = make_camera_frame(some_camera(projection), width, height);
    EXPECT_LT(glm::length(glm::cross(frame.up, frame.right) - frame.forward), 1e-14);
    for (const glm::ivec2 pixel : {glm::ivec2(0, 0), glm::ivec2(36, 19), glm::ivec2(18, 3), glm::ivec2(5, 11)}) {
      const Ray ray = frame.pixel_ray(pixel.x, pixel.y, width, height);
      double last_depth = -1;
      for (double along : {0.6, 2.0, 30.0, 59.0}) {
        const glm::dvec4 clip = frame.clip_from_world() * glm::dvec4(ray.origin + along * ray.direction, 1);
        const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
        EXPECT_NEAR((ndc.x / 2 + 0.5) * width, pixel.x + 0.5, 1e-9);
        EXPECT_NEAR((0.5 - ndc.y / 2) * height, pixel.y + 0.5, 1e-9);  // row 0 on top
        EXPECT_GT(ndc.z, last_depth);
        EXPECT_LT(ndc.z, 1);
        last_depth = ndc.z;
      }
    }
    for (const auto& [distance, depth] : {std::pair(0.5, -1.0), std::pair(60.0, 1.0)}) {
      const glm::dvec4 clip = frame.clip_from_world() * glm::dvec4(frame.eye_m + distance * frame.forward, 1);
      EXPECT_NEAR(clip.z / clip.w, depth, 1e-12);
    }
  }
}

TEST(CameraFrame, UpIsUpAndRightIsRight) {
  const CameraFrame frame = make_camera_frame({.eye_m = {0, 0, 5}, .target_m = {0, 0, 0}}, 10, 10);
  EXPECT_EQ(frame.right, glm::dvec3(1, 0, 0));
  EXPECT_EQ(frame.up, glm::dvec3(0, 1, 0));
  EXPECT_GT(frame.pixel_ray(5, 0, 10, 10).direction.y, 0);
  EXPECT_LT(frame.pixel_ray(0, 5, 10, 10).direction.x, 0);
}

TEST(CameraFrame, DegenerateCamerasAreUsageErrors) {
  Camera camera = some_camera(Projection::perspective);
  EXPECT_EQ(kind_of_error(camera), 0);
  camera.target_m = camera.eye_m;
  EXPECT_EQ(kind_of_error(camera), 2);
  camera = some_camera(Projection::perspective);
  camera.near_m = camera.far_m;
  EXPECT_EQ(kind_of_error(camera), 2);
  camera = some_camera(Projection::perspective);
  camera.eye_m.x = std::nan("");
  EXPECT_EQ(kind_of_error(camera), 2);
}

// If the up vector lies along the view, the result is a picture or an error, never axes that are NaN.
TEST(CameraFrame, UpAlongTheViewHasFiniteAxesOrAnError) {
  for (const glm::dvec3 way : {glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)}) {
    for (const glm::dvec3 up : {way, -way, glm::dvec3(0), 3.0 * way}) {
      Camera camera = some_camera(Projection::perspective);
      camera.target_m = camera.eye_m + way;
      camera.up = up;
      try {
        const CameraFrame frame = make_camera_frame(camera, 16, 9);
        EXPECT_NEAR(glm::length(frame.right), 1, 1e-12) << up.x << ' ' << up.y << ' ' << up.z;
        EXPECT_NEAR(glm::length(frame.up), 1, 1e-12);
        EXPECT_NEAR(glm::dot(frame.right, frame.forward), 0, 1e-12);
      } catch (const Error& e) {
        EXPECT_EQ(e.exit_code(), 2);
      }
    }
  }
}

// How far p lies outside the triangle: the largest of its distances from the plane and beyond the three edges.
double outside_by(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double area2 = glm::dot(n, n);
  double outside = std::abs(glm::dot(p - a, n)) / std::sqrt(area2);
  for (const auto& [q, r] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const double signed_distance = glm::dot(glm::cross(r - q, p - q), n) / (std::sqrt(area2) * glm::length(r - q));
    outside = std::max(outside, -signed_distance);
  }
  return outside;
}

TEST(Receivers, LieOnTheirTriangleInTheRayWithTheNormalTowardsTheViewer) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> in(-3, 3);
  for (Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (int round = 0; round < 200; ++round) {
      Scene scene;
      for (int i = 0; i < 3; ++i) scene.positions.push_back({in(random), in(random), in(random)});
      scene.triangles = {{0, 1, 2}};
      const Camera camera = some_camera(projection);
      const int size = 24;
      // The image says that the rasteriser drew the triangle at every pixel. So most pixel centres lie outside the
      // triangle; in a real picture the snapping of vertices does this to some.
      const ReceiverImage image = resolve_receivers(scene, camera, Image<uint32_t>(size, size, 0));
      const CameraFrame frame = make_camera_frame(camera, size, size);
      const glm::dvec3 a = scene.positions[0], b = scene.positions[1], c = scene.positions[2];
      const glm::dvec3 plane = glm::cross(b - a, c - a);
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          ASSERT_EQ(image.primitive.at(x, y), 0u);
          const glm::dvec3 p = image.position.at(x, y), n = image.normal.at(x, y);
          // Half a float's last place on each axis, of coordinates below 4: 2^-23 each.
          const double float_rounding_m = std::sqrt(3.0) * 0x1p-23;
          ASSERT_LT(outside_by(p, a, b, c), float_rounding_m);
          const Ray ray = frame.pixel_ray(x, y, size, size);
          ASSERT_LT(glm::dot(n, ray.direction), 1e-6);
          ASSERT_NEAR(glm::length(n), 1, 1e-6);
          ASSERT_LT(glm::length(glm::cross(n, glm::normalize(plane))), 1e-6);
          // Where the ray does meet the triangle, P is that point.
          const double along = glm::dot(plane, a - ray.origin) / glm::dot(plane, ray.direction);
          const glm::dvec3 met = ray.origin + along * ray.direction;
          if (outside_by(met, a, b, c) < 1e-9) {
            ASSERT_LT(glm::length(met - p), float_rounding_m + 2e-9);
          }
        }
      }
    }
  }
}

TEST(Receivers, BackgroundStaysBackgroundAndSliversBecomeIt) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  scene.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 1, 3}, {1, 4, 3}};
  Image<uint32_t> primitives(5, 1, no_primitive);
  for (uint32_t i = 0; i < 4; ++i) primitives[i] = i;
  const ReceiverImage image = resolve_receivers(scene, {.eye_m = {0.2, 0.2, 5}, .target_m = {0.2, 0.2, 0}}, primitives);
  EXPECT_EQ(image.primitive[0], no_primitive);  // three points in a line
  EXPECT_EQ(image.primitive[1], 1u);
  EXPECT_EQ(image.primitive[2], no_primitive);  // two corners are one
  EXPECT_EQ(image.primitive[3], no_primitive);  // two corners at one place
  EXPECT_EQ(image.primitive[4], no_primitive);
  for (size_t i : {0u, 2u, 3u, 4u}) {
    EXPECT_EQ(image.position[i], glm::vec3(0));
    EXPECT_EQ(image.normal[i], glm::vec3(0));
  }
  EXPECT_EQ(image.normal[1], glm::vec3(0, 0, 1));
}

// Triangles that are seen along their plane, or whose tilt against the rays is tiny.
TEST(Receivers, EdgeOnTrianglesGiveFinitePointsOnThem) {
  for (float tilt : {0.0f, 1e-30f, 1e-38f, -1e-20f}) {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, tilt}, {0, 0, -1}};
    scene.triangles = {{0, 1, 2}};
    for (double y : {0.0, 1e-300, 1e-18}) {
      Camera camera{.eye_m = {0.2, y, 5}, .target_m = {0.2, y, 0}};
      for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        camera.projection = projection;
        const ReceiverImage image = resolve_receivers(scene, camera, Image<uint32_t>(3, 3, 0));
        for (size_t i = 0; i < 9; ++i) {
          const glm::dvec3 p = image.position[i];
          ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << i;
          EXPECT_LT(outside_by(p, scene.positions[0], scene.positions[1], scene.positions[2]), 1e-6);
          EXPECT_NEAR(std::abs(image.normal[i].y), 1, 1e-6);
        }
      }
    }
  }
}

TEST(Receivers, AnEmptySceneIsAllBackground) {
  const ReceiverImage image = resolve_receivers(Scene(), Camera(), Image<uint32_t>(4, 3, no_primitive));
  for (uint32_t primitive : image.primitive.pixels) EXPECT_EQ(primitive, no_primitive);
}

TEST(PixelRays, AreThoseOfEachPixelBitForBit) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const CameraFrame frame = make_camera_frame(some_camera(projection), 31, 17);
    const PixelRays rays(frame, 31, 17);
    for (int y = 0; y <= 17; ++y)
      for (int x = 0; x <= 31; ++x) {
        const Ray one = rays.at(x, y), expected = frame.pixel_ray(x, y, 31, 17);
        ASSERT_EQ(one.origin, expected.origin) << x << ", " << y;
        ASSERT_EQ(one.direction, expected.direction) << x << ", " << y;
      }
  }
}

}  // namespace
}  // namespace noonmark
