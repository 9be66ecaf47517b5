// What the kinds of light share: the margin of a map and the direction to the target, used by several kinds; and the
// functions of spot and point lights, whose rays come from one point.
#pragma once
#include "technique/light_frame.h"

namespace noonmark::lights {

// A map has this margin, relative to its size, so that the outermost vertices are inside even after the matrix is
// rounded to float. 2^-10 is far more than float's rounding (2^-24), and it is far less than a texel's share of the
// errors.
inline constexpr double map_margin = 0x1p-10;

// The direction from the light to its target. Throws SettingConflict if the light's position is its target.
glm::dvec3 way_of(const Light& light);

// Half of the width and height, in metres, of the smallest map of a directional light that holds a box around its middle.
// reach: half of the box's sides. The map has the shape of map.aspect; if that is auto, its width is the box's and it has
// as many rows as the box needs, but no more than columns. more_texels: the map is larger than the box by so many on each
// axis.
glm::dvec2 area_around(glm::dvec2 reach, int more_texels, const MapSettings& map);

// The volume of a directional light's map of this half width and height, with the margin.
MapVolume with_margin(glm::dvec2 half, double near_m, double far_m);

// The near and far planes for the part of the scene that the light can reach. behind(corners) is true if the triangle
// is behind the light.
MapVolume fit_central(const Scene& scene, const LightFrame& frame, bool (*behind)(const glm::dvec3 (&corners)[3]));

// Throws SettingConflict if the near plane of a perspective map is not before the light.
void require_near_before_light(const LightFrame& frame);

}  // namespace noonmark::lights
