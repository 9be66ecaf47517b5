#include "scenes/gltf/notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "scenes/gltf/masks.h"

namespace noonmark::gltf {

std::string counted(uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string_view is_or_are(uint64_t count) { return count == 1 ? "is" : "are"; }

namespace {

// The contents of the shown nodes beside visible triangles.
struct Unseen {
  uint64_t meshes = 0;  // nodes that have one
  uint64_t hidden = 0, collapsed = 0;
  uint64_t points = 0, lines = 0;
  uint64_t masked_out = 0;  // primitives
  std::set<int> materials;  // the materials of the triangles
};

Unseen unseen(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes) {
  Unseen out;
  std::set<int> meshes;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.nodes[placed.node];
    if (node.mesh == -1) continue;
    ++out.meshes;
    out.hidden += !placed.visible;
    out.collapsed += placed.visible && placed.collapsed && node.skin == -1;
    if (placed.visible) meshes.insert(node.mesh);
  }
  for (int mesh : meshes) {
    for (const tinygltf::Primitive& primitive : model.meshes[static_cast<size_t>(mesh)].primitives) {
      out.points += primitive.mode == TINYGLTF_MODE_POINTS;
      out.lines += primitive.mode > TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES;
      out.masked_out += primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.material != -1 &&
                        masked_out(model.materials[static_cast<size_t>(primitive.material)]);
      if (primitive.material != -1 && primitive.mode >= TINYGLTF_MODE_TRIANGLES)
        out.materials.insert(primitive.material);
    }
  }
  return out;
}

}  // namespace

std::string instead_of_triangles(const Document& document, const std::vector<PlacedNode>& nodes,
                                 uint64_t without_area) {
  const Unseen found = unseen(document.model, nodes);
  std::vector<std::string> parts;
  const auto add = [&](uint64_t count, std::string_view noun, std::string_view what) {
    if (count > 0) parts.push_back(counted(count, noun) + std::string(what));
  };
  add(found.points, "primitive", " of points");
  add(found.lines, "primitive", " of lines");
  add(found.masked_out, "primitive", " whose alphaMode MASK shows nothing, because its alpha is below alphaCutoff");
  add(without_area, "triangle", " without an area");
  add(found.hidden, "node", " with a mesh hidden by KHR_node_visibility");
  add(found.collapsed, "node", " with a mesh scaled to zero");
  if (found.meshes == 0) parts.push_back("no node has a mesh");
  return parts.empty() ? "" : fmt::format(": {}", fmt::join(parts, ", "));
}

void note_contents(const Document& document, const std::vector<PlacedNode>& nodes, bool masks_are_read,
                   std::vector<std::string>& notes) {
  const tinygltf::Model& model = document.model;
  const Unseen found = unseen(model, nodes);
  uint64_t masks = 0, blends = 0, transmissions = 0;
  for (int index : found.materials) {
    const tinygltf::Material& material = model.materials[static_cast<size_t>(index)];
    masks += masks_by_texture(material);
    blends += material.alphaMode == "BLEND";
    transmissions += material.extensions.contains("KHR_materials_transmission");
  }
  if (found.points > 0) notes.push_back(counted(found.points, "primitive") + " of points left out");
  if (found.lines > 0) notes.push_back(counted(found.lines, "primitive") + " of lines left out");
  if (found.collapsed > 0) notes.push_back(counted(found.collapsed, "node") + " with a mesh scaled to zero, not drawn");
  if (masks > 0 && !masks_are_read)
    notes.push_back(counted(masks, "material") + " masked by a texture taken as opaque (scene.masks = false)");
  if (blends > 0) notes.push_back(counted(blends, "material") + " with alphaMode BLEND taken as opaque");
  if (transmissions > 0)
    notes.push_back(fmt::format("{} that transmit{} light taken as opaque", counted(transmissions, "material"),
                                transmissions == 1 ? "s" : ""));
  if (document.guarded.animations > 0 && document.guarded.animation.is_null())
    notes.push_back(counted(document.guarded.animations, "animation") + " at rest (scene.time_s poses the scene)");
}

}  // namespace noonmark::gltf
