// Where scenes come from: the built-in ones by name, files by path.
//
//   Scene scene = make_scene(settings.scene);
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

// Of the files of models. A .vrm is a GLB.
inline constexpr const char* model_endings[] = {".gltf", ".glb", ".vrm"};

// Whether scene.name is the path of a file rather than a built-in name.
bool names_file(std::string_view scene_name);

// Makes the scene of a built-in name, or of a path that ends in one of model_endings (in upper or lower case), adds a floor if
// settings.floor asks for it, and cuts it into triangles as settings.mesh says. Throws Error(usage) for an unknown name (with the nearest name), and, before
// they are made, for more triangles than are allowed or fit into memory. Throws Error(file) for a file that cannot be
// used.
Scene make_scene(const SceneSettings& settings);

// A camera or a light of the scene's file, by the name of its node or its own. Throws Error(usage) with the nearest name, or
// with the reason why it cannot be used.
const Camera& camera_named(const Scene& scene, std::string_view name);
const Light& light_named(const Scene& scene, std::string_view name);

// "street: 2 animations at rest (...); 1 primitive of lines left out": the scene's notes as one line; empty without
// any.
std::string notes_line(const Scene& scene);

// scenes/fit.cpp, for scenes without a camera or a light: a perspective camera that sees the whole scene from outside,
// or that stands inside a closed room (scenes/interior.h); a light from above and from the side.
Camera fit_camera(const Scene& scene);
Light fit_light(const Scene& scene);

}  // namespace noonmark
