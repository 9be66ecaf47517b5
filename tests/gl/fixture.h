// Shared by the OpenGL tests: small scenes, and a Renderer whose driver errors are fatal.
#pragma once
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "base/error.h"
#include "gl/renderer.h"
#include "scenes/shapes.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::gl {

class GlTest : public testing::Test {
 protected:
  Renderer renderer{DebugMode::fatal};

  // How far the depth (or another quantity) of a drawn triangle lies from that of its plane, because its vertices move to
  // whole 1 / 2^GL_SUBPIXEL_BITS of a texel. gradient: its change along a texel's two axes. Mesa's software renderers
  // interpolate from the vertices as they were.
  double moved_vertices_error(glm::dvec2 gradient) const {
    if (renderer.info().software) return 0;
    return (std::abs(gradient.x) + std::abs(gradient.y)) * std::exp2(-1 - renderer.info().subpixel_bits);
  }
  // Of storing a fixed-point depth, in its steps. A GPU need not round to the nearest: Direct3D allows it 0.6 of a step
  // ("Data Conversion Rules", FLOAT to UNORM), and OpenGL 4.5 (2.3.5) says nothing stricter. An H100 took 0.56.
  double rounding_of_a_step() const { return renderer.info().software ? 0.5 : 0.6; }
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
