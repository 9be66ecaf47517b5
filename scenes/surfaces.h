// The connected surfaces of a scene: sets of triangles that hang together over shared vertices.
#pragma once
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace noonmark {

// The surface of each triangle, as the index of its first triangle. Two triangles are of one surface if a chain of
// triangles leads from one to the other in which each has a corner of the next. Corners are the same if their positions
// are exactly equal.
std::vector<uint32_t> surfaces_of(const Scene& scene);

}  // namespace noonmark
