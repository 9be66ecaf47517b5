// The camera and the light of the scene that is shown.
#pragma once
#include <optional>
#include <vector>

#include "scenes/gltf_nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// The first camera of the placed nodes; none: nothing. An infinite perspective gets a far plane behind the whole scene.
// Aspect ratio and xmag are not used: the picture's shape is the user's. Throws Error(scene) where a shear lays the
// camera's up along its view.
std::optional<Camera> find_camera(const Document& document, const std::vector<PlacedNode>& nodes, const Scene& scene);

// The first directional light of the placed nodes. Where there is none, a directional light that stands in for the
// first spot (along its axis) or point light (from it to the scene's centre), which cannot be rendered yet; for a point
// light within the scene's inner tenth that direction means nothing, and there is nothing either.
std::optional<Light> find_light(const Document& document, const std::vector<PlacedNode>& nodes, const Scene& scene);

}  // namespace noonmark::gltf
