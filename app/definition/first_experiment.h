// The experiment that `noonmark init` writes for a model: a file to start from, with the reason for each line.
//
//   write_file_atomically("helmet.toml", first_experiment(load_model("helmet.glb"), "helmet.glb"));
#pragma once
#include <string>

#include "scenes/gltf/contents.h"

namespace noonmark {

// The text of the TOML file. path: of the model, as the file is to name it: absolute, or from the file's own folder.
// Throws Error(usage) for a path that is not UTF-8, which TOML cannot hold.
// - Camera: the file's, or the fitted one.
// - Light: the file's. Without one a sun, or in a closed room, which no sun reaches, a point light.
// - A floor if the model has no ground (has_ground) and stands in the open.
// - A directional light's map is fitted to the view.
// - The sweep: four resolutions and four constant biases in texels, which mean the same at each resolution.
std::string first_experiment(const Model& model, const std::string& path);

}  // namespace noonmark
