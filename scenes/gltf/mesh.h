// Makes the triangles of the placed nodes, in world space.
#pragma once
#include <vector>

#include "scenes/gltf/buffers.h"
#include "scenes/gltf/nodes.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

// Appends positions, triangles and parts. It draws:
// - triangles, strips and fans. Points and lines are left out, because they have no area that casts a shadow;
// - positions with their morph targets (morph.h), moved by the node's transform or by its skin's joints (skin.h), once
//   for each instance of the node (instances.h), read from Draco's data if there are any (draco.h);
// - a primitive once, if others of its mesh have the same data, mode and material. Scene::notes says how many have;
// - no primitive that its material masks completely (MASK, no base colour texture, alpha below the cutoff);
// - of a primitive that a texture masks, what the mask shows (masks.h), cut out of its triangles. Without `masks` the
//   texture is not read, and the primitive is drawn completely;
// - only the vertices that a triangle uses;
// - no degenerate triangle: two equal corners, or corners in a line within double arithmetic. Such a triangle has no
//   normal and hides nothing. Scene::notes says how many there are, because triangles are numbered without them.
//
// A transform that mirrors reverses the winding, so that outsides stay outsides. A transform that flattens keeps the
// order of the corners, and keeps only the triangles that still have an area. Triangles whose material is not
// doubleSided are marked in scene.single_sided. Throws Error(file) for indices that are out of range or mean restart;
// for positions that are not finite or not in ranges::coordinate_m; for more triangles than max_triangles or than fit into
// the available memory (base/memory.h); and for everything that the files named above refuse. Returns how many
// triangles without an area were left out.
uint64_t append_geometry(const Document& document, Buffers& buffers, const Placement& placement, bool masks,
                         Scene& scene);

}  // namespace noonmark::gltf
