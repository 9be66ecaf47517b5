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

}  // namespace noonmark
