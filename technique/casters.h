// The scene's vertices as they are drawn into the map, when a part of the bias moves the caster
// (technique/bias_parts.h).
//
//   if (bias.moves_casters()) renderer.render_map(frame, settings, &ms, caster_positions(scene, frame, bias));
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"
#include "technique/bias.h"
#include "technique/light_frame.h"

namespace noonmark {

// Unit vectors in the world: the normalised sum of the area vectors of the faces that share the vertex's index. They
// are computed because scenes have no vertex normals. A vertex gets 0 if none of its faces has an area.
std::vector<glm::vec3> vertex_normals(const Scene& scene);

// The moved vertices, computed in double and rounded once to float. The map on the GPU and the exact map both use these
// vertices, so a part of the caster needs no shader. A part's amount is in texels at the vertex. A vertex behind a spot
// light is not moved, because a texel has no size there.
std::vector<glm::vec3> caster_positions(const Scene& scene, const LightFrame& frame, const Bias& bias);

}  // namespace noonmark
