// What spot and point lights share: their rays come from one point.
#pragma once
#include "technique/light_frame.h"

namespace noonmark::lights {

// A map's margin keeps the outermost vertices inside after the float matrix has rounded them: 2^-10 of the size, far more
// than float's 2^-24 of it, far less than a texel's share of the errors.
inline constexpr double map_margin = 0x1p-10;

// Throws SettingConflict where the light's position is its target.
glm::dvec3 way_of(const Light& light);

// Depths of what lies in the light's reach. behind(corners): the triangle is behind the light.
MapVolume fit_central(const Scene& scene, const LightFrame& frame, bool (*behind)(const glm::dvec3 (&corners)[3]));

// Throws SettingConflict: a perspective map's near plane is before the light.
void require_near_before_light(const LightFrame& frame);

}  // namespace noonmark::lights
