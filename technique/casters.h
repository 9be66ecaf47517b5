// The scene's vertices as a map's pass draws them, when a part of the bias moves the caster (technique/bias_parts.h).
//
//   if (bias.moves_casters()) renderer.render_map(frame, settings, &ms, caster_positions(scene, frame, bias));
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"
#include "technique/bias.h"
#include "technique/light_frame.h"

namespace noonmark {

// Unit, in the world: the sum of the area vectors of the faces that share the vertex's index. Scenes carry no normals of
// their own. A vertex without a face that has an area: 0.
std::vector<glm::vec3> vertex_normals(const Scene& scene);

// Computed in double, each rounded once to float. The drawn map and the exact one both use these vertices, so a part of
// the caster needs no shader. A part's amount is in texels at the vertex; behind a spot light, where no texel has a size, a
// vertex stays.
std::vector<glm::vec3> caster_positions(const Scene& scene, const LightFrame& frame, const Bias& bias);

}  // namespace noonmark
