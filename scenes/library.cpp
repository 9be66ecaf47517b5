#include "scenes/library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/memory.h"
#include "base/suggestion.h"
#include "base/text.h"
#include "scenes/builtin.h"
#include "scenes/floor.h"
#include "scenes/gltf/gltf.h"
#include "scenes/number_ranges.h"
#include "scenes/remesh.h"
#include "scenes/scene_size.h"

namespace noonmark {
namespace {

// A model or an experiment in the working directory that has this name, "Lantern/Lantern.gltf". Empty if there is none.
std::string file_of_name(const std::string& name) {
  for (const char* folder : {"", "/"})
    for (const char* extension : {".gltf", ".glb", ".vrm", ".toml"}) {
      const std::string path = (*folder ? name + folder : std::string()) + name + extension;
      if (std::error_code none; std::filesystem::is_regular_file(path, none)) return path;
    }
  return "";
}

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
  if (names_file(settings.name)) return load_gltf(settings.name, {settings.time_s, settings.animation}, settings.masks);
  std::string near = file_of_name(settings.name);
  if (near.empty()) near = nearest_name(settings.name, names);
  throw Error(
      ErrorKind::usage,
      fmt::format(
          "there is no built-in scene '{}'{}; give one that `noonmark scenes` lists, or the path of a .gltf, .glb or "
          ".vrm file",
          settings.name, near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near)));
}

template <class T>
const T& value_named(const std::vector<Named<T>>& all, std::string_view name, std::string_view what,
                     const std::string& scene) {
  const Named<T>* found = nullptr;
  std::vector<std::string_view> names;
  for (const Named<T>& one : all) {
    for (const std::string_view own : {std::string_view(one.node), std::string_view(one.name)})
      if (!own.empty() && std::find(names.begin(), names.end(), own) == names.end()) names.push_back(own);
    if (one.node != name && one.name != name) continue;
    if (found)
      throw Error(ErrorKind::usage,
                  fmt::format("{} has two {}s with the name '{}'; give them names of their own", scene, what, name));
    found = &one;
  }
  if (!found)
    throw Error(ErrorKind::usage,
                fmt::format("{} has no {} with the name '{}'{}{}", scene, what, name, did_you_mean(name, names),
                            names.empty() ? fmt::format("; it has no named {}", what)
                                          : fmt::format("; it has {}", fmt::join(names, ", "))));
  if (!found->value) throw Error(ErrorKind::usage, found->why_not);
  return *found->value;
}

// Of what remeshed makes, before it is made: tiles turn each triangle into 64.
void require_room(const SceneSettings& settings, const Scene& scene) {
  const SceneSize size = remeshed_size(scene, settings.mesh);
  const std::string what =
      fmt::format("{}: scene.mesh = {} makes {} triangles of its {}", settings.name,
                  mesh_forms[static_cast<size_t>(settings.mesh)], size.triangles, scene.triangles.size());
  const char* remedy = "choose another scene.mesh or a scene of fewer triangles";
  if (size.triangles > max_scene_triangles)
    throw Error(ErrorKind::usage,
                fmt::format("{}, which are more than the {} allowed; {}", what, max_scene_triangles, remedy));
  const double needed = scene_bytes(size);
  if (const AvailableMemory available = available_memory(); needed > static_cast<double>(available.bytes))
    throw Error(ErrorKind::usage, fmt::format("{}, which take at least {} of memory, and {}; {}, or use a machine with "
                                              "more memory",
                                              what, bytes_text(needed), available.text(), remedy));
}

// A move to where floats are further apart than the scene's corners leaves less of it, or nothing. Where they are as far apart
// as the scene's camera is from what it shows, the picture is of the rounding alone.
void require_shape(Scene& scene, const Placement& placement) {
  const PlacedShape shape = placed_shape(scene, placement);
  const glm::dvec3 by = placement.move_m;
  const double shown_from_m = glm::distance(scene.camera.eye_m, scene.camera.target_m);
  const std::string there = fmt::format("scene.move_m = {},{},{} moves {} to where float coordinates are {:g} m apart",
                                        by.x, by.y, by.z, scene.name, shape.step_m);
  if (shape.triangles > 0 && (shape.lost == shape.triangles || shape.step_m >= shown_from_m))
    throw Error(
        ErrorKind::usage,
        fmt::format("{}, {}; move it less far", there,
                    shape.lost == shape.triangles
                        ? fmt::format("and none of its {} triangles has an area there", shape.triangles)
                        : fmt::format("no less than the {:.3g} m from its camera to what it shows, so its picture "
                                      "would be of the rounding alone",
                                      shown_from_m)));
  if (!shape.in_world)
    throw Error(ErrorKind::usage, fmt::format("{}, and a coordinate is at most {:g} m; move it less far", there,
                                              ranges::coordinate_m.most));
  if (shape.lost > 0)
    scene.notes.push_back(
        fmt::format("{}: {} of its {} triangles have no area there, and all corners are rounded by up to half of that",
                    there, shape.lost, shape.triangles));
}

}  // namespace

bool names_file(std::string_view scene_name) {
  return std::any_of(std::begin(model_endings), std::end(model_endings),
                     [&](const char* ending) { return ends_with_any_case(scene_name, ending); });
}

const Camera& camera_named(const Scene& scene, std::string_view name) {
  return value_named(scene.cameras, name, "camera", scene.name);
}

const Light& light_named(const Scene& scene, std::string_view name) {
  return value_named(scene.lights, name, "light", scene.name);
}

std::string notes_line(const Scene& scene) {
  return scene.notes.empty() ? "" : fmt::format("{}: {}", scene.name, fmt::join(scene.notes, "; "));
}

Scene make_scene(const SceneSettings& settings) {
  Scene scene = scene_as_built(settings);
  if (settings.floor) add_floor_under(scene);
  if (settings.mesh != MeshForm::as_built) require_room(settings, scene);
  const Placement placement{settings.turn_deg, settings.move_m.value_or(glm::dvec3(0))};
  if (settings.move_m) require_shape(scene, placement);
  return remeshed(std::move(scene), settings.mesh, placement);
}

}  // namespace noonmark
