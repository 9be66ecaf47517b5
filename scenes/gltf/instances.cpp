#include "scenes/gltf/instances.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view instance_remedy = "export the file again, or without instances";

std::string place_of_instances(size_t node) {
  return fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing", node);
}

// The accessor of the attribute with that name, or -1.
int attribute(const Document& document, size_t node, const char* name) {
  const tinygltf::ExtensionMap& extensions = document.model.nodes[node].extensions;
  const auto found = extensions.find("EXT_mesh_gpu_instancing");
  if (found == extensions.end() || !found->second.Get("attributes").Has(name)) return -1;
  return found->second.Get("attributes").Get(name).GetNumberAsInt();
}

}  // namespace

uint64_t instance_count(const Document& document, size_t node) {
  std::optional<uint64_t> count;
  for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"}) {
    const int index = attribute(document, node, name);
    if (index == -1) continue;
    const std::string place = place_of_instances(node) + ".attributes." + name;
    const auto& accessors = document.model.accessors;
    if (static_cast<size_t>(index) >= accessors.size())
      refuse(document.file, place, fmt::format("{} refers beyond the {} accessors", index, accessors.size()),
             instance_remedy);
    const tinygltf::Accessor& a = accessors[static_cast<size_t>(index)];
    const bool rotation = std::string_view(name) == "ROTATION";
    const bool small = a.normalized && (a.componentType == TINYGLTF_COMPONENT_TYPE_BYTE ||
                                        a.componentType == TINYGLTF_COMPONENT_TYPE_SHORT);
    if (document.guarded.unknown_accessors.contains(static_cast<size_t>(index)) ||
        a.type != (rotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3) ||
        !(a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT || (rotation && small)))
      refuse(document.file, place, fmt::format("accessors[{}] is of another type", index), instance_remedy);
    if (count && *count != a.count)
      refuse(document.file, place, fmt::format("{} instances, and {} in another attribute", a.count, *count),
             instance_remedy);
    count = a.count;
  }
  return count.value_or(1);
}

Instances::Instances(const Document& document, Readers& readers, size_t node) : document_(document), node_(node) {
  const auto find = [&](const char* name) {
    const int index = attribute(document, node, name);
    return index == -1 ? nullptr : &readers(index);
  };
  translation_ = find("TRANSLATION");
  rotation_ = find("ROTATION");
  scale_ = find("SCALE");
}

glm::dmat4 Instances::node_from_mesh(size_t i) const {
  glm::dmat3 axes(1);
  if (rotation_ != nullptr) {
    const glm::dquat q(rotation_->value(i, 3), rotation_->value(i, 0), rotation_->value(i, 1), rotation_->value(i, 2));
    // With 8 bits a quaternion's length is within 1% of 1.
    constexpr double tolerance = 0.02;
    if (!(std::abs(glm::length(q) - 1) < tolerance))
      refuse(document_.file, place_of_instances(node_) + ".attributes.ROTATION",
             fmt::format("instance {} has a quaternion of length {} instead of 1", i, glm::length(q)), instance_remedy);
    axes = glm::mat3_cast(glm::normalize(q));
  }
  const auto finite = [&](const glm::dvec3& v, const char* name) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      refuse(document_.file, fmt::format("{}.attributes.{}", place_of_instances(node_), name),
             fmt::format("instance {} is not finite", i), instance_remedy);
    return v;
  };
  const glm::dvec3 scale = scale_ != nullptr ? finite(scale_->vec3(i), "SCALE") : glm::dvec3(1);
  glm::dmat4 m(1);
  for (int axis = 0; axis < 3; ++axis) m[axis] = glm::dvec4(axes[axis] * scale[axis], 0);
  if (translation_ != nullptr) m[3] = glm::dvec4(finite(translation_->vec3(i), "TRANSLATION"), 1);
  return m;
}

}  // namespace noonmark::gltf
