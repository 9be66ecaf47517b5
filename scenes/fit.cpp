#include "scenes/fit.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "scenes/interior.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

// Empty space around the sphere in the picture, as a fraction of its radius.
constexpr double view_margin = 0.05;
// To the eye: a quarter to the right of the front (glTF's +Z), a little above. Any direction that shows three sides of
// a box would do.
const glm::dvec3 to_eye = glm::normalize(glm::dvec3(0.7, 0.5, 1.0));
// Direction to the light: from the other side, 57 degrees high, so that shadows fall into view and not along an axis.
const glm::dvec3 light_travels = glm::normalize(glm::dvec3(0.6, -1.2, -0.5));
// From the sphere's centre to the light, in radii.
constexpr double light_distance_radii = 2;

// A scene of one point still gets a camera that stands apart from it.
double usable_radius(const Sphere& sphere) {
  return std::max(sphere.radius_m, 1e-6 * (1 + glm::length(sphere.centre_m)));
}

}  // namespace

Sphere bounding_sphere(const Scene& scene) {
  Sphere out;
  if (scene.positions.empty()) return out;
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const glm::vec3& p : scene.positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  out.centre_m = 0.5 * (low + high);
  for (const glm::vec3& p : scene.positions) {
    out.radius_m = std::max(out.radius_m, glm::distance(out.centre_m, glm::dvec3(p)));
  }
  return out;
}

Light directional_light(const Sphere& around, const glm::dvec3& direction) {
  Light light;
  light.target_m = around.centre_m;
  light.position_m = around.centre_m - glm::normalize(direction) * (light_distance_radii * usable_radius(around));
  return light;
}

// From outside, for pictures at least as wide as they are high: the vertical angle holds the sphere.
Camera fit_camera(const Scene& scene) {
  if (const std::optional<Camera> inside = camera_inside(scene)) return *inside;
  const Sphere sphere = bounding_sphere(scene);
  const double radius = usable_radius(sphere);
  Camera camera;
  const double half_angle = glm::radians(0.5 * camera.fov_y_deg);
  const double distance = (1 + view_margin) * radius / glm::sin(half_angle);
  camera.target_m = sphere.centre_m;
  camera.eye_m = sphere.centre_m + to_eye * distance;
  return camera;
}

Light fit_light(const Scene& scene) { return directional_light(bounding_sphere(scene), light_travels); }

}  // namespace noonmark
