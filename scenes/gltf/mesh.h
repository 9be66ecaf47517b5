// The triangles of the placed nodes, in world space.
#pragma once
#include <vector>

#include "scenes/gltf/buffers.h"
#include "scenes/gltf/nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// Appends positions, triangles and parts. What is drawn:
// - triangles, strips and fans; points and lines have no area to cast a shadow and are left out;
// - positions with their morph targets (morph.h), where the node's place or its skin's joints put them
//   (skin.h), once for each instance of the node (instances.h), out of Draco's data where there are any
//   (draco.h);
// - not a primitive whose material masks it wholly (MASK, no base colour texture, alpha below the cutoff). A masking
//   texture is not read, so such a primitive is drawn whole;
// - only the vertices that some triangle uses;
// - no degenerate triangle: two equal corners, or corners in a line as far as double arithmetic tells. It has no normal
//   and hides nothing. Scene::notes says how many: triangles are numbered without them.
// A transform that mirrors reverses the winding, so that outsides stay outsides. A transform that flattens keeps the
// order of the corners, and keeps only the triangles that still have an area. Triangles whose material is not
// doubleSided are marked in scene.single_sided. Throws Error(scene) for indices that are out of range or mean restart;
// for positions that are not finite or beyond max_coordinate_m; for more triangles than max_triangles or than fit into
// the available memory (scenes/memory.h); and for everything that the files named above refuse. Returns how many
// triangles without an area were left out.
uint64_t append_geometry(const Document& document, Buffers& buffers, const Placement& placement, Scene& scene);

}  // namespace noonmark::gltf
