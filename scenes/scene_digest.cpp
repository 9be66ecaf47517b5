#include "scenes/scene_digest.h"

#include <optional>
#include <type_traits>
#include <vector>

#include "base/digest.h"

namespace noonmark {
namespace {

// A structured binding takes each struct apart, and it must name every member. So if somebody adds a member, the
// compiler stops here, and the author must decide whether it is part of the identity. A name that is bound but not
// added has its reason beside it.
class SceneDigest {
 public:
  void add(const Scene& scene) {
    const auto& [name, positions, vertex_normals, triangles, single_sided, parts, mask_error_m, camera, light, cameras,
                 lights, map, notes] = scene;
    static_cast<void>(name);     // a label; which scene it is, the settings say
    static_cast<void>(cameras);  // no point reads any but camera
    add_all(positions, vertex_normals, triangles, single_sided, parts, mask_error_m, camera, light, map, notes);
    if (lights.size() > 1) add(lights);  // else no setting can choose another than `light`
  }
  std::string hex() const { return digest_.hex(); }

 private:
  void add(const Part& part) {
    const auto& [name, first_triangle, triangle_count] = part;
    static_cast<void>(name);  // a label
    add_all(first_triangle, triangle_count);
  }
  void add(const Camera& camera) {
    const auto& [projection, eye_m, target_m, up, fov_y_deg, height_m, near_m, far_m] = camera;
    add_all(projection, eye_m, target_m, up, fov_y_deg, height_m, near_m, far_m);
  }
  void add(const Light& light) {
    const auto& [kind, position_m, target_m, angular_diameter_deg, radius_m, shape, cone_deg, power] = light;
    add_all(kind, position_m, target_m, angular_diameter_deg, radius_m, shape, cone_deg, power);
  }
  void add(const LightPower& power) {
    const auto& [intensity, color, range_m, inner_cone_deg] = power;
    add_all(intensity, color, range_m, inner_cone_deg);
  }
  void add(const Named<Light>& light) {
    const auto& [node, name, value, why_not] = light;
    add_all(node, name, value);
    static_cast<void>(why_not);  // for people
  }
  void add(const MapVolume& map) {
    const auto& [extent_m, near_m, far_m, height_m] = map;
    add_all(extent_m, near_m, far_m);
    if (height_m) add(*height_m);  // else it is the extent once more
  }

  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(const T& value) { digest_.value(value); }
  template <glm::length_t n, class T>
  void add(const glm::vec<n, T>& v) {
    for (glm::length_t i = 0; i < n; ++i) add(v[i]);
  }
  void add(const std::string& text) { digest_.text(text); }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.size());
    for (const T& entry : list) add(entry);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }

  template <class... Members>
  void add_all(const Members&... members) {
    (add(members), ...);
  }

  Digest digest_;
};

}  // namespace

std::string scene_digest(const Scene& scene) {
  SceneDigest digest;
  digest.add(scene);
  return digest.hex();
}

}  // namespace noonmark
