// A kind of light: one file in technique/lights/, one row in light_kind.cpp, and its shader gl/shaders/light/<name>.glsl.
// Everything that differs between directional, spot and point lights is behind this interface; the rest of the program
// asks it, through LightFrame.
#pragma once
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <string_view>

#include "scenes/scene.h"
#include "technique/map_tile.h"
#include "technique/settings.h"

namespace noonmark {

struct LightFrame;

// What a lookup samples: a flat map by texels, or a cube map by a direction.
enum class MapShape { flat, cube };

// From a receiver to the light, or to a place on it.
struct WayToLight {
  glm::vec3 direction{0, 1, 0};  // unit, to float's rounding
  float reach = std::numeric_limits<float>::infinity();
  glm::dvec3 end{0};  // finite reach: the place
};

// What a light with a size is, seen from a receiver.
struct LightDisc {
  LightShape shape = LightShape::sphere;
  double radius = 0;  // KindOfLight::disc_radius
};

class KindOfLight {
 public:
  virtual ~KindOfLight() = default;

  virtual std::string_view name() const = 0;  // a choice of light.kind
  virtual std::string_view help() const = 0;
  virtual bool parallel_rays() const { return false; }  // or all from one point
  virtual MapShape map_shape() const { return MapShape::flat; }

  // ---- the frame

  // Place and axes. Throws SettingConflict where they give no direction.
  virtual LightFrame axes(const Light& light) const = 0;
  // The smallest volume around all of the scene that the light can reach.
  virtual MapVolume fit(const Scene& scene, const LightFrame& frame) const = 0;
  // What the settings say of the map: extent, angle, shift. frame.near_m, far_m and resolution are set. Throws
  // SettingConflict.
  virtual void lay_map(LightFrame& frame, const Light& light, const MapVolume& volume,
                       const MapSettings& settings) const = 0;

  // ---- the map

  virtual int tiles() const { return 1; }
  virtual MapTile tile(const LightFrame& frame, int index) const = 0;
  virtual int tile_of(glm::dvec3 /*place*/) const { return 0; }
  // The axes of the texels at a point in the light's frame, in the world; of a cube's faces without sign.
  virtual void texel_axes(const LightFrame& frame, glm::dvec3 light, glm::dvec3& right, glm::dvec3& up) const;

  // ---- rays and places (technique/light_frame.h says what a place is)

  virtual glm::dvec3 direction_to_light(const LightFrame& frame, glm::dvec3 world) const;
  virtual WayToLight way_to_centre(const LightFrame& frame, glm::dvec3 world) const;
  // Two unit vectors across the ray to a point of the world.
  virtual void axes_across(const LightFrame& frame, glm::dvec3 world, glm::dvec3& right, glm::dvec3& up) const;
  virtual bool reaches(const LightFrame& /*frame*/, glm::dvec3 /*world*/) const { return true; }  // in a spot's cone
  // Whether the whole triangle lies where the light does not reach; false where that is not known at once.
  virtual bool misses(const LightFrame& /*frame*/, const glm::dvec3 (&/*corners*/)[3]) const { return false; }
  // Whether a point of the light's frame has a place in the map: not behind a spot light.
  virtual bool has_place(glm::dvec3 /*light*/) const { return true; }
  virtual glm::dvec3 place(glm::dvec3 light) const { return light; }
  virtual glm::dvec3 normal_place(glm::dvec3 place) const = 0;
  // offset: texels of a flat map, metres of the world of a cube.
  virtual glm::dvec3 tap_place(const LightFrame& frame, glm::dvec3 light, glm::dvec3 offset) const;

  // ---- its size, for R0

  // Metres; of parallel rays the tangent of half the angle. 0: it has no size.
  virtual double disc_radius(const Light& light) const { return light.radius_m; }
  // The way from p to the place on the light that u, in the unit square, stands for.
  virtual WayToLight way_to_disc(const LightFrame& frame, const LightDisc& disc, glm::dvec3 p, glm::dvec2 u) const;
  virtual bool has_axis() const { return true; }  // a disc lies across it; without one it faces each receiver
  virtual bool surrounds(const LightFrame& frame, const LightDisc& disc, glm::dvec3 p) const;

  // ---- words

  virtual std::string_view frustum_caption() const = 0;
};

// In the order of LightKind.
std::span<const KindOfLight* const> kinds_of_light();
const KindOfLight& kind_of_light(LightKind kind);

}  // namespace noonmark
