// A camera as a matrix is the camera that it was made from.
#include "scenes/view_matrix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace noonmark {
namespace {

constexpr int width = 64, height = 36;

Camera camera(Projection projection) {
  Camera c;
  c.projection = projection;
  c.eye_m = {3, 2, 7};
  c.target_m = {0.5, 1, -1};
  c.near_m = 0.3;
  c.far_m = 40;
  return c;
}

TEST(ViewMatrix, HasTheRaysOfItsCamera) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const CameraFrame frame = make_camera_frame(camera(projection), width, height);
    const ViewMatrix view(frame.clip_from_world());
    for (int y = 0; y < height; y += 7)
      for (int x = 0; x < width; x += 9) {
        const Ray given = frame.pixel_ray(x, y, width, height), found = view.pixel_ray(x, y, width, height);
        const glm::dvec3 direction = glm::normalize(given.direction);
        EXPECT_LT(glm::length(found.direction - direction), 1e-12);
        EXPECT_LT(glm::length(glm::cross(found.origin - given.origin, direction)), 1e-9)
            << "the origin lies on the ray";
        EXPECT_NEAR(glm::dot(found.origin - frame.eye_m, frame.forward), 0.3, 1e-9) << "on the near plane";
      }
  }
}

TEST(ViewMatrix, APixelsCentreIsWhereItsPointsAre) {
  const ViewMatrix view(make_camera_frame(camera(Projection::perspective), width, height).clip_from_world());
  const glm::dvec3 p = view.world_at(11, 23, 0.4, width, height), at = view.pixel_of(p, width, height);
  EXPECT_NEAR(at.x, 11.5, 1e-9);
  EXPECT_NEAR(at.y, 23.5, 1e-9);
  EXPECT_NEAR(at.z, 0.4, 1e-12);
}

// Infinite far plane, reversed depth from 1 to 0: the projection that many engines use.
TEST(ViewMatrix, NeedsNoFarPlane) {
  const Camera c = camera(Projection::perspective);
  const CameraFrame frame = make_camera_frame(c, width, height);
  Camera farther = c;
  farther.far_m = 1e7;
  const glm::dmat4 finite = make_camera_frame(farther, width, height).clip_from_world();
  glm::dmat4 infinite = finite;  // z' = near, whatever the place
  for (int column = 0; column < 4; ++column) infinite[column][2] = column == 3 ? *c.near_m : 0;
  const ViewMatrix view(from_convention(infinite, {.depth_0_to_1 = true, .reversed = true}));
  for (const auto& [x, y] : {std::pair(0, 0), {63, 35}, {30, 4}}) {
    const Ray given = frame.pixel_ray(x, y, width, height), found = view.pixel_ray(x, y, width, height);
    EXPECT_LT(glm::length(found.direction - glm::normalize(given.direction)), 1e-9);
  }
}

TEST(ViewMatrix, OffCentreMovesThePicture) {
  const glm::dmat4 centred = make_camera_frame(camera(Projection::perspective), width, height).clip_from_world();
  glm::dmat4 jitter(1);
  jitter[3][0] = 2.0 / width;  // one pixel to the right
  const Ray moved = ViewMatrix(jitter * centred).pixel_ray(10, 5, width, height),
            other = ViewMatrix(centred).pixel_ray(9, 5, width, height);
  EXPECT_LT(glm::length(moved.direction - other.direction), 1e-12);
}

TEST(ViewMatrix, RefusesWhatHasNoInverse) {
  EXPECT_THROW(ViewMatrix(glm::dmat4(0)), Error);
  glm::dmat4 away = make_camera_frame(camera(Projection::perspective), width, height).clip_from_world();
  for (const double unlike : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    away[1][2] = unlike;
    EXPECT_THROW(ViewMatrix{away}, Error) << unlike;
  }
  Camera far = camera(Projection::perspective);
  far.eye_m.x += 1e15;
  far.target_m.x += 1e15;
  EXPECT_THROW(ViewMatrix(make_camera_frame(far, width, height).clip_from_world()), Error) << "it is not in the world";
  glm::dmat4 infinite(1);
  infinite[2][1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(ViewMatrix{infinite}, Error);
}

}  // namespace
}  // namespace noonmark
