// The placements of a map's grid of texels. The same map can lie anywhere within one texel: the error of a lookup
// depends on that, although nobody chooses it. Each kind of light defines how its placements differ
// (KindOfLight::place_grid).
//
// Of a flat map, S x S placements shift the grid by whole multiples of 1/S texel along each axis (of a texel of the mip
// level that a lookup reads: LightFrame::texel_block). They are a stratified
// sample of all placements, because a shift by one texel gives the same grid. The texel centres of all placements form
// one finer grid, the *lattice*: S points along each side of a texel. So one set of light-side rays, through the points
// of the lattice, answers for every placement.
//
// Of a cube map, S x S placements are turns of the cube about the light, a stratified sample of all rotations
// (technique/lights/point.cpp). Two turns share no texel centre, so there is no lattice, and each is measured by itself.
//
//   const Placements placements(settings.map.placements);
//   LightFrame moved = placements.frame(frame, 9);           // the map of placement 9
//   glm::ivec2 k(placements.point(12, placements.column(9)), placements.point(7, placements.row(9)));
//                                                            // the lattice point of its texel (12, 7)
//   glm::dvec3 x = placements.lattice(frame).texel_place(k); // the place of that texel's centre
#pragma once
#include <algorithm>
#include <array>
#include <glm/glm.hpp>

#include "technique/evidence.h"
#include "technique/light_frame.h"

namespace noonmark {

class Placements {
 public:
  static constexpr int most = 64;  // along one axis

  explicit Placements(int side) : side_(side) {}

  int side() const { return side_; }
  int count() const { return side_ * side_; }
  // Placement j * side + i has column i and row j. Placement 0 is the map as the settings place it.
  int column(int placement) const { return placement % side_; }
  int row(int placement) const { return placement / side_; }

  // The shift of a column or a row, in steps of 1/S texel: 0, 1, ... and then the negative ones, so that no shift
  // exceeds half a texel.
  int step(int i) const { return 2 * i < side_ ? i : i - side_; }
  glm::dvec2 shift_texels(int placement) const {
    return glm::dvec2(step(column(placement)), step(row(placement))) / static_cast<double>(side_);
  }

  LightFrame frame(const LightFrame& map, int placement) const;
  // The map whose texels are the lattice's points: S times the resolution.
  LightFrame lattice(const LightFrame& map) const;

  // The lattice point of a texel along one axis, for column or row i; and back.
  int point(int texel, int i) const { return side_ * texel + step(i); }
  int first_point(int texel) const { return side_ * texel + step((side_ + 1) / 2); }  // the first of a texel's S points
  int texel_of(int point) const { return floor_div(point - first_point(0), side_); }
  glm::ivec2 texel_of(glm::ivec2 point) const { return {texel_of(point.x), texel_of(point.y)}; }

 private:
  static int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }
  int side_;
};

// Where the taps of a receiver read, at every placement.
struct PlacedTaps {
  int side = 1;  // the number of columns and of rows
  // The position of the receiver in the map, in texels, for each column and each row.
  std::array<float, Placements::most> x{}, y{};
  // [tap * side + i]: the lattice point that the tap reads, for each column and each row.
  std::vector<int> column, row;
  std::vector<glm::ivec2> square;  // its memory is used again
  glm::ivec2 low{0}, high{-1};     // all lattice points that the taps read; empty if the lookup asks nothing

  glm::ivec2 size() const { return high - low + 1; }
  // Calls visit(low, high) with the lattice points of each tap: its columns are whole numbers in a row, and so are its rows.
  template <class Visit>
  void each_square(const Visit& visit) const {
    const auto s = static_cast<size_t>(side);
    for (size_t tap = 0; tap < column.size(); tap += s) {
      const auto [left, right] = std::minmax_element(&column[tap], &column[tap] + s);
      const auto [bottom, top] = std::minmax_element(&row[tap], &row[tap] + s);
      visit(glm::ivec2(*left, *bottom), glm::ivec2(*right, *top));
    }
  }
  // The index of a lattice point in the lists of the box's points (LatticeBox).
  size_t index(int k_x, int k_y) const {
    return static_cast<size_t>(k_y - low.y) * static_cast<size_t>(size().x) + static_cast<size_t>(k_x - low.x);
  }
};

// The lookup at every placement. The probes are those of the placements (i, i): the position along the map's columns
// depends on the column of the placement only, and along its rows on the row only. All other numbers of a probe are the
// same at every placement.
class PlacedProbe {
 public:
  // probe: of placement 0; it must outlive this object. positions: LookupProbe::map_texels of placement i * side + i.
  PlacedProbe(const Placements& placements, const LookupProbe& probe, std::vector<Image<glm::vec2>> positions)
      : placements_(placements), probe_(probe), positions_(std::move(positions)) {}

  const Placements& placements() const { return placements_; }
  const LookupProbe& probe() const { return probe_; }
  void taps_of(size_t pixel, PlacedTaps& taps) const { list(pixel, 0, placements_.side(), 0, taps); }
  // At one placement only: one column and one row.
  void taps_of(size_t pixel, int placement, PlacedTaps& taps) const {
    list(pixel, placements_.column(placement), 1, placements_.row(placement), taps);
  }

 private:
  // `side` columns from column, and as many rows from row.
  void list(size_t pixel, int column, int side, int row, PlacedTaps& taps) const;
  Placements placements_;
  const LookupProbe& probe_;
  std::vector<Image<glm::vec2>> positions_;
};

// What rays say at the lattice points of one receiver's box (PlacedTaps::index).
struct LatticeBox {
  // Of TapBits: tap_texel_lit, tap_near_clipped, tap_texel_unsure. A point that no tap reads has any.
  std::vector<uint8_t> bits;
  std::vector<float> depth;  // what the exact map of the placement holds at the texel that the lookup reads there
  // If true, all points have the same bits. The depth of a point that no tap reads is then not less than any depth that a
  // tap reads, so that the least depth of the box is one that a tap reads.
  bool alike = false;
};
inline constexpr uint8_t lattice_unknown = 128;  // not judged

}  // namespace noonmark
