// What a glTF file holds, counted for people. A scene has only what is measured (scenes/scene.h).
//
//   const Model model = load_model("street.glb");
//   print(model.contents.meshes, model.scene.triangles.size());
#pragma once
#include <cstdint>
#include <string>

#include "scenes/gltf/gltf.h"

namespace noonmark {

// Counts of the whole file, also of what its default scene does not show.
struct ModelContents {
  uint64_t scenes = 0, nodes = 0, meshes = 0, primitives = 0;
  uint64_t skins = 0, animations = 0;
  uint64_t morphed_meshes = 0;  // meshes with morph targets
  uint64_t materials = 0;       // the three kinds of alphaMode add up to it
  uint64_t opaque_materials = 0, masked_materials = 0, blended_materials = 0;
  uint64_t transmitting_materials = 0, double_sided_materials = 0;
  uint64_t cameras = 0;
  uint64_t directional_lights = 0, spot_lights = 0, point_lights = 0;  // KHR_lights_punctual
  bool gives_camera = false, gives_light = false;  // the shown scene has one, so that none was fitted
};

struct Model {
  Scene scene;
  ModelContents contents;
};

// As load_gltf(). Throws Error(file).
Model load_model(const std::string& path, const Pose& pose = {}, bool masks = true);

}  // namespace noonmark
