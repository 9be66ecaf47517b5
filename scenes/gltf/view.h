// The camera and the light of the scene that is shown.
#pragma once
#include <optional>
#include <vector>

#include "scenes/gltf/nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// The first camera of the placed nodes, also of an invisible node; nothing if there is none. An infinite perspective
// has no far plane, so far is fitted. Aspect ratio and xmag are not used, because the user chooses the picture's shape.
// Other cameras are left out, with a note. Throws Error(file) if a shear makes the camera's up parallel to its view.
std::optional<Camera> find_camera(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

// The first light of the visible nodes, of any kind; nothing if there is none. Other lights are left out, with a note,
// because one light at a time is measured. innerConeAngle, range, colour and intensity are not read, because only the
// visibility of a light is measured. A directional light gets a position outside the scene. A spot light's target is
// the point on its axis nearest to the scene's middle, or 1 m ahead. Throws Error(file) if a spot's cone is wider or
// narrower than a shadow map can cover.
std::optional<Light> find_light(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace noonmark::gltf
