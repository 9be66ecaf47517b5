// The frame of a map from its matrix: of every map that Noonmark lays itself, in every convention, it is that map's own frame.
#include "frames/map_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "scenes/library.h"
#include "scenes/view_matrix.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::test {
namespace {

// The inverse of a matrix in double.
constexpr double rounding = 1e-9;

std::string fault_of(const LightFrame& light, const glm::dmat4& matrix) {
  const std::string fault = refusal_of(ErrorKind::file, [&] { map_frame("map.npy", light, matrix, {64, 64}); });
  EXPECT_TRUE(fault.empty() || fault.starts_with("map.npy: ")) << fault;
  return fault;
}

LightFrame frame_of(const char* scene) {
  Settings settings;
  settings.scene.name = scene;
  settings.map.resolution = 64;
  return make_light_frame(make_scene(settings.scene), settings);
}

// Turned about the axis of the light.
glm::dmat4 rolled(double degrees) {
  glm::dmat4 m(1);
  const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  m[0][0] = c, m[1][0] = -s, m[0][1] = s, m[1][1] = c;
  return m;
}

TEST(MapFrame, IsTheFrameOfItsMatrix) {
  for (const char* scene : {"cube-room", "plane", "spot-room"})
    for (const double roll : {0.0, 33.0, 90.0, 180.0}) {
      SCOPED_TRACE(scene);
      const LightFrame light = frame_of(scene);
      const glm::dmat4 matrix = rolled(roll) * light.clip_from_world(0);
      const MapFrame map = map_frame("map.npy", light, matrix, {64, 64});
      EXPECT_FALSE(map.mirrored);
      EXPECT_EQ(map.frame.resolution, 64);
      for (const glm::dvec3 p : {glm::dvec3(0.3, 0.2, -0.4), {1, 0, 1}, {-2, 0.5, 0.1}}) {
        const glm::dvec4 clip = matrix * glm::dvec4(p, 1);
        const glm::dvec3 q = map.frame.to_light(p);
        const glm::dvec2 texels = map.frame.map_texels(q);
        EXPECT_NEAR(texels.x, 32 * (clip.x / clip.w + 1), rounding * 64);
        EXPECT_NEAR(texels.y, 32 * (clip.y / clip.w + 1), rounding * 64);
        EXPECT_NEAR(map.frame.window_depth(q), (clip.z / clip.w + 1) / 2, rounding);
      }
      EXPECT_LT(glm::distance(map.frame.direction_to_light({1, 0, 0}), light.direction_to_light({1, 0, 0})), rounding);
    }
}

TEST(MapFrame, OfAMirroredMatrixIsMirrored) {
  for (const char* scene : {"cube-room", "spot-room"}) {
    const LightFrame light = frame_of(scene);
    glm::dmat4 flip(1);
    flip[1][1] = -1;
    const glm::dmat4 matrix = flip * light.clip_from_world(0);
    const MapFrame map = map_frame("map.npy", light, matrix, {64, 64});
    EXPECT_TRUE(map.mirrored);
    const glm::dvec3 p(0.3, 0.2, -0.4);
    const glm::dvec4 clip = matrix * glm::dvec4(p, 1);
    EXPECT_NEAR(map.frame.map_texels(map.frame.to_light(p)).y, 32 * (1 - clip.y / clip.w), rounding * 64);
  }
}

// Twice as wide as high, in texels and in the world.
TEST(MapFrame, OfSquareTexelsMayBeOfAnyShape) {
  const LightFrame sun = frame_of("cube-room"), spot = frame_of("spot-room");
  glm::dmat4 flat(1);
  flat[1][1] = 2;
  const glm::dmat4 matrix = flat * sun.clip_from_world(0);
  const MapFrame map = map_frame("map.npy", sun, matrix, {64, 32});
  EXPECT_EQ(map.frame.map_size(), glm::ivec2(64, 32));
  const glm::dvec3 p(0.3, 0.2, -0.4);
  const glm::dvec4 clip = matrix * glm::dvec4(p, 1);
  const glm::dvec2 texels = map.frame.map_texels(map.frame.to_light(p));
  EXPECT_NEAR(texels.x, 32 * (clip.x + 1), rounding * 64);
  EXPECT_NEAR(texels.y, 16 * (clip.y + 1), rounding * 64);
  EXPECT_NE(fault_of(sun, matrix).find("0.5 times as high as wide"), std::string::npos) << fault_of(sun, matrix);
  EXPECT_THROW(map_frame("map.npy", spot, flat * spot.clip_from_world(0), {64, 32}), Error);
}

TEST(MapFrame, OfAnotherLightIsNamed) {
  const LightFrame sun = frame_of("cube-room"), spot = frame_of("spot-room");
  EXPECT_NE(fault_of(sun, spot.clip_from_world(0)).find("perspective"), std::string::npos);
  EXPECT_NE(fault_of(spot, sun.clip_from_world(0)).find("orthographic"), std::string::npos);
  EXPECT_NE(fault_of(frame_of("point-room"), sun.clip_from_world(0)).find("six maps"), std::string::npos);
  glm::dmat4 matrix = sun.clip_from_world(0);
  matrix[0] *= 1.001;
  EXPECT_NE(fault_of(sun, matrix).find("not square"), std::string::npos) << "a stretched map";
  glm::dmat4 wide(1);
  wide[0][0] = 0.5;
  EXPECT_NE(fault_of(sun, wide * sun.clip_from_world(0)).find("not square"), std::string::npos);
  glm::dmat4 reversed(1);
  reversed[2][2] = -1;
  EXPECT_NE(fault_of(sun, reversed * sun.clip_from_world(0)).find("180 degrees"), std::string::npos);
  LightFrame moved = spot;
  moved.origin_m += glm::dvec3(0.1, 0, 0);
  EXPECT_NE(fault_of(moved, spot.clip_from_world(0)).find("is drawn from"), std::string::npos);
  glm::dmat4 off(1);
  off[2][0] = 0.1;  // x grows with z of clip space, which is not the depth along the axis
  EXPECT_FALSE(fault_of(spot, off * spot.clip_from_world(0)).empty());
  EXPECT_NE(fault_of(sun, glm::dmat4(0)).find("no inverse"), std::string::npos);
}

}  // namespace
}  // namespace noonmark::test
