// A point light: rays from a point in all directions, a cube map of distances.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <stdexcept>

#include "technique/lights/shared.h"
#include "technique/placements.h"

namespace noonmark {
namespace {

// The axes of the cube after a rotation by the length of the vector, in degrees, about its direction, counter-clockwise
// as seen from the vector's tip (Rodrigues' formula). In double; the shader gets these axes rounded to float.
void turn_cube(LightFrame& frame, glm::dvec3 turn_deg) {
  frame.turn_deg = turn_deg;
  frame.cube_axes = glm::dmat3(1);
  const double length_deg = glm::length(turn_deg);
  if (length_deg == 0) return;
  const glm::dvec3 axis = turn_deg / length_deg;
  const double angle = length_deg * (std::numbers::pi / 180), cosine = std::cos(angle), sine = std::sin(angle);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 v = glm::dmat3(1)[i];
    frame.cube_axes[i] = cosine * v + sine * glm::cross(axis, v) + (1 - cosine) * axis[i] * axis;
  }
}

// The turns of the placements in whole steps of a thousandth of a degree, so that their text is short and is the turn
// itself. At 1024 texels to a face the rounding is about a hundredth of a texel.
constexpr double turn_steps_per_deg = 1000;

glm::dquat rotation_of(glm::dvec3 turn_deg) {
  const double length_deg = glm::length(turn_deg);
  return length_deg == 0 ? glm::dquat(1, 0, 0, 0)
                         : glm::angleAxis(length_deg * (std::numbers::pi / 180), turn_deg / length_deg);
}

// The rotation vector of at most 180 degrees.
glm::dvec3 turn_of(glm::dquat rotation) {
  if (rotation.w < 0) rotation = -rotation;
  const glm::dvec3 v(rotation.x, rotation.y, rotation.z);
  const double sine = glm::length(v);
  if (sine == 0) return glm::dvec3(0);
  const glm::dvec3 turn = v / sine * (2 * std::atan2(sine, rotation.w) * (180 / std::numbers::pi));
  return glm::round(turn * turn_steps_per_deg) / turn_steps_per_deg + 0.0;  // + 0 turns -0 into 0
}

// A rotation for each placement (Shoemake, Uniform random rotations, Graphics Gems III, 1992: three uniform numbers give
// a uniform rotation). The first two numbers lie in S x S cells, one in each; where in the cell, and the third number, is
// the additive sequence of low discrepancy for three dimensions (Roberts 2018), so that no axis of the world is special.
// No rotation is in the corner of cell 0, so placement 0 stands for that cell. 24 rotations map the cube's grid to itself;
// the sample does not use that.
glm::dquat sampled_rotation(int side, int placement) {
  constexpr double root = 1.2207440846057596;  // of x^4 = x + 1
  const auto sequence = [&](double step) {
    const double at = 0.5 + placement * step;
    return at - std::floor(at);
  };
  const double u1 = (placement % side + sequence(1 / root)) / side;
  const double u2 = (placement / side + sequence(1 / (root * root))) / side;
  const double a = 2 * std::numbers::pi * u2, b = 2 * std::numbers::pi * sequence(1 / (root * root * root));
  const double first = std::sqrt(1 - u1), second = std::sqrt(u1);
  return {first * std::cos(a), second * std::sin(b), second * std::cos(b), first * std::sin(a)};
}

class Point final : public KindOfLight {
 public:
  std::string_view name() const override { return "point"; }
  std::string_view help() const override { return "a cube map of distances (omnidirectional shadow map)"; }
  MapShape map_shape() const override { return MapShape::cube; }
  bool is_aimed() const override { return false; }

  LightFrame axes(const Light& light) const override {
    LightFrame frame;
    frame.kind = LightKind::point;
    frame.origin_m = glm::dvec3(glm::vec3(light.position_m));
    frame.forward = {0, 0, 1};
    return frame;
  }

  MapVolume fit(const Scene& scene, const LightFrame& frame, const MapSettings&) const override {
    return lights::fit_central(scene, frame, nullptr);
  }

  void lay_map(LightFrame& frame, const Light&, const MapVolume&, const MapSettings& map) const override {
    lights::require_near_before_light(frame);
    turn_cube(frame, map.turn_deg.value_or(glm::dvec3(0)));
  }

  bool placements_form_lattice() const override { return false; }
  void shift_grid(LightFrame&, glm::dvec2) const override { throw std::logic_error("the grid of a cube has no shift"); }
  // The sampled rotation comes first, along the axes of the cube as the settings turn it.
  void place_grid(LightFrame& frame, const Placements& placements, int placement) const override {
    if (placement != 0)
      turn_cube(frame, turn_of(rotation_of(frame.turn_deg) * sampled_rotation(placements.side(), placement)));
  }
  std::vector<PlacementFact> placement_facts(const LightFrame& placed, const Placements&, int) const override {
    const glm::dvec3 t = placed.turn_deg;
    return {{"turn_x_deg", t.x}, {"turn_y_deg", t.y}, {"turn_z_deg", t.z}};
  }
  std::string placement_text(std::span<const double> values) const override {
    return fmt::format("map.turn_deg={},{},{}", values[0], values[1], values[2]);
  }
  int tiles(const MapSettings&) const override { return 6; }
  MapTile tile(const LightFrame& frame, int index) const override {
    const CubeFace& face = cube_face(index);
    const auto turned = [&](glm::dvec3 axis) { return frame.turned() ? frame.cube_axes * axis : axis; };
    return {.right = turned(face.right),
            .up = turned(face.up),
            .forward = turned(face.forward),
            .orthographic = false,
            .half = frame.tan_half_fov,
            .near_m = frame.near_m,
            .far_m = frame.far_m,
            .depth = TileDepth::distance,
            .resolution = frame.resolution,
            .corner = {0, index * frame.resolution}};
  }
  int tile_of(const LightFrame& frame, glm::dvec3 light) const override { return cube_face_of(frame.in_cube(light)); }
  void texel_axes(const LightFrame& frame, glm::dvec3 light, glm::dvec3& right, glm::dvec3& up) const override {
    const CubeFace& face = cube_face(tile_of(frame, light));
    right = frame.cube_axes * glm::abs(face.right);
    up = frame.cube_axes * glm::abs(face.up);
  }

  glm::dvec3 normal_place(glm::dvec3 place) const override { return glm::normalize(place); }
  glm::dvec3 tap_place(const LightFrame&, glm::dvec3 light, glm::dvec3 offset) const override { return light + offset; }
  bool has_axis() const override { return false; }
  std::vector<LightFact> facts(const LightFrame& frame, const Light& light) const override {
    std::vector<LightFact> facts = KindOfLight::facts(frame, light);
    facts.push_back({"turn_deg", frame.turn_deg});
    facts.push_back({"cube_x", frame.cube_axes[0]});
    facts.push_back({"cube_y", frame.cube_axes[1]});
    facts.push_back({"cube_z", frame.cube_axes[2]});
    return facts;
  }

  std::string_view frustum_caption() const override {
    return "What the cube map can see: green is near, orange-red is far, blue joins them along the faces' edges, pink "
           "is the light, dashed where the scene is before it.";
  }
};

const Point point_instance;

}  // namespace

extern const KindOfLight& point_light;
const KindOfLight& point_light = point_instance;

}  // namespace noonmark
