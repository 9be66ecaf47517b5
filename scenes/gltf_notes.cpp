#include "scenes/gltf_notes.h"

#include <fmt/format.h>

#include <set>

namespace noonmark::gltf {

std::string counted(uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void note_contents(const Document& document, const std::vector<PlacedNode>& nodes, std::vector<std::string>& notes) {
  const tinygltf::Model& model = document.model;
  std::set<int> meshes, materials;
  for (const PlacedNode& placed : nodes) {
    if (const int mesh = model.nodes[placed.node].mesh; mesh != -1 && placed.visible) meshes.insert(mesh);
  }
  uint64_t points = 0, lines = 0;
  for (int mesh : meshes) {
    for (const tinygltf::Primitive& primitive : model.meshes[static_cast<size_t>(mesh)].primitives) {
      points += primitive.mode == TINYGLTF_MODE_POINTS;
      lines += primitive.mode > TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES;
      if (primitive.material != -1 && primitive.mode >= TINYGLTF_MODE_TRIANGLES) materials.insert(primitive.material);
    }
  }
  uint64_t masks = 0, blends = 0, transmissions = 0;
  for (int index : materials) {
    const tinygltf::Material& material = model.materials[static_cast<size_t>(index)];
    masks += material.alphaMode == "MASK" && material.pbrMetallicRoughness.baseColorTexture.index != -1;
    blends += material.alphaMode == "BLEND";
    transmissions += material.extensions.contains("KHR_materials_transmission");
  }
  if (points > 0) notes.push_back(counted(points, "primitive") + " of points left out");
  if (lines > 0) notes.push_back(counted(lines, "primitive") + " of lines left out");
  if (masks > 0) notes.push_back(counted(masks, "material") + " masked by a texture (alphaMode MASK) taken as opaque");
  if (blends > 0) notes.push_back(counted(blends, "material") + " with alphaMode BLEND taken as opaque");
  if (transmissions > 0) notes.push_back(counted(transmissions, "material") + " that transmit light taken as opaque");
  if (document.guarded.animations > 0 && document.guarded.animation.is_null())
    notes.push_back(counted(document.guarded.animations, "animation") + " at rest (scene.time_s poses the scene)");
}

}  // namespace noonmark::gltf
