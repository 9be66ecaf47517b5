#include "raytrace/polygon_offset.h"

#include <algorithm>
#include <cmath>

namespace noonmark {

double PolygonOffset::of(const LightView& view, uint32_t triangle) const {
  const LightFrame& frame = view.frame();
  const glm::dvec3 n = view.normal_away(triangle), a = view.corner(triangle, 0);
  glm::dvec2 per_texel;
  const MapTile tile = frame.tile_at(a);
  if (tile.depth == TileDepth::distance) return 0;  // the shader writes this depth, and OpenGL moves none of those
  if (tile.orthographic) {
    per_texel = glm::dvec2(n) / n.z * tile.texel_m(a) / (tile.far_m - tile.near_m);
  } else {
    // On the plane n.q = n.a, 1 / z is n.(x, y, 1) / n.a at the place (x, y, 1), and window depth is far / (far - near)
    // (1 - near / z).
    const double per_place = tile.far_m * tile.near_m / (tile.far_m - tile.near_m) / glm::dot(n, a);
    per_texel = glm::dvec2(n) * per_place * (2 * tile.half / tile.resolution);
  }
  const double steepest = std::max(std::abs(per_texel.x), std::abs(per_texel.y));
  double r = unit;
  if (r == 0) {
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
      const double depth = tile.depth_m(view.corner(triangle, i));
      if (tile.orthographic || depth > 0) largest = std::max(largest, std::clamp(tile.window_depth(depth), 0.0, 1.0));
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    r = std::ldexp(1.0, exponent - 1 - 23);
  }
  const double offset = factor * steepest + units * r;
  return std::isfinite(offset) ? offset : 1;  // edge-on: it covers nothing
}

std::optional<PolygonOffset> polygon_offset_of(const LightFrame& frame, const MapSettings& map, const Bias& bias,
                                               double format_unit) {
  const bool drawn_by_the_rasterizer = frame.has_depth(TileDepth::linear) || frame.has_depth(TileDepth::perspective);
  if (!bias.polygon_offset() || !drawn_by_the_rasterizer) return std::nullopt;
  return PolygonOffset{bias.polygon_offset()->factor, bias.polygon_offset()->units,
                       map.format == DepthFormat::d32f ? 0 : format_unit};
}

double least_offset_depth(const EmbreeScene& seen, const LightView& view, const PolygonOffset& offset, glm::dvec3 x,
                          bool clamped) {
  const MapTile tile = view.frame().tile_at(x);
  std::vector<uint32_t> hits;
  seen.all_hits(view.ray(x), hits);
  double least = 1;
  for (uint32_t triangle : hits) {
    if (!tile.orthographic && view.edge_on(triangle)) continue;
    const double depth = view.hit_depth(triangle, x);
    if (!clamped && (depth < tile.near_m || depth > tile.far_m)) continue;
    least = std::min(least, tile.window_depth(depth) + offset.of(view, triangle));
  }
  return std::clamp(least, 0.0, 1.0);
}

}  // namespace noonmark
