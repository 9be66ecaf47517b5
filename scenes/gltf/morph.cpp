#include "scenes/gltf/morph.h"

#include <fmt/format.h>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {

MorphedPositions::MorphedPositions(const Document& document, Readers& readers, const AccessorReader& base,
                                   const tinygltf::Node& node, size_t primitive)
    : base_(&base) {
  constexpr std::string_view remedy = "export the file again";
  const tinygltf::Mesh& mesh = document.model.meshes[static_cast<size_t>(node.mesh)];
  const auto& targets = mesh.primitives[primitive].targets;
  const std::vector<double>& weights = !node.weights.empty() ? node.weights : mesh.weights;
  const std::string place = fmt::format("meshes[{}].primitives[{}].targets", node.mesh, primitive);
  if (!weights.empty() && weights.size() != targets.size())
    refuse(document.file, place, fmt::format("{} morph targets, but {} weights", targets.size(), weights.size()),
           remedy);
  for (size_t i = 0; i < weights.size(); ++i) {
    const auto found = targets[i].find("POSITION");
    if (weights[i] == 0 || found == targets[i].end()) continue;
    const AccessorReader& target = readers(found->second);
    if (target.count() != base.count())
      refuse(document.file, fmt::format("{}[{}].POSITION", place, i),
             fmt::format("{} vertices, but the mesh has {}", target.count(), base.count()), remedy);
    targets_.emplace_back(weights[i], &target);
  }
}

}  // namespace noonmark::gltf
