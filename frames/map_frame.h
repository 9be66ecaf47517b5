// The frame of a shadow map that another renderer drew, from its matrix.
//
//   const MapFrame map = map_frame(given.name, light_frame, given.clip_from_world, {2048, 1024});
//   const Technique technique(settings, map.frame);
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "technique/light_frame.h"

namespace noonmark {

inline constexpr const char* no_map_of_point_light =
    "the six maps of a point light are not read; leave the map out, and the frame is judged by places";

struct MapFrame {
  LightFrame frame;
  // The renderer's map is mirrored: its v grows against the frame's up. The rows of its image must be reversed.
  bool mirrored = false;
};

// light: the frame of the light that the truth was traced for; its rays stay. clip_from_world: OpenGL's clip space.
// texels: width and height. One map of a directional light (orthographic) with square texels, or a square one of a spot light
// (perspective, with its axis in the middle). Throws Error(file), which begins with `name`, if the matrix is another one, or if its
// axis is not the light's.
MapFrame map_frame(const std::string& name, const LightFrame& light, const glm::dmat4& clip_from_world,
                   glm::ivec2 texels);

}  // namespace noonmark
