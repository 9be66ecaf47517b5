#include "scenes/gltf/contents.h"

#include <algorithm>

#include "scenes/gltf/count_contents.h"

namespace noonmark::gltf {
namespace {

template <class List, class Meant>
uint64_t count_of(const List& list, const Meant& meant) {
  return static_cast<uint64_t>(std::count_if(list.begin(), list.end(), meant));
}

}  // namespace

ModelContents count_contents(const Document& document) {
  const tinygltf::Model& model = document.model;
  const auto materials = [&](const std::string& mode) {
    return count_of(model.materials, [&](const tinygltf::Material& m) { return m.alphaMode == mode; });
  };
  const auto lights = [&](const std::string& type) {
    return count_of(model.lights, [&](const tinygltf::Light& light) { return light.type == type; });
  };
  ModelContents contents;
  contents.scenes = model.scenes.size();
  contents.nodes = model.nodes.size();
  contents.meshes = model.meshes.size();
  for (const tinygltf::Mesh& mesh : model.meshes) contents.primitives += mesh.primitives.size();
  contents.skins = model.skins.size();
  contents.animations = document.guarded.animations;
  contents.morphed_meshes = count_of(model.meshes, [](const tinygltf::Mesh& mesh) {
    return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [](const tinygltf::Primitive& p) { return !p.targets.empty(); });
  });
  contents.materials = model.materials.size();
  contents.masked_materials = materials("MASK");
  contents.blended_materials = materials("BLEND");
  contents.opaque_materials = contents.materials - contents.masked_materials - contents.blended_materials;
  contents.transmitting_materials = count_of(
      model.materials, [](const tinygltf::Material& m) { return m.extensions.contains("KHR_materials_transmission"); });
  contents.double_sided_materials =
      count_of(model.materials, [](const tinygltf::Material& m) { return m.doubleSided; });
  contents.cameras = model.cameras.size();
  contents.directional_lights = lights("directional");
  contents.spot_lights = lights("spot");
  contents.point_lights = lights("point");
  return contents;
}

}  // namespace noonmark::gltf
