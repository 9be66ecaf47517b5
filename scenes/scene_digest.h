// A hash over everything in a scene that can change a measurement. Two scenes with equal hashes give equal results.
//
//   if (scene_digest(make_scene(settings.scene)) != remembered) measure(settings);
#pragma once
#include <string>

#include "scenes/scene.h"

namespace noonmark {

// Covers every member of Scene and of its parts, except names, which change no number. scene_digest.cpp has the list of
// members. The list is always complete: if somebody adds a member to one of these structs and not to the list, the
// program does not compile.
std::string scene_digest(const Scene& scene);

}  // namespace noonmark
