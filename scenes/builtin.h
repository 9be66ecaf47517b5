// The built-in scenes, each small and made to provoke something.
#pragma once
#include <array>
#include <span>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

struct BuiltinScene {
  std::string_view name;
  std::string_view provokes;  // what the scene is made to show
  Scene (*make)(const SceneSettings&);
  std::array<std::string_view, 4> reads{};  // the settings that `make` reads, "scene.theta_deg"; unused ones are ""
};

std::span<const BuiltinScene> builtin_scenes();

// The scenes with files of their own. Of these, layers, crease and stairs show where a filtered map leaks and where it is too dark:
// the light shines straight down, and the floor is square to it at three quarters of the map's depth, which a float holds
// exactly. street and hills-walk are 80 m deep, seen at eye height along their length: one shadow map of all of it has texels
// that are too large near the camera. lab is a room with several lights.
Scene layers(const SceneSettings& settings);
Scene crease(const SceneSettings& settings);
Scene stairs(const SceneSettings& settings);
Scene street(const SceneSettings& settings);
Scene hills_walk(const SceneSettings& settings);
Scene lab(const SceneSettings& settings);

}  // namespace noonmark
