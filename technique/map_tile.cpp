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

}  // namespace noonmark
