// The built-in scenes with their default settings, for the tests that look at each of them.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/builtin.h"
#include "scenes/library.h"

namespace noonmark::test {

inline std::vector<Scene> all_scenes() {
  std::vector<Scene> scenes;
  for (const BuiltinScene& builtin : builtin_scenes())
    scenes.push_back(make_scene({.name = std::string(builtin.name)}));
  return scenes;
}

inline const Scene& named(const std::vector<Scene>& scenes, std::string_view name) {
  return *std::find_if(scenes.begin(), scenes.end(), [&](const Scene& s) { return s.name == name; });
}

inline glm::dvec3 corner(const Scene& scene, uint32_t triangle, int i) {
  return scene.positions[scene.triangles[triangle][i]];
}

}  // namespace noonmark::test
