#include "app/advise/recommend_about.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "scenes/floor.h"
#include "scenes/interior.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// Of a model by itself: a shadow that would fall on a ground is in none of the pictures, so the map and the lines leave it out.
std::string no_ground_text(const Settings& first, const Scene& scene) {
  if (!names_file(first.scene.name) || first.scene.floor || has_ground(scene) || camera_inside(scene)) return "";
  return "The model has no ground: this answer is for its shadows on itself, and the lines cut the shadow off on a "
         "ground of yours. For a floor under it: --set scene.floor=true, or noonmark init MODEL and then noonmark "
         "recommend FILE.toml.";
}

// Where the direction or the position of the light is from.
std::string source_of_light(const Experiment& experiment, const Settings& first, const Scene& scene) {
  for (const std::string_view name :
       {"light.azimuth_deg", "light.elevation_deg", "light.position_m", "light.target_m", "light.name", "light.index"})
    if (const auto given = experiment.locations.find(std::string(name)); given != experiment.locations.end())
      return "as " + given->second + " gives it";
  if (!names_file(first.scene.name)) return "that of the built-in scene";
  if (!scene.lights.empty()) return "that of the model's file";
  return "fitted, because the model's file has none; yours: --set light.position_m=X,Y,Z --set light.target_m=X,Y,Z, "
         "or light.azimuth_deg and light.elevation_deg";
}

std::string place_of_light(const LightFrame& frame) {
  const glm::dvec3 way = frame.forward, at = frame.origin_m;
  if (frame.kind == LightKind::directional)
    return fmt::format("shines along {:.3g}, {:.3g}, {:.3g}", way.x, way.y, way.z);
  return fmt::format("stands at {:.4g}, {:.4g}, {:.4g} m", at.x, at.y, at.z);
}

std::string light_text(const Experiment& experiment, std::span<const Settings> conditions, const Scene& scene) {
  const Settings& first = conditions.front();
  const LightFrame frame = make_light_frame(scene, first);
  const auto given = settings_map(first);
  const auto has_that_light = [&](const Settings& condition) {
    const auto here = settings_map(condition);
    return std::all_of(here.begin(), here.end(), [&](const auto& setting) {
      const auto& [name, value] = setting;
      return (!name.starts_with("light.") && !name.starts_with("scene.")) || value == given.at(name);
    });
  };
  return fmt::format(
      "The light is {} and {}, {}{}.", kind_of_light(frame.kind).name(), place_of_light(frame),
      source_of_light(experiment, first, scene),
      std::all_of(conditions.begin(), conditions.end(), has_that_light) ? "" : "; other conditions have other ones");
}

// The part "floor" comes last (scenes/floor.h), unless the mesh is made anew.
std::string floor_text(const Settings& first, const Scene& scene) {
  if (!first.scene.floor || scene.parts.empty() || first.scene.mesh != MeshForm::as_built) return "";
  const Part& floor = scene.parts.back();
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (uint32_t t = 0; t < floor.triangle_count; ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(scene.positions[scene.triangles[floor.first_triangle + t][corner]]);
      low = glm::min(low, p), high = glm::max(high, p);
    }
  const glm::dvec3 middle = 0.5 * (low + high);
  return fmt::format(
      "The floor of scene.floor is a square of {:.4g} m at y = {:.4g} m; its middle is x = {:.4g}, z = {:.4g} m.",
      high.x - low.x, low.y, middle.x, middle.z);
}

}  // namespace

std::vector<std::string> about_text(const Experiment& experiment, std::span<const Settings> conditions,
                                    const Scene& scene) {
  const Settings& first = conditions.front();
  std::vector<std::string> lines = {no_ground_text(first, scene), light_text(experiment, conditions, scene),
                                    floor_text(first, scene)};
  std::erase_if(lines, [](const std::string& line) { return line.empty(); });
  return lines;
}

}  // namespace noonmark
