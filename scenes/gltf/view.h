// The cameras and the lights of the scene that is shown.
#pragma once
#include <vector>

#include "scenes/gltf/nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// The cameras of the placed nodes, also of invisible nodes. Aspect ratio and xmag are not used, because the user chooses
// the picture's shape; an infinite perspective has no far plane, so far is fitted. If there are several, a note says that
// the first is used. Throws Error(file) if a shear makes the first camera's up parallel to its view; a later camera of this
// kind has no value.
std::vector<Named<Camera>> find_cameras(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

// The lights of the visible nodes, of any kind. Intensity, colour, range and the inner cone weigh
// the lights of one frame (LightPower). A directional light gets a position outside the scene. A spot light's target is
// the point on its axis nearest to the scene's middle, or 1 m ahead. Throws Error(file) if the first light is a spot whose
// cone is wider or narrower than a shadow map can cover; a later light of this kind has no value.
std::vector<Named<Light>> find_lights(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace noonmark::gltf
