#include "scenes/library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "scenes/error.h"
#include "scenes/remesh.h"
#include "scenes/text.h"

namespace noonmark {
namespace {

Scene scene_as_built(const SceneSettings& settings) {
  std::vector<std::string_view> names;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.name == settings.name) {
      Scene scene = builtin.make(settings);
      scene.name = settings.name;
      return scene;
    }
    names.push_back(builtin.name);
  }
  if (names_file(settings.name)) return load_gltf(settings.name, {settings.time_s, settings.animation});
  const std::string near = nearest_name(settings.name, names);
  throw Error(
      ErrorKind::usage,
      fmt::format("there is no built-in scene '{}'{}; give one that `noonmark scenes` lists, or the path of a .gltf or "
                  ".glb file",
                  settings.name, near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near)));
}

}  // namespace

bool names_file(std::string_view scene_name) {
  return ends_with_any_case(scene_name, ".gltf") || ends_with_any_case(scene_name, ".glb");
}

std::string notes_line(const Scene& scene) {
  return scene.notes.empty() ? "" : fmt::format("{}: {}", scene.name, fmt::join(scene.notes, "; "));
}

Scene make_scene(const SceneSettings& settings) {
  return remeshed(scene_as_built(settings), settings.mesh,
                  {settings.turn_deg, settings.move_m.value_or(glm::dvec3(0))});
}

}  // namespace noonmark
