#include "technique/placements.h"

#include <algorithm>

namespace noonmark {

LightFrame Placements::frame(const LightFrame& map, int placement) const {
  LightFrame moved = map;
  moved.light().place_grid(moved, *this, placement);
  return moved;
}

// The centre of texel t of column i lies at t + 1/2 + step(i) / S texels; point k of the lattice at (k + 1/2) / S plus
// the lattice's own shift. Both are the same for k = S t + step(i) if the lattice is shifted by (S - 1) / 2 of its
// points.
LightFrame Placements::lattice(const LightFrame& map) const {
  LightFrame fine = map;
  fine.resolution = map.resolution * side_;
  fine.rows = map.rows * side_;
  fine.light().refine_grid(fine, side_);
  fine.light().shift_grid(fine, glm::dvec2((side_ - 1) / 2.0));
  return fine;
}

void PlacedProbe::list(size_t pixel, int column, int side, int row, PlacedTaps& taps) const {
  const int count = probe_.taps();
  taps.side = side;
  taps.column.resize(static_cast<size_t>(count * side));
  taps.row.resize(taps.column.size());
  taps.low = glm::ivec2(0);
  taps.high = glm::ivec2(-1);
  if (!probe_.asks(pixel)) return;
  taps.low = glm::ivec2(std::numeric_limits<int>::max());
  taps.high = glm::ivec2(std::numeric_limits<int>::min());
  for (int i = 0; i < side; ++i) {
    const glm::vec2 at(positions_[static_cast<size_t>(column + i)][pixel].x,
                       positions_[static_cast<size_t>(row + i)][pixel].y);
    taps.x[static_cast<size_t>(i)] = at.x;
    taps.y[static_cast<size_t>(i)] = at.y;
    const int square = probe_.pattern.texel_side();
    if (square > 0) probe_.square_at(at, pixel, taps.square);
    for (int t = 0; t < count; ++t) {
      const glm::ivec2 texel = square > 0 ? glm::ivec2(taps.square[static_cast<size_t>(t % square)].x,
                                                       taps.square[static_cast<size_t>(t / square)].y)
                                          : probe_.texel_at(at, pixel, t);
      const glm::ivec2 k(placements_.point(texel.x, column + i), placements_.point(texel.y, row + i));
      taps.column[static_cast<size_t>(t * side + i)] = k.x;
      taps.row[static_cast<size_t>(t * side + i)] = k.y;
      taps.low = glm::min(taps.low, k);
      taps.high = glm::max(taps.high, k);
    }
  }
}

}  // namespace noonmark
