// A kind of light. It is one file in technique/lights/, one row in light_kind.cpp, and its shader
// gl/shaders/light/<name>.glsl. This interface holds everything that differs between directional, spot and point
// lights. The rest of the program calls it through LightFrame.
#pragma once
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenes/scene.h"
#include "technique/light_rays.h"
#include "technique/map_tile.h"
#include "technique/settings.h"

namespace noonmark {

struct LightFrame;
class Placements;

// The shape of a map: a lookup reads a flat map by texels, and a cube map by a direction.
enum class MapShape { flat, cube };

// The way from a receiver to the light, or to a place on the light.
struct WayToLight {
  glm::vec3 direction{0, 1, 0};  // unit, up to the rounding of a float
  float reach = std::numeric_limits<float>::infinity();
  glm::dvec3 end{0};  // the place, if reach is finite
};

// The shape and the size of the light as a receiver sees it.
struct LightDisc {
  LightShape shape = LightShape::sphere;
  double radius = 0;  // KindOfLight::disc_radius
};

// A number that says which placement of the map's grid a measurement is of: {"shift_u_texels", 0.25}.
struct PlacementFact {
  std::string_view name;
  double value = 0;
};

// A value that describes a light in point.json.
struct LightFact {
  std::string_view name;
  std::variant<double, std::string_view, glm::dvec2, glm::dvec3> value;
};

class KindOfLight {
 public:
  virtual ~KindOfLight() = default;

  virtual std::string_view name() const = 0;  // a choice of light.kind
  virtual std::string_view help() const = 0;
  virtual LightRays rays() const { return LightRays::from_one_point; }
  virtual MapShape map_shape() const { return MapShape::flat; }
  virtual bool is_aimed() const { return true; }  // false: Light::target_m is not read

  // ---- the frame

  // Position and axes of the frame. Throws SettingConflict if they give no direction.
  virtual LightFrame axes(const Light& light) const = 0;
  // The smallest volume around all parts of the scene that the light can reach.
  virtual MapVolume fit(const Scene& scene, const LightFrame& frame, const MapSettings& map) const = 0;
  // Sets what the settings define of the map: extent, angle, shift. The caller has set frame.near_m, far_m and
  // resolution. Throws SettingConflict.
  virtual void lay_map(LightFrame& frame, const Light& light, const MapVolume& volume,
                       const MapSettings& settings) const = 0;

  // ---- the map

  virtual int tiles(const MapSettings& /*settings*/) const { return 1; }
  virtual MapTile tile(const LightFrame& frame, int index) const = 0;
  // The tile that a lookup reads at a point in the light's frame.
  virtual int tile_of(const LightFrame& /*frame*/, glm::dvec3 /*light*/) const { return 0; }
  // Whether the placements of the grid (technique/placements.h) are shifts of it, so that their texels form one lattice.
  // The grid of a cube has no shift: its placements are turns of the cube.
  virtual bool placements_form_lattice() const { return true; }
  // Shifts the grid by a part of a texel.
  virtual void shift_grid(LightFrame& frame, glm::dvec2 texels) const = 0;
  // Moves the map from placement 0, where the settings place it, to another placement.
  virtual void place_grid(LightFrame& frame, const Placements& placements, int placement) const;
  // Which placement this is, in numbers for a user, who can set it. placed: the frame after place_grid().
  virtual std::vector<PlacementFact> placement_facts(const LightFrame& placed, const Placements& placements,
                                                     int placement) const;
  // The same as the end of the sentence "the worst is ...". values: in the order of the facts.
  virtual std::string placement_text(std::span<const double> values) const;
  // Keeps the grid in its place when the caller has made the resolution `times` as large.
  virtual void refine_grid(LightFrame& /*frame*/, int /*times*/) const {}
  // The axes of the texels in the world, at a point in the light's frame. For the faces of a cube they have no sign:
  // they are two of the cube's own axes.
  virtual void texel_axes(const LightFrame& frame, glm::dvec3 light, glm::dvec3& right, glm::dvec3& up) const;

  // ---- rays and places (technique/light_frame.h says what a place is)

  virtual glm::dvec3 direction_to_light(const LightFrame& frame, glm::dvec3 world) const;
  virtual WayToLight way_to_centre(const LightFrame& frame, glm::dvec3 world) const;
  // Two unit vectors perpendicular to the ray to a point of the world.
  virtual void axes_across(const LightFrame& frame, glm::dvec3 world, glm::dvec3& right, glm::dvec3& up) const;
  // True if the point can get light. Under a spot light it must be inside the cone.
  virtual bool reaches(const LightFrame& /*frame*/, glm::dvec3 /*world*/) const { return true; }
  // True if the light does not reach any point of the triangle. It is false too if a quick test cannot decide that.
  virtual bool misses(const LightFrame& /*frame*/, const glm::dvec3 (&/*corners*/)[3]) const { return false; }
  virtual bool has_cone() const { return false; }  // true: Light::cone_deg is read
  // Tangent of half the light's cone; no value if the light has no cone.
  virtual std::optional<double> tan_half_cone(const LightFrame& /*frame*/) const { return std::nullopt; }
  // True if a point in the light's frame has a place in the map. A point behind a spot light has none.
  virtual bool has_place(glm::dvec3 /*light*/) const { return true; }
  virtual glm::dvec3 place(glm::dvec3 light) const { return light; }
  virtual glm::dvec3 normal_place(glm::dvec3 place) const = 0;
  // The offset is in texels for a flat map, in metres of the world for a cube.
  virtual glm::dvec3 tap_place(const LightFrame& frame, glm::dvec3 light, glm::dvec3 offset) const;

  // ---- the size of the light, for R0

  // The radius in metres; for parallel rays the tangent of half the angle. 0 means that the light has no size.
  virtual double disc_radius(const Light& light) const { return light.radius_m; }
  // The way from p to the place on the light that belongs to u, a point of the unit square.
  virtual WayToLight way_to_disc(const LightFrame& frame, const LightDisc& disc, glm::dvec3 p, glm::dvec2 u) const;
  // True if a disc is perpendicular to the light's axis. Otherwise the disc faces each receiver.
  virtual bool has_axis() const { return true; }
  virtual bool surrounds(const LightFrame& frame, const LightDisc& disc, glm::dvec3 p) const;

  // ---- text

  virtual std::string_view frustum_caption() const = 0;
  // What point.json says of the light, besides its axes and its map's range.
  virtual std::vector<LightFact> facts(const LightFrame& frame, const Light& light) const;
};

// All kinds, in the order of LightKind.
std::span<const KindOfLight* const> kinds_of_light();
const KindOfLight& kind_of_light(LightKind kind);

}  // namespace noonmark
