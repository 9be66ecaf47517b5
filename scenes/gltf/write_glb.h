// Writes a scene as a .glb, so that another renderer can show the same triangles, camera and light.
//
//   write_file_atomically("cube-room.glb", glb_of(scene, camera, light));
#pragma once
#include <span>
#include <string>

#include "scenes/scene.h"

namespace noonmark {

// The bytes of a binary glTF 2.0 file: a node and a mesh for each part, with the geometric normal of each triangle, a
// perspective or orthographic camera, and the light by KHR_lights_punctual. camera: with near and far
// (effective_camera). Positions are the scene's floats, in the scene's order, so the loader makes the same triangles of
// them. more_lights: written after `light`, with their names; those without a value are left out. Not in the file, because glTF has no place for it: the light's size, and the scene's own map volume.
// Throws std::logic_error if the camera has no near or far.
std::string glb_of(const Scene& scene, const Camera& camera, const Light& light,
                   std::span<const Named<Light>> more_lights = {});

}  // namespace noonmark
