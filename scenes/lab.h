// The built-in scene lab: a room with several lights.
#pragma once
#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

Scene lab(const SceneSettings& settings);

}  // namespace noonmark
