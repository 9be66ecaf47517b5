// Which of a scene's lights a point measures.
//
//   const ChosenLight chosen = chosen_light(scene, settings.light);
#pragma once
#include <optional>
#include <string>

#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

struct ChosenLight {
  Light light;           // as the scene has it, but for its kind if that is made up
  bool first = true;     // it is Scene::light, for which the scene's own map volume was chosen
  bool made_up = false;  // light.kind asks for a kind that the light chosen is not
};

// light.name, or light.index, chooses one of Scene::lights; light.kind alone chooses the scene's light if it is of that kind, or
// else the first of that kind. Where there is none, the light chosen stays at its place and becomes one of that kind, which is
// made up. Throws SettingConflict for a name or an index that the scene does not have, or whose light cannot be used.
ChosenLight chosen_light(const Scene& scene, const LightSettings& settings);

// "model: has 3 lights, and this is the first; light.name or light.index gives another, and lights = \"all\" in an experiment measures all",
// where nothing chooses among several. Else empty.
std::string first_of_several_note(const Scene& scene, const Settings& settings);

// What a user must know of a light that is made up: "cube-room has no point light: light.kind makes one at -2, 4, -1 m, where its
// directional light stands; light.position_m moves it". Empty if none is.
std::string made_up_light_note(const Scene& scene, const Settings& settings);

}  // namespace noonmark
