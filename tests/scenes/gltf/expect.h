// What every answer of load_gltf must be: a scene that is whole and finite, or one Error(file).
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "base/error.h"
#include "scenes/gltf/gltf.h"

namespace noonmark::test {

inline bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Empty, or what is wrong with the scene.
inline std::string defect_of(const Scene& scene) {
  if (scene.triangles.empty()) return "no triangles";
  for (const glm::vec3& p : scene.positions) {
    if (!finite(p)) return "a position is not finite";
  }
  for (const glm::uvec3& t : scene.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] >= scene.positions.size()) return "an index is out of range";
    }
  }
  if (scene.single_sided.size() != scene.triangles.size()) return "sides for another number of triangles";
  uint64_t in_parts = 0;
  for (const Part& part : scene.parts) {
    if (part.first_triangle != in_parts || part.triangle_count == 0) return "parts do not follow one another";
    in_parts += part.triangle_count;
  }
  if (in_parts != scene.triangles.size()) return "parts do not cover the triangles";
  const Camera& c = scene.camera;
  if (!finite(c.eye_m) || !finite(c.target_m) || !finite(c.up)) return "the camera is not finite";
  if (c.near_m && !(*c.near_m >= 0)) return "the camera's near";
  if (c.far_m && !(c.near_m && *c.far_m > *c.near_m && std::isfinite(*c.far_m))) return "the camera's far";
  if (!(c.fov_y_deg > 0 && c.fov_y_deg < 180) || !(c.height_m > 0) || !std::isfinite(c.height_m))
    return "the camera's angle";
  if (!(glm::length(glm::cross(glm::normalize(c.target_m - c.eye_m), glm::normalize(c.up))) > 1e-6))
    return "the camera's up";
  if (!finite(scene.light.position_m) || !finite(scene.light.target_m)) return "the light is not finite";
  if (!(glm::distance(scene.light.position_m, scene.light.target_m) > 0)) return "the light has no direction";
  return "";
}

// The message of the Error(file) that loading throws. The test fails if the file loads, if another exception is
// thrown, or if the message has two lines, does not begin with the path or has no remedy.
inline std::string refusal(const std::string& path, const Pose& pose = {}) {
  try {
    load_gltf(path, pose);
  } catch (const Error& e) {
    const std::string message = e.what();
    EXPECT_EQ(e.kind(), ErrorKind::file) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with(path + ": ")) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << "no remedy: " << message;
    return message;
  }
  ADD_FAILURE() << path << " was loaded";
  return "";
}

}  // namespace noonmark::test
