// The triangles of the placed nodes, in world space.
#pragma once
#include <vector>

#include "scenes/gltf_buffers.h"
#include "scenes/gltf_nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// Of a whole scene, instances included; more are refused before anything is allocated (12 bytes each, and as much again
// for their vertices, in every stage that follows).
inline constexpr uint64_t max_triangles = uint64_t{1} << 26;

// Appends positions, triangles and parts. What is drawn:
// - triangles, strips and fans; points and lines cast no shadow worth the name and are left out;
// - positions as the accessor has them: skins and morph targets stay unapplied, which is the mesh's modelled pose;
// - not a primitive whose material masks it wholly (MASK, no base colour texture, alpha below the cutoff). A masking
//   texture is not read, so such a primitive is drawn whole;
// - only the vertices that some triangle uses;
// - no degenerate triangle: two equal corners, or corners in a line as far as double arithmetic tells. It has no normal
//   and hides nothing.
// A transform that mirrors flips the winding, so that outsides stay outsides.
// Throws Error(scene): indices out of range or meaning restart, positions not finite or beyond max_coordinate_m, too
// many triangles, or more than fit into the memory that is available (scenes/memory.h).
void append_geometry(const Document& document, Buffers& buffers, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace noonmark::gltf
