#include "scenes/gltf_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/fit.h"
#include "scenes/gltf_error.h"

namespace noonmark::gltf {
namespace {

// Cameras, directional lights and spots look along their node's -Z, up is +Y (glTF 2.0, section 3.10.1).
glm::dvec3 forward_of(const PlacedNode& placed) { return -glm::normalize(glm::dvec3(placed.world_from_node[2])); }
glm::dvec3 up_of(const PlacedNode& placed) { return glm::normalize(glm::dvec3(placed.world_from_node[1])); }
glm::dvec3 origin_of(const PlacedNode& placed) { return glm::dvec3(placed.world_from_node[3]); }

const tinygltf::Light* light_of(const Document& document, const PlacedNode& placed) {
  const tinygltf::ExtensionMap& extensions = document.model.nodes[placed.node].extensions;
  const auto found = extensions.find("KHR_lights_punctual");
  if (found == extensions.end()) return nullptr;
  return &document.model.lights[static_cast<size_t>(found->second.Get("light").GetNumberAsInt())];
}

}  // namespace

std::optional<Camera> find_camera(const Document& document, const std::vector<PlacedNode>& nodes, const Scene& scene) {
  const auto found = std::find_if(nodes.begin(), nodes.end(),
                                  [&](const PlacedNode& n) { return document.model.nodes[n.node].camera != -1; });
  if (found == nodes.end()) return std::nullopt;
  const tinygltf::Camera& from = document.model.cameras[static_cast<size_t>(document.model.nodes[found->node].camera)];
  Camera camera;
  camera.eye_m = origin_of(*found);
  // Any point ahead will do for a target; the one nearest the scene's middle is the one that people expect.
  const Sphere sphere = bounding_sphere(scene);
  const glm::dvec3 forward = forward_of(*found);
  // A transform that shears can lay the camera's up along its view; then the picture has no upright.
  constexpr double least_sine = 1e-3;
  if (!(glm::length(glm::cross(forward, up_of(*found))) > least_sine)) {
    refuse(document.file, fmt::format("nodes[{}].camera", found->node), "its up and its view are almost parallel",
           "give the camera's node a rotation and a translation only");
  }
  const double ahead = glm::dot(sphere.centre_m - camera.eye_m, forward);
  camera.target_m = camera.eye_m + forward * std::max(ahead, 1.0);
  camera.up = up_of(*found);
  if (from.type == "orthographic") {
    camera.projection = Projection::orthographic;
    camera.height_m = 2 * from.orthographic.ymag;
    camera.near_m = from.orthographic.znear;
    camera.far_m = from.orthographic.zfar;
  } else {
    camera.fov_y_deg = glm::degrees(from.perspective.yfov);
    camera.near_m = from.perspective.znear;
    camera.far_m = from.perspective.zfar != 0 ? from.perspective.zfar
                                              : std::max(far_beyond(sphere, camera.eye_m), 2 * camera.near_m);
  }
  return camera;
}

std::optional<Light> find_light(const Document& document, const std::vector<PlacedNode>& nodes, const Scene& scene) {
  const Sphere sphere = bounding_sphere(scene);
  std::optional<Light> stand_in;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Light* light = light_of(document, placed);
    if (light == nullptr) continue;
    if (light->type == "directional") return directional_light(sphere, forward_of(placed));
    if (stand_in) continue;
    if (light->type == "spot") stand_in = directional_light(sphere, forward_of(placed));
    constexpr double inner_radii = 0.1;
    const glm::dvec3 to_centre = sphere.centre_m - origin_of(placed);
    if (light->type == "point" && glm::length(to_centre) > inner_radii * sphere.radius_m) {
      stand_in = directional_light(sphere, to_centre);
    }
  }
  return stand_in;
}

}  // namespace noonmark::gltf
