// One tile of a light's map: a rectangle of square texels with its own volume, projection and texel size. The map of a
// directional or spot light has one tile. The map of a point light has six, the faces of its cube.
//
//   const MapTile tile = frame.tile(frame.tile_of(place));
//   glm::dvec2 at = tile.texels(place);        // floor() of it is the texel, in the map's image
//   double w = tile.texel_m(light);            // the texel's width there
#pragma once
#include <glm/glm.hpp>
#include <stdexcept>

namespace noonmark {

// The formula of window depth, from depth_m, which is the metres that the map measures.
enum class TileDepth {
  linear,       // (z - near) / (far - near), z along the tile's axis
  perspective,  // far (z - near) / (z (far - near))
  distance      // |P| / far
};

struct MapTile {
  // Unit vectors in the light's frame: along the rows of texels, along the columns, and in the tile's direction of
  // view. An orthographic tile has the frame's own axes, these defaults.
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};
  bool orthographic = true;
  double half = 1;         // half of its width in metres (orthographic), or the tangent of half its angle
  glm::dvec2 centre_m{0};  // orthographic: u and v of its middle
  double near_m = 0, far_m = 1;
  TileDepth depth = TileDepth::linear;
  int resolution = 1;          // texels along its width
  int rows = resolution;       // texels along its height; perspective tiles are square
  glm::ivec2 corner{0};        // the position of its first texel in the map's image
  glm::dvec2 shift_texels{0};  // perspective: the shift of its grid

  // The depth in metres of a point in the light's frame: along the axis, or the distance.
  double depth_m(glm::dvec3 light) const { return depth == TileDepth::distance ? glm::length(light) : along(light); }
  double along(glm::dvec3 v) const { return glm::dot(v, forward); }
  double window_depth(double depth_m) const;
  double depth_of_window(double window_depth) const;  // its inverse
  double window_depth_slope(double depth_m) const;    // its derivative, per metre
  // The depth at which the near plane cuts the ray of a place. If depths are distances, the place is a unit vector.
  double near_depth(glm::dvec3 place) const { return depth == TileDepth::distance ? near_m / along(place) : near_m; }

  glm::dvec2 size() const { return {resolution, rows}; }  // in texels
  // Orthographic: half of its width and height in metres.
  glm::dvec2 half_m() const { return rows == resolution ? glm::dvec2(half) : half * size() / double(resolution); }

  double texel_m(glm::dvec3 light) const;        // the width of a texel at a point in the light's frame
  glm::dvec3 place_of(glm::ivec2 texel) const;   // the place of the centre of a texel of the map's image
  glm::dvec2 texels(glm::dvec3 place) const;     // the position of a place in the map's image
  glm::dvec3 place_at(glm::dvec2 texels) const;  // its inverse; of a perspective tile the place with along() = 1
};

// In the header, because they are asked for each receiver, tap and point of a lattice of placements.
inline double MapTile::window_depth(double z) const {
  switch (depth) {
    case TileDepth::linear:
      return (z - near_m) / (far_m - near_m);
    case TileDepth::perspective:
      return far_m * (z - near_m) / (z * (far_m - near_m));
    case TileDepth::distance:
      return z / far_m;
  }
  throw std::logic_error("a tile without a depth");
}

inline double MapTile::texel_m(glm::dvec3 light) const {
  return orthographic ? 2 * half / resolution : 2 * along(light) * half / resolution;
}

inline glm::dvec2 MapTile::texels(glm::dvec3 place) const {
  if (orthographic) return ((glm::dvec2(place) - centre_m) / (2.0 * half_m()) + 0.5) * size() + glm::dvec2(corner);
  const glm::dvec2 side = glm::dvec2(glm::dot(place, right), glm::dot(place, up)) / (along(place) * half);
  return (side + 1.0) / 2.0 * static_cast<double>(resolution) - shift_texels + glm::dvec2(corner);
}

inline glm::dvec3 MapTile::place_of(glm::ivec2 texel) const { return place_at(glm::dvec2(texel) + 0.5); }

inline glm::dvec3 MapTile::place_at(glm::dvec2 texels) const {
  const glm::dvec2 at = texels - glm::dvec2(corner);
  if (orthographic) return {at * (2 * half / resolution) - half_m() + centre_m, 1};
  const glm::dvec2 side = (2.0 * (at + shift_texels) / static_cast<double>(resolution) - 1.0) * half;
  return forward + side.x * right + side.y * up;
}

}  // namespace noonmark
