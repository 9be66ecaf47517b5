// A directional light: parallel rays, one orthographic map.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/camera_frame.h"
#include "technique/lights/shared.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

class Directional final : public KindOfLight {
 public:
  std::string_view name() const override { return "directional"; }
  std::string_view help() const override { return "parallel rays and one orthographic map"; }
  LightRays rays() const override { return LightRays::parallel; }

  LightFrame axes(const Light& light) const override {
    LightFrame frame;
    frame.kind = LightKind::directional;
    frame.origin_m = light.position_m;
    frame.ray_direction = glm::vec3(lights::way_of(light));
    frame.forward = glm::normalize(glm::dvec3(frame.ray_direction));
    upright_axes(frame.forward, {0, 1, 0}, frame.right, frame.up);
    return frame;
  }

  MapVolume fit(const Scene& scene, const LightFrame& frame, const MapSettings& map) const override {
    glm::dvec2 reach(0);
    double near_m = std::numeric_limits<double>::infinity();
    double far_m = -near_m;
    for (const glm::vec3& position : scene.positions) {
      const glm::dvec3 p = frame.to_light(position);
      reach = glm::max(reach, glm::abs(glm::dvec2(p)));
      near_m = std::min(near_m, p.z);
      far_m = std::max(far_m, p.z);
    }
    return lights::with_margin(lights::area_around(reach, 0, map), near_m, far_m);
  }

  void lay_map(LightFrame& frame, const Light& light, const MapVolume& volume, const MapSettings& map) const override {
    frame.extent_m = map.extent_m.value_or(volume.extent_m) * map.extent_scale;
    if (!(frame.extent_m > 0) || !std::isfinite(frame.extent_m))
      throw SettingConflict("map.extent_m",
                            fmt::format("the map's extent is {} m; set map.extent_m to more than 0", frame.extent_m));
    if (map.aspect)
      frame.rows = map.rows();
    else if (!volume.height_m)
      throw SettingConflict("map.aspect",
                            "map.aspect = auto is the shape of what a fit holds, but map.fit = scene takes the scene's "
                            "own square volume; set map.fit to another, or map.aspect to a number");
    else
      frame.rows = static_cast<int>(std::lround(map.resolution * *volume.height_m / volume.extent_m));
    const double w = tile(frame, 0).texel_m({});
    // The texels, the matrix and the depths are all relative to the origin, so the whole grid moves together. The anchor
    // is the world's origin, moved along the light to where depths are measured from.
    if (map.snap) {
      const glm::dvec3 anchor = glm::dot(light.position_m, frame.forward) * frame.forward;
      const double block = frame.texel_block;
      frame.anchor_texels =
          block * glm::round(glm::dvec2(glm::dot(frame.origin_m, frame.right), glm::dot(frame.origin_m, frame.up)) /
                             (block * w));
      frame.anchor_m = anchor;
      frame.origin_m = anchor + w * (frame.anchor_texels.x * frame.right + frame.anchor_texels.y * frame.up);
    }
    shift_grid(frame, {map.shift_u_texels, map.shift_v_texels});
  }

  void shift_grid(LightFrame& frame, glm::dvec2 texels) const override {
    const double w = tile(frame, 0).texel_m({});
    const glm::dvec3 shift = (texels.x * frame.right + texels.y * frame.up) * w;
    if (frame.centre_m == glm::dvec2(0))
      frame.origin_m += shift;
    else
      frame.centre_m += texels * w;  // of one of several maps, whose origin stays the light's
    if (frame.anchor_m) *frame.anchor_m += shift;
  }
  void refine_grid(LightFrame& frame, int times) const override { frame.anchor_texels *= times; }

  MapTile tile(const LightFrame& frame, int) const override {
    return {.orthographic = true,
            .half = frame.extent_m / 2,
            .centre_m = frame.centre_m,
            .near_m = frame.near_m,
            .far_m = frame.far_m,
            .depth = TileDepth::linear,
            .resolution = frame.resolution,
            .rows = frame.rows};
  }

  glm::dvec3 direction_to_light(const LightFrame& frame, glm::dvec3) const override { return -frame.forward; }
  WayToLight way_to_centre(const LightFrame& frame, glm::dvec3) const override {
    return {-frame.ray_direction, std::numeric_limits<float>::infinity(), {}};
  }
  void axes_across(const LightFrame& frame, glm::dvec3, glm::dvec3& right, glm::dvec3& up) const override {
    right = frame.right;
    up = frame.up;
  }
  glm::dvec3 place(glm::dvec3 light) const override { return {light.x, light.y, 1}; }
  glm::dvec3 normal_place(glm::dvec3 place) const override { return place; }

  // The size of the light is a disc of directions.
  double disc_radius(const Light& light) const override {
    return std::tan(light.angular_diameter_deg * std::numbers::pi / 360);
  }
  WayToLight way_to_disc(const LightFrame& frame, const LightDisc& disc, glm::dvec3, glm::dvec2 u) const override {
    const double phi = 2 * std::numbers::pi * u.y;
    const double r = disc.radius * std::sqrt(u.x);
    return {glm::vec3(frame.direction_to_light() + r * (std::cos(phi) * frame.right + std::sin(phi) * frame.up)),
            std::numeric_limits<float>::infinity(),
            {}};
  }
  bool surrounds(const LightFrame&, const LightDisc&, glm::dvec3) const override { return false; }

  std::string_view frustum_caption() const override {
    return "What the map can see: green is near, orange-red is far, blue joins them, dashed where the scene is before "
           "it.";
  }
  std::vector<LightFact> facts(const LightFrame& frame, const Light& light) const override {
    return {{"ray_direction", glm::dvec3(frame.ray_direction)},
            {"angular_diameter_deg", light.angular_diameter_deg},
            {"extent_m", frame.extent_m},
            {"texel_m", tile(frame, 0).texel_m({})}};
  }
};

const Directional directional_instance;

}  // namespace

extern const KindOfLight& directional_light;
const KindOfLight& directional_light = directional_instance;

}  // namespace noonmark
