// The frame of a light and of its map, in double: the exact places that the ladder speaks of. The float matrices that
// OpenGL gets are rounded from it, and what that rounding costs shows as precision.
//
//   LightFrame frame = make_light_frame(scene, settings);
//   glm::dvec3 p = frame.to_light(P);                     // metres along right, up and forward, from the light
//   double d = frame.window_depth(frame.depth_m(p));      // what the map holds of P
//   glm::dvec3 x = frame.texel_place({i, j});             // the place of a texel's centre
//
// A *place* is where a light-side ray goes. It is homogeneous: of a directional light (u, v, 1) with u and v in metres
// of the light's plane; of a spot and a point light the ray's direction in the light's axes, of any length. So three
// places lie on one line of the map exactly when their determinant is 0, whatever the light.
//
// The map of a point light is six faces, in OpenGL's order +X -X +Y -Y +Z -Z, one above the other in an image of
// resolution x 6 resolution: texel (i, j) of face f is (i, f * resolution + j).
#pragma once
#include <glm/glm.hpp>

#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

// Where N is across L, tan(theta) ends at this cosine of theta and stays a number.
inline constexpr double least_cosine = 1e-6;

struct LightFrame {
  LightKind kind = LightKind::directional;
  // Spot and point: the light's position, exactly a float, because every ray starts there. Directional: where u, v and
  // z are 0, which is the light's position moved by map.shift_*_texels and map.snap.
  glm::dvec3 origin_m{0};
  // Unit vectors. Of a point light they are the world's axes.
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 1, 0};
  glm::dvec3 forward{0, 0, -1};  // directional: the way the light travels; spot: its axis
  // Directional: the direction of every light-side ray, exactly a float. forward is this vector normalised in double, so
  // rays and frame agree to the last bit of the float.
  glm::vec3 ray_direction{0, 0, -1};
  double extent_m = 1;         // directional
  double tan_half_fov = 1;     // spot: of half the map's angle; point: 1
  double cos_half_cone = -1;   // spot: of half the light's cone
  glm::dvec2 shift_texels{0};  // spot: map.shift_*_texels
  double near_m = 0;
  double far_m = 1;
  int resolution = 1;

  bool parallel() const { return kind == LightKind::directional; }
  int faces() const { return kind == LightKind::point ? 6 : 1; }
  glm::ivec2 map_size() const { return {resolution, faces() * resolution}; }

  glm::dvec3 to_light(glm::dvec3 world) const;
  glm::dvec3 to_world(glm::dvec3 light) const;
  glm::dvec3 direction_to_light(glm::dvec3 world) const;  // unit
  // Of a directional light, which has the same everywhere.
  glm::dvec3 direction_to_light() const { return -forward; }
  bool in_cone(glm::dvec3 world) const;  // true but for a spot light's outside

  // What the map's depth measures, of a point in the light's frame: metres along the axis, or the distance.
  double depth_m(glm::dvec3 light) const;
  double window_depth(double depth_m) const;
  double depth_of_window(double window_depth) const;  // its inverse
  double window_depth_slope(double depth_m) const;    // its derivative, per metre

  // The world size of one texel at a point in the light's frame. texel_m(): of a directional light, everywhere.
  double texel_m(glm::dvec3 light) const;
  double texel_m() const { return extent_m / resolution; }

  glm::dvec3 place(glm::dvec3 light) const;  // of a point in the light's frame
  // Of one tap of a lookup at this point: offset in texels of a flat map, in metres of the world for a point light.
  glm::dvec3 tap_place(glm::dvec3 light, glm::dvec3 offset) const;
  glm::dvec3 texel_place(glm::ivec2 texel) const;  // of its centre; flat maps: any integers, also outside the map
  // Where a place lies in the map, in texels; floor() of it is the texel. For point lights with the face in it.
  glm::dvec2 map_texels(glm::dvec3 place) const;
  // Directional: u and v of a texel's centre.
  glm::dvec2 texel_centre(glm::ivec2 texel) const { return glm::dvec2(texel_place(texel)); }

  glm::dmat4 clip_from_world(int face = 0) const;
  // One unit of bias (settings.bias.unit) in window depth, at a point in the light's frame.
  double depth_per_bias_unit(BiasUnit unit, glm::dvec3 light) const;
};

// The axes of a cube face in the world's, as OpenGL lays them down: s to the right, t up, and the way it looks.
struct CubeFace {
  glm::dvec3 right, up, forward;
};
const CubeFace& cube_face(int face);  // 0 ... 5
int cube_face_of(glm::dvec3 direction);

// The scene's light with what settings.light changes of it.
Light effective_light(const Scene& scene, const Settings& settings);

// Throws Error(usage) when near >= far, the extent is not positive, near is not before a spot or point light, or a
// directional or spot light's position is its target.
LightFrame make_light_frame(const Scene& scene, const Settings& settings);

// The smallest volume around the scene as the light sees it: extent, near and far so that all it can light is inside.
MapVolume fit_map(const Scene& scene, const Light& light);

}  // namespace noonmark
