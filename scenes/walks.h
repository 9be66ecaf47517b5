// The built-in scenes street and hills-walk: 80 m deep, seen at eye height along their length. One shadow map of all of
// it has texels that are too large near the camera, so they need maps that follow the view, or several of them.
#pragma once
#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

Scene street(const SceneSettings& settings);
Scene hills_walk(const SceneSettings& settings);

}  // namespace noonmark
