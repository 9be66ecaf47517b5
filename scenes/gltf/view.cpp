#include "scenes/gltf/view.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "scenes/fit.h"
#include "scenes/gltf/error.h"
#include "scenes/gltf/notes.h"
#include "scenes/number_ranges.h"

namespace noonmark::gltf {
namespace {

// Cameras, directional lights and spot lights look along their node's -Z; up is +Y (glTF 2.0, section 3.10.1).
glm::dvec3 forward_of(const PlacedNode& placed) { return -glm::normalize(glm::dvec3(placed.world_from_node[2])); }
glm::dvec3 up_of(const PlacedNode& placed) { return glm::normalize(glm::dvec3(placed.world_from_node[1])); }
glm::dvec3 origin_of(const PlacedNode& placed) { return glm::dvec3(placed.world_from_node[3]); }

const tinygltf::Light* light_of(const Document& document, const PlacedNode& placed) {
  const tinygltf::ExtensionMap& extensions = document.model.nodes[placed.node].extensions;
  const auto found = extensions.find("KHR_lights_punctual");
  if (found == extensions.end()) return nullptr;
  return &document.model.lights[static_cast<size_t>(found->second.Get("light").GetNumberAsInt())];
}

// glTF measures the angle from the axis. The default is pi / 4, of which tinygltf keeps ten digits.
double cone_deg(const tinygltf::SpotLight& spot) {
  const bool by_default = spot.outerConeAngle == tinygltf::SpotLight().outerConeAngle;
  return by_default ? 90 : 2 * glm::degrees(spot.outerConeAngle);
}

// A far plane that cuts nothing off is as none: it is fitted.
std::optional<double> far_of(double zfar) {
  return zfar <= ranges::most_distance_m ? std::optional(zfar) : std::nullopt;
}

Camera camera_at(const Document& document, const PlacedNode& placed, const Scene& scene) {
  const auto index = static_cast<size_t>(document.model.nodes[placed.node].camera);
  if (const auto unknown = document.guarded.unknown_cameras.find(index);
      unknown != document.guarded.unknown_cameras.end()) {
    refuse(document.file, fmt::format("cameras[{}]", index), unknown->second, "remove the camera, or correct it");
  }
  require_invertible(document, placed);
  const tinygltf::Camera& from = document.model.cameras[index];
  Camera camera;
  camera.eye_m = origin_of(placed);
  // Any point ahead can be the target. The one nearest to the scene's middle is the one that people expect.
  const Sphere sphere = bounding_sphere(scene);
  const glm::dvec3 forward = forward_of(placed);
  // A transform that shears can make the camera's up parallel to its view. Then the picture has no upright direction.
  constexpr double least_sine = 1e-3;
  if (!(glm::length(glm::cross(forward, up_of(placed))) > least_sine)) {
    refuse(document.file, fmt::format("nodes[{}].camera", placed.node), "its up and its view are almost parallel",
           "give the camera's node a rotation and a translation only");
  }
  const double ahead = glm::dot(sphere.centre_m - camera.eye_m, forward);
  camera.target_m = camera.eye_m + forward * std::max(ahead, 1.0);
  camera.up = up_of(placed);
  if (from.type == "orthographic") {
    camera.projection = Projection::orthographic;
    camera.height_m = 2 * from.orthographic.ymag;
    camera.near_m = from.orthographic.znear;
    camera.far_m = far_of(from.orthographic.zfar);
  } else {
    camera.fov_y_deg = glm::degrees(from.perspective.yfov);
    camera.near_m = from.perspective.znear;
    if (from.perspective.zfar != 0) camera.far_m = far_of(from.perspective.zfar);
  }
  return camera;
}

LightPower power_of(const tinygltf::Light& from) {
  LightPower power;
  power.intensity = from.intensity;
  if (from.color.size() == 3) power.color = {from.color[0], from.color[1], from.color[2]};
  if (from.range > 0) power.range_m = from.range;
  power.inner_cone_deg = 2 * glm::degrees(from.spot.innerConeAngle);
  return power;
}

Light light_at(const Document& document, const PlacedNode& placed, const Scene& scene) {
  const tinygltf::Light& from = *light_of(document, placed);
  if (from.type != "directional" && from.type != "point" && from.type != "spot") {
    refuse(document.file, fmt::format("nodes[{}].extensions.KHR_lights_punctual.light", placed.node),
           fmt::format("its type '{}' is not one of directional, point, spot", printable(from.type)),
           "remove the light, or correct it");
  }
  require_invertible(document, placed);
  const Sphere sphere = bounding_sphere(scene);
  const glm::dvec3 forward = forward_of(placed);
  Light light;
  if (from.type == "directional") light = directional_light(sphere, forward);
  light.power = power_of(from);
  if (from.type == "directional") return light;

  light.position_m = origin_of(placed);
  const glm::dvec3 to_middle = sphere.centre_m - light.position_m;
  if (from.type == "point") {
    light.kind = LightKind::point;
    // A point light's target has no effect, unless a setting makes the light a spot light (light.kind).
    light.target_m = light.position_m + (glm::length(to_middle) > 0 ? to_middle : glm::dvec3(0, -1, 0));
    return light;
  }
  light.kind = LightKind::spot;
  light.target_m = light.position_m + forward * std::max(glm::dot(to_middle, forward), 1.0);
  light.cone_deg = cone_deg(from.spot);
  if (const NumberRange& cone = ranges::mapped_cone_deg; !cone.holds(light.cone_deg)) {
    refuse(document.file, fmt::format("nodes[{}].extensions.KHR_lights_punctual.light", placed.node),
           fmt::format("a spot light with a cone of {:.6g} degrees; a shadow map can cover {} to {}", light.cone_deg,
                       cone.least, cone.most),
           "change its outerConeAngle, or make it a point light");
  }
  return light;
}

// All nodes that hold one, in the file's order. The first must be one that can be used: its mistake is thrown.
template <class T, class Holds, class At, class Name>
std::vector<Named<T>> find_all(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene,
                               const Holds& holds, const At& at, const Name& own_name) {
  std::vector<Named<T>> found;
  for (const PlacedNode& placed : nodes) {
    if (!holds(placed)) continue;
    Named<T> one{document.model.nodes[placed.node].name, own_name(placed), {}, ""};
    try {
      one.value = at(document, placed, scene);
    } catch (const Error& error) {
      if (found.empty()) throw;
      one.why_not = error.what();
    }
    found.push_back(std::move(one));
  }
  return found;
}

}  // namespace

std::vector<Named<Camera>> find_cameras(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene) {
  const auto camera_of = [&](const PlacedNode& placed) { return document.model.nodes[placed.node].camera; };
  std::vector<Named<Camera>> found = find_all<Camera>(
      document, nodes, scene, [&](const PlacedNode& placed) { return !placed.collapsed && camera_of(placed) != -1; },
      camera_at, [](const PlacedNode&) { return std::string(); });  // tinygltf 2.7 does not read it
  if (found.size() > 1) {
    const uint64_t more = found.size() - 1;
    scene.notes.push_back(fmt::format("{} after the first {} not used", counted(more, "camera"), is_or_are(more)));
  }
  return found;
}

std::vector<Named<Light>> find_lights(const Document& document, const std::vector<PlacedNode>& nodes, Scene& scene) {
  return find_all<Light>(
      document, nodes, scene,
      [&](const PlacedNode& placed) { return placed.shown() && light_of(document, placed) != nullptr; }, light_at,
      [&](const PlacedNode& placed) { return light_of(document, placed)->name; });
}

}  // namespace noonmark::gltf
