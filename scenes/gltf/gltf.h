// The glTF loader: makes a scene of a .gltf or .glb file.
//
//   Scene scene = load_gltf("street.glb", {.time_s = 1.5});
#pragma once
#include <optional>
#include <string>

#include "scenes/scene.h"

namespace noonmark {

// The pose of a file's scene: at rest, or at a time of one of its animations.
struct Pose {
  std::optional<double> time_s;  // empty: at rest
  int animation = 0;
};

// It reads nothing outside the file's own folder. masks: whether the alpha masks of materials (MASK) are cut out of the
// triangles; only then images are read, and only those of masks. If the file has no camera or no light, one is fitted.
// Throws Error(file).
Scene load_gltf(const std::string& path, const Pose& pose = {}, bool masks = true);

}  // namespace noonmark
