// How much light reaches a surface, unshadowed: what weighs the lights of one frame (measure/lights_frame.h). As
// KHR_lights_punctual of glTF defines it: a directional light in lux; a spot or point light in candela, which falls off
// with the square of the distance, smoothly to nothing at its range, and a spot from its inner to its outer cone.
//
//   const double lux = illuminance_lux(light, frame, p, normal) * luminance(light.power.color);
#pragma once
#include <glm/glm.hpp>

#include "technique/light_frame.h"

namespace noonmark {

// Of a white light of that intensity, at a point of the world whose surface has this unit normal. light: effective_light();
// frame: made of it. 0 or more; 0 where the surface faces away, beyond the range and outside the cone. Infinite at the light.
double illuminance_lux(const Light& light, const LightFrame& frame, glm::dvec3 p, glm::dvec3 normal);

// The luminance of a linear colour. The primaries are those of sRGB (IEC 61966-2-1). White has the luminance 1.
double luminance(glm::dvec3 rgb);

}  // namespace noonmark
