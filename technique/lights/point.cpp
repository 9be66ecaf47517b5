// A point light: rays from a point in all directions, a cube map of distances.
#include <stdexcept>

#include "technique/lights/shared.h"

namespace noonmark {
namespace {

class Point final : public KindOfLight {
 public:
  std::string_view name() const override { return "point"; }
  std::string_view help() const override { return "a cube map of distances"; }
  MapShape map_shape() const override { return MapShape::cube; }
  bool is_aimed() const override { return false; }

  LightFrame axes(const Light& light) const override {
    LightFrame frame;
    frame.kind = LightKind::point;
    frame.origin_m = glm::dvec3(glm::vec3(light.position_m));
    frame.forward = {0, 0, 1};
    return frame;
  }

  MapVolume fit(const Scene& scene, const LightFrame& frame) const override {
    return lights::fit_central(scene, frame, nullptr);
  }

  void lay_map(LightFrame& frame, const Light&, const MapVolume&, const MapSettings&) const override {
    lights::require_near_before_light(frame);
  }

  bool grid_can_shift() const override { return false; }
  void shift_grid(LightFrame&, glm::dvec2) const override { throw std::logic_error("the grid of a cube has no shift"); }
  int tiles(const MapSettings&) const override { return 6; }
  MapTile tile(const LightFrame& frame, int index) const override {
    const CubeFace& face = cube_face(index);
    return {.right = face.right,
            .up = face.up,
            .forward = face.forward,
            .orthographic = false,
            .half = frame.tan_half_fov,
            .near_m = frame.near_m,
            .far_m = frame.far_m,
            .depth = TileDepth::distance,
            .resolution = frame.resolution,
            .corner = {0, index * frame.resolution}};
  }
  int tile_of(const LightFrame&, glm::dvec3 light) const override { return cube_face_of(light); }
  void texel_axes(const LightFrame&, glm::dvec3 light, glm::dvec3& right, glm::dvec3& up) const override {
    const CubeFace& face = cube_face(cube_face_of(light));
    right = glm::abs(face.right);
    up = glm::abs(face.up);
  }

  glm::dvec3 normal_place(glm::dvec3 place) const override { return glm::normalize(place); }
  glm::dvec3 tap_place(const LightFrame&, glm::dvec3 light, glm::dvec3 offset) const override { return light + offset; }
  bool has_axis() const override { return false; }

  std::string_view frustum_caption() const override {
    return "What the cube map can see: green is near, orange-red is far, blue joins them along the faces' edges, pink "
           "is the light, dashed where the scene is before it.";
  }
};

const Point instance;

}  // namespace

extern const KindOfLight& point_light;
const KindOfLight& point_light = instance;

}  // namespace noonmark
