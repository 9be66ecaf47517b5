// glPolygonOffset on the exact map: each triangle's window depth moved by factor * m + units * r, where m is its
// steepest depth slope in texels and r the format's smallest difference (OpenGL 4.5 core, 14.6.5). The offset can
// change which triangle is first, so every triangle on the ray is tested.
#pragma once
#include <cstdint>
#include <optional>

#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "technique/bias.h"
#include "technique/settings.h"

namespace noonmark {

struct PolygonOffset {
  double factor = 0, units = 0;
  double unit = 0;  // r in window depth; 0: of 32-bit float, 2^(e - 23) with e the exponent of the triangle's largest
                    // depth

  double of(const LightView& view, uint32_t triangle) const;
};

// The polygon offset of this bias, if its map has one. A point light's fragment shader writes its own depth, which no
// offset moves. format_unit: r of a fixed-point format (gl::Renderer::polygon_offset_unit).
std::optional<PolygonOffset> polygon_offset_of(const LightFrame& frame, const MapSettings& map, const Bias& bias,
                                               double format_unit);

// The smallest offset window depth of the triangles on the ray through x that the near and far planes do not clip; 1 if
// there is none. clamped: these planes clip nothing (GL_DEPTH_CLAMP).
double least_offset_depth(const EmbreeScene& seen, const LightView& view, const PolygonOffset& offset, glm::dvec3 x,
                          bool clamped);

}  // namespace noonmark
