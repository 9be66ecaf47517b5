// A hash over everything in a scene that can change a measurement. Two scenes with equal hashes give equal results.
//
//   if (scene_digest(make_scene(settings.scene)) != remembered) measure_anew();
#pragma once
#include <string>

#include "scenes/scene.h"

namespace noonmark {

// Of every member of Scene and of what it holds, but for names: they change no number. The list of members is in
// scene_digest.cpp and is complete by construction: a member that is added to one of these structs and not to that list
// does not compile.
std::string scene_digest(const Scene& scene);

}  // namespace noonmark
