// The camera and the light of the scene that is shown.
#pragma once
#include <optional>
#include <vector>

#include "scenes/gltf/nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// The first camera of the placed nodes; none: nothing. An infinite perspective has no far: it is fitted.
// Aspect ratio and xmag are not used: the picture's shape is the user's. Others are left out, with a note; an invisible
// node's camera is as good as any. Throws Error(scene) where a shear lays the camera's up along its view.
std::optional<Camera> find_camera(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

// The first light of the visible nodes, of any kind; none: nothing. Others are not used, with a note: one light at a
// time is measured. innerConeAngle, range, colour and intensity are not read: lights do not fall off, only what they
// can see is measured. A directional light stands outside the scene; a spot light's target is level with the scene's
// middle, or 1 m ahead. Throws Error(scene) where a spot's cone is wider or narrower than a shadow map can serve.
std::optional<Light> find_light(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace noonmark::gltf
