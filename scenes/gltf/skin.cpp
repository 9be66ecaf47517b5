#include "scenes/gltf/skin.h"

#include <fmt/format.h>

#include <utility>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view skin_remedy = "export the file again";

bool is_integer(const tinygltf::Accessor& a) {
  return a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

}  // namespace

glm::dmat4 SkinnedVertices::world_from_mesh(uint32_t vertex) const {
  glm::dmat4 sum(0);
  double total = 0;
  for (const auto& [joints, weights] : attributes_) {
    for (size_t k = 0; k < 4; ++k) {
      const double weight = weights->value(vertex, k);
      if (weight == 0) continue;
      const uint32_t joint = joints->index(vertex, k);
      if (!(weight > 0) || joint >= joints_.size()) {
        refuse(file_, place_,
               weight > 0 ? fmt::format("vertex {} follows joint {} of {}", vertex, joint, joints_.size())
                          : fmt::format("vertex {} has a weight of {}", vertex, weight),
               skin_remedy);
      }
      sum += weight * joints_[joint];
      total += weight;
    }
  }
  if (!(total > 0))
    refuse(
        file_, place_,
        fmt::format("vertex {} under a skin has no weights (their sum is 0), so glTF gives it no place: the sum has to "
                    "be 1 (glTF 2.0, section 3.7.3.3)",
                    vertex),
        "give its vertices joints and weights, or take the skin from the node");
  return sum / total;
}

const std::vector<glm::dmat4>& Skins::joints(int skin) {
  if (const auto known = joints_.find(skin); known != joints_.end()) return known->second;
  const tinygltf::Skin& from = document_.model.skins[static_cast<size_t>(skin)];
  std::vector<glm::dmat4> made;
  for (size_t i = 0; i < from.joints.size(); ++i) {
    made.push_back(world_from_node_[static_cast<size_t>(from.joints[i])]);
    if (from.inverseBindMatrices != -1) made.back() *= readers_(from.inverseBindMatrices).mat4(i);
  }
  return joints_[skin] = std::move(made);
}

std::string Skins::place_of(int mesh, size_t primitive) {
  return fmt::format("meshes[{}].primitives[{}].attributes", mesh, primitive);
}

std::vector<std::pair<int, int>> Skins::attribute_pairs(int mesh, size_t primitive, size_t count) const {
  const tinygltf::Model& model = document_.model;
  const auto& attributes = model.meshes[static_cast<size_t>(mesh)].primitives[primitive].attributes;
  const std::string place = place_of(mesh, primitive);
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [name, joints] : attributes) {
    if (!name.starts_with("JOINTS_")) continue;
    const auto found = attributes.find("WEIGHTS_" + name.substr(7));
    if (found == attributes.end()) refuse(document_.file, place, name + " without its weights", skin_remedy);
    for (int index : {joints, found->second}) {
      const bool there = index >= 0 && static_cast<size_t>(index) < model.accessors.size();
      const tinygltf::Accessor* a = there ? &model.accessors[static_cast<size_t>(index)] : nullptr;
      const bool of_joints = index == joints;
      if (!there || document_.guarded.unknown_accessors.contains(static_cast<size_t>(index)) ||
          a->type != TINYGLTF_TYPE_VEC4 || a->count != count ||
          !(of_joints ? is_integer(*a) && !a->normalized
                      : a->componentType == TINYGLTF_COMPONENT_TYPE_FLOAT || (is_integer(*a) && a->normalized))) {
        refuse(document_.file, fmt::format("{}.{}", place, of_joints ? name : found->first),
               fmt::format("accessors[{}] is not a list of {} {}", index, count, of_joints ? "joints" : "weights"),
               skin_remedy);
      }
    }
    pairs.emplace_back(joints, found->second);
  }
  if (pairs.empty())
    refuse(document_.file, place,
           "a mesh under a skin without JOINTS_0 and WEIGHTS_0, which it has to have (glTF 2.0, section 3.7.3.3)",
           "give its vertices joints and weights, or take the skin from the node");
  return pairs;
}

}  // namespace noonmark::gltf
