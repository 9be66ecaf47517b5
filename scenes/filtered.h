// The built-in scenes layers, crease and stairs: where a filtered map leaks and where it is too dark. The light shines
// straight down, and the floor is square to it at three quarters of the map's depth, which a float holds exactly.
#pragma once
#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

Scene layers(const SceneSettings& settings);
Scene crease(const SceneSettings& settings);
Scene stairs(const SceneSettings& settings);

}  // namespace noonmark
