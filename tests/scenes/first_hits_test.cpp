// The first hits of rays, against a test of every triangle at every ray; and how many of these tests first_hits needs.
#include "scenes/first_hits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "scenes/shapes.h"

namespace noonmark {
namespace {

FirstHits hits_by_brute_force(const Scene& scene, const CameraFrame& frame, int rays, Backs backs) {
  FirstHits hits{Image<float>(rays, rays, FirstHits::nothing), Image<uint8_t>(rays, rays), Image<uint8_t>(rays, rays)};
  const bool perspective = frame.camera.projection == Projection::perspective;
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::uvec3& t = scene.triangles[i];
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const bool back = glm::dot(normal, perspective ? a - frame.eye_m : frame.forward) > 0;
    const bool single_sided = !scene.single_sided.empty() && scene.single_sided[i];
    if (back && single_sided && backs == Backs::seen_of_double_sided) continue;
    for (int y = 0; y < rays; ++y)
      for (int x = 0; x < rays; ++x) {
        const Ray ray = frame.pixel_ray(x, y, rays, rays);
        const double along = glm::dot(normal, a - ray.origin) / glm::dot(normal, ray.direction);
        if (!(along > 0) || !(along < static_cast<double>(hits.depth.at(x, y)))) continue;
        const glm::dvec3 p = ray.origin + along * ray.direction;
        bool in = true;
        for (const auto& [q, r] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
          in = in && glm::dot(glm::cross(r - q, p - q), normal) >= 0;
        if (!in) continue;
        hits.depth.at(x, y) = static_cast<float>(along);
        hits.back.at(x, y) = back;
        hits.single_sided.at(x, y) = single_sided;
      }
  }
  return hits;
}

// Random triangles, small and large, with slivers among them. They lie around the eye, so that some cross its plane.
Scene soup_of_triangles(std::mt19937& random, int triangles) {
  std::uniform_real_distribution<float> place(-5, 5), size(-2, 2);
  Scene scene;
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 at(place(random), place(random), place(random)), way(size(random), size(random), size(random));
    const float scale = i % 5 == 0 ? 4.0f : 0.5f;
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 other(size(random), size(random), size(random));
      scene.positions.push_back(at + scale * (i % 3 == 0 ? (static_cast<float>(k) * way + 1e-3f * other) : other));
    }
    const auto first = static_cast<uint32_t>(3 * i);
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.single_sided.push_back(i % 4 == 0);
  }
  return scene;
}

CameraFrame square_frame(Projection projection, glm::dvec3 eye, glm::dvec3 target) {
  return make_camera_frame(
      {.projection = projection, .eye_m = eye, .target_m = target, .up = {0.3, 1, 0.2}, .fov_y_deg = 80}, 1, 1);
}

TEST(FirstHits, AreThoseOfEveryTriangleAskedAtEveryRay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(-1, 1);
  int met = 0;
  for (int round = 0; round < 120; ++round) {
    const Scene scene = soup_of_triangles(random, 1 + 3 * round);
    const double reach = round % 2 == 0 ? 3 : 20;
    const auto eye = reach * glm::dvec3(in(random), in(random), in(random));
    const Backs backs = round % 4 < 2 ? Backs::seen : Backs::seen_of_double_sided;
    const CameraFrame frame =
        square_frame(round % 3 == 0 ? Projection::orthographic : Projection::perspective, eye, {0, 0, 0});
    const int rays = 5 + round % 30;
    const FirstHits hits = first_hits(scene, frame, rays, backs), all = hits_by_brute_force(scene, frame, rays, backs);
    for (size_t i = 0; i < hits.depth.size(); ++i) {
      if (all.depth[i] == FirstHits::nothing) {
        ASSERT_EQ(hits.depth[i], FirstHits::nothing) << "round " << round;
        continue;
      }
      ++met;
      ASSERT_NEAR(hits.depth[i], all.depth[i], 2e-6f * all.depth[i]) << "round " << round;
      ASSERT_EQ(hits.back[i], all.back[i]) << "round " << round;
      ASSERT_EQ(hits.single_sided[i], all.single_sided[i]) << "round " << round;
    }
  }
  EXPECT_GT(met, 10000);
}

void add_copies(Scene& scene, const Scene& of, int count, glm::vec3 apart) {
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<uint32_t>(scene.positions.size());
    for (const glm::vec3& p : of.positions) scene.positions.push_back(p + static_cast<float>(i) * apart);
    for (const glm::uvec3& t : of.triangles) scene.triangles.push_back(t + first);
  }
}

// The time must not grow with the number of rays times the number of triangles.
TEST(FirstHits, AskFewOfManyHiddenTriangles) {
  Scene turned;
  add_box(turned, "box", glm::dvec3(0.5), glm::dmat4(0.6, 0.8, 0, 0, -0.8, 0.6, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
  Scene box;
  add_box(box, "box", glm::dvec3(-0.5), glm::dvec3(0.5));
  constexpr int rays = 64;
  for (const Scene* one : {&box, &turned}) {
    for (const glm::vec3 apart :
         {glm::vec3(0), glm::vec3(0.001f, 0, 0), glm::vec3(-0.001f, 0, 0), glm::vec3(0, 0, 0.01f)}) {
      for (const glm::dvec3 from : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 2, 3)}) {
        const auto asked = [&](int copies) {
          Scene scene;
          add_copies(scene, *one, copies, apart);
          const glm::dvec3 middle = 0.5 * copies * glm::dvec3(apart);
          return static_cast<double>(
              first_hits(scene,
                         square_frame(Projection::orthographic,
                                      middle + from * (10.0 + copies * glm::length(glm::dvec3(apart))), middle),
                         rays, Backs::seen)
                  .asked);
        };
        // The 12 triangles of the first copy may be tested at all rays. Each triangle of the other copies may be tested
        // at 16 rays, where its edges lie.
        EXPECT_LT(asked(2000), 12.0 * rays * rays + 2000 * 12 * 16)
            << from.x << ", apart " << apart.x << ", " << apart.z;
      }
    }
  }
}

// A fan of slivers covers the picture once, however many slivers there are. So a sliver may be tested only at the rays
// along its length.
TEST(FirstHits, AskSliversAlongTheirLengthOnly) {
  Scene fan;
  constexpr int slivers = 5000, rays = 64;
  fan.positions.push_back({0, 0, 0});
  for (int i = 0; i <= slivers; ++i) {
    const double angle = 2 * 3.14159265358979 * i / slivers;
    fan.positions.push_back({5 * std::cos(angle), 5 * std::sin(angle), -1e-3 * i});
    if (i > 0) fan.triangles.push_back({0, static_cast<uint32_t>(i), static_cast<uint32_t>(i + 1)});
  }
  const FirstHits hits =
      first_hits(fan, square_frame(Projection::orthographic, {0, 0, 10}, {0, 0, 0}), rays, Backs::seen);
  EXPECT_LT(static_cast<double>(hits.asked), slivers * 4.0 * rays);
}

}  // namespace
}  // namespace noonmark
