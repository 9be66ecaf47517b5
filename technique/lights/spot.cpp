// A spot light: rays from a point within a cone, one perspective map.
#include <cmath>
#include <numbers>

#include "scenes/camera_frame.h"
#include "technique/lights/shared.h"

namespace noonmark {
namespace {

double tan_half(double whole_deg) { return std::tan(whole_deg * std::numbers::pi / 360); }

class Spot final : public KindOfLight {
 public:
  std::string_view name() const override { return "spot"; }
  std::string_view help() const override { return "one perspective map"; }

  bool has_cone() const override { return true; }

  LightFrame axes(const Light& light) const override {
    LightFrame frame;
    frame.kind = LightKind::spot;
    frame.origin_m = glm::dvec3(glm::vec3(light.position_m));
    frame.ray_direction = glm::vec3(lights::way_of(light));
    frame.forward = glm::normalize(glm::dvec3(frame.ray_direction));
    upright_axes(frame.forward, {0, 1, 0}, frame.right, frame.up);
    frame.tan_half_fov = tan_half(light.cone_deg);
    frame.cos_half_cone = std::cos(light.cone_deg * std::numbers::pi / 360);
    return frame;
  }

  MapVolume fit(const Scene& scene, const LightFrame& frame, const MapSettings&) const override {
    return lights::fit_central(scene, frame, [](const glm::dvec3(&corner)[3]) {
      return corner[0].z <= 0 && corner[1].z <= 0 && corner[2].z <= 0;
    });
  }

  void lay_map(LightFrame& frame, const Light& light, const MapVolume&, const MapSettings& map) const override {
    frame.tan_half_fov = tan_half(map.fov_deg.value_or(light.cone_deg)) * map.extent_scale;
    lights::require_near_before_light(frame);
    shift_grid(frame, {map.shift_u_texels, map.shift_v_texels});
  }

  void shift_grid(LightFrame& frame, glm::dvec2 texels) const override { frame.shift_texels += texels; }
  void refine_grid(LightFrame& frame, int times) const override { frame.shift_texels *= times; }

  MapTile tile(const LightFrame& frame, int) const override {
    return {.orthographic = false,
            .half = frame.tan_half_fov,
            .near_m = frame.near_m,
            .far_m = frame.far_m,
            .depth = TileDepth::perspective,
            .resolution = frame.resolution,
            .shift_texels = frame.shift_texels};
  }

  bool reaches(const LightFrame& frame, glm::dvec3 world) const override {
    return glm::dot(glm::normalize(world - frame.origin_m), frame.forward) >= frame.cos_half_cone;
  }

  std::optional<double> tan_half_cone(const LightFrame& frame) const override {
    return std::sqrt(1 - frame.cos_half_cone * frame.cos_half_cone) / frame.cos_half_cone;
  }

  // True if all corners are outside the same side of the square pyramid around the cone.
  bool misses(const LightFrame& frame, const glm::dvec3 (&corners)[3]) const override {
    const double tangent = *tan_half_cone(frame);
    for (int axis = 0; axis < 2; ++axis)
      for (int sign : {-1, 1}) {
        bool beyond = true;
        for (const glm::dvec3& corner : corners) {
          const glm::dvec3 p = frame.to_light(corner);
          beyond = beyond && sign * p[axis] > p.z * tangent;
        }
        if (beyond) return true;
      }
    return false;
  }

  bool has_place(glm::dvec3 light) const override { return light.z > 0; }
  glm::dvec3 normal_place(glm::dvec3 place) const override { return {place.x / place.z, place.y / place.z, 1}; }

  std::string_view frustum_caption() const override {
    return "What the map can see: green is near, orange-red is far, blue joins them, yellow is the light's cone, "
           "pink is the light, dashed where the scene is before it.";
  }
  std::vector<LightFact> facts(const LightFrame& frame, const Light& light) const override {
    std::vector<LightFact> facts = KindOfLight::facts(frame, light);
    facts.push_back({"cone_deg", light.cone_deg});
    facts.push_back({"cos_half_cone", frame.cos_half_cone});
    facts.push_back({"tan_half_fov", frame.tan_half_fov});
    facts.push_back({"shift_texels", frame.shift_texels});
    return facts;
  }
};

const Spot spot_instance;

}  // namespace

extern const KindOfLight& spot_light;
const KindOfLight& spot_light = spot_instance;

}  // namespace noonmark
