// Shared by the OpenGL tests: small scenes, and a Renderer whose driver errors are fatal.
#pragma once
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "base/error.h"
#include "gl/renderer.h"
#include "scenes/shapes.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::gl {

class GlTest : public testing::Test {
 protected:
  Renderer renderer{DebugMode::fatal};
};

// Looks straight down on the origin from 10 m; the picture's right is +X and its top is -Z.
inline Camera camera_from_above(double height_m) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.eye_m = {0, 10, 0};
  camera.target_m = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.height_m = height_m;
  camera.near_m = 1;
  camera.far_m = 20;
  return camera;
}

// A square in the plane y, facing up, of the given half size.
inline void add_floor(Scene& scene, double y, double half) {
  add_quad(scene, "floor", {-half, y, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

// A light straight above the origin, 10 m up: distance along its axis is 10 - y.
inline Light light_from_above() {
  Light light;
  light.position_m = {0, 10, 0};
  light.target_m = {0, 0, 0};
  return light;
}

inline bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

}  // namespace noonmark::gl
