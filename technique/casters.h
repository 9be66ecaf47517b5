// The scene's vertices as they are drawn into the map, when a part of the bias (technique/bias_parts.h) or map.pancake
// moves the caster.
//
//   if (moves_casters(map, bias)) use(caster_positions(scene, frame, map, bias));
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"
#include "technique/bias.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

// Unit vectors in the world: those of the scene's file, which engines move vertices along; where it gives none, the normalised
// sum of the area vectors of the faces that share the vertex's index. A vertex without both gets 0.
std::vector<glm::vec3> vertex_normals(const Scene& scene);

// The moved vertices, computed in double and rounded once to float. The map on the GPU and the exact map both use these
// vertices, so a part of the caster needs no shader. A part's amount is in texels at the vertex. A vertex behind a spot
// light is not moved, because a texel has no size there. map.pancake then moves each vertex that lies before the near
// plane onto this plane, along the light ("shadow pancaking", as Unity draws its directional lights). A triangle that the
// plane cuts has other depths after that, also behind the plane.
std::vector<glm::vec3> caster_positions(const Scene& scene, const LightFrame& frame, const MapSettings& map,
                                        const Bias& bias);

inline bool moves_casters(const MapSettings& map, const Bias& bias) { return map.pancake || bias.moves_casters(); }

}  // namespace noonmark
