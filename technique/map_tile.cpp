#include "technique/map_tile.h"

#include <stdexcept>

namespace noonmark {

double MapTile::depth_of_window(double window) const {
  switch (depth) {
    case TileDepth::linear:
      return near_m + window * (far_m - near_m);
    case TileDepth::perspective:
      return far_m * near_m / (far_m - window * (far_m - near_m));
    case TileDepth::distance:
      return window * far_m;
  }
  throw std::logic_error("a tile without a depth");
}

double MapTile::window_depth_slope(double z) const {
  switch (depth) {
    case TileDepth::linear:
      return 1 / (far_m - near_m);
    case TileDepth::perspective:
      return far_m * near_m / (z * z * (far_m - near_m));
    case TileDepth::distance:
      return 1 / far_m;
  }
  throw std::logic_error("a tile without a depth");
}

double MapTile::texel_m(glm::dvec3 light) const {
  return orthographic ? 2 * half / resolution : 2 * along(light) * half / resolution;
}

glm::dvec2 MapTile::texels(glm::dvec3 place) const {
  if (orthographic) return ((glm::dvec2(place) - centre_m) / (2.0 * half_m()) + 0.5) * size() + glm::dvec2(corner);
  const glm::dvec2 side = glm::dvec2(glm::dot(place, right), glm::dot(place, up)) / (along(place) * half);
  return (side + 1.0) / 2.0 * static_cast<double>(resolution) - shift_texels + glm::dvec2(corner);
}

}  // namespace noonmark
