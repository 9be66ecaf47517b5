// The frame of a directional light and of its map, in double: the exact places that the ladder speaks of. The float
// matrix that OpenGL gets is rounded from it (scenes/light_frame.cpp), and what that rounding costs shows as precision.
//
//   LightFrame frame = make_light_frame(scene, settings);
//   glm::dvec3 p = frame.to_light(P);                    // (u, v, z): metres in the light's plane, metres along its
//   axis glm::dvec2 c = frame.texel_centre({i, j});           // light-plane metres of a texel's centre
#pragma once
#include <glm/glm.hpp>

#include "scenes/scene.h"
#include "scenes/settings.h"

namespace noonmark {

struct LightFrame {
  glm::dvec3 origin_m{0};  // where u, v and z are 0: the light's position, moved by map.shift_*_texels
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 1, 0};
  glm::dvec3 forward{0, 0, -1};       // the way the light travels; unit
  glm::vec3 ray_direction{0, 0, -1};  // the float vector that every light-side ray has exactly; forward is this vector
                                      // normalised in double, so rays and frame agree to the last bit of the float
  double extent_m = 1;
  double near_m = 0;
  double far_m = 1;
  int resolution = 1;

  glm::dvec3 to_light(glm::dvec3 world) const;
  glm::dvec3 to_world(glm::dvec3 light) const;
  glm::dvec3 direction_to_light() const { return -forward; }
  double texel_m() const { return extent_m / resolution; }
  glm::dvec2 texel_centre(glm::ivec2 texel) const;  // any integers, also outside the map
  double window_depth(double z_m) const { return (z_m - near_m) / (far_m - near_m); }
  glm::dmat4 clip_from_world() const;
  // One unit of bias (settings.bias.unit) in window depth.
  double depth_per_bias_unit(BiasUnit unit) const;
};

// The scene's light with what settings.light changes of it.
Light effective_light(const Scene& scene, const Settings& settings);

// Throws Error(usage) when near >= far, the extent is not positive, or the light's position is its target.
LightFrame make_light_frame(const Scene& scene, const Settings& settings);

// The smallest volume around the scene, seen from the scene's light: extent, near and far so that everything is inside.
MapVolume fit_map(const Scene& scene, const Light& light);

}  // namespace noonmark
