// Which triangles share an edge. Two edges are the same edge if their end positions are exactly equal; indices, meshes
// and the dihedral angle do not matter. Built once for a scene.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace noonmark {

class Adjacency {
 public:
  explicit Adjacency(const Scene& scene);

  // The first triangle with exactly the same corners and the same winding. That is t itself, unless t is a copy of an
  // earlier triangle. All copies hide the same things, so rays and walks use the first one only.
  uint32_t first(uint32_t t) const { return first_[t]; }
  bool is_copy(uint32_t t) const { return first_[t] != t; }
  bool any_copies() const { return any_copies_; }
  // Every triangle that is no copy; empty where there are no copies.
  std::vector<uint32_t> without_copies() const;

  // The other triangles at edge `edge` (0: corners 0-1, 1: 1-2, 2: 2-0) of `triangle`. Copies are not among them, and
  // a copy itself has none.
  std::span<const uint32_t> across(uint32_t triangle, int edge) const;

  uint32_t triangles() const { return static_cast<uint32_t>(welded_.size()); }

  // The corners of a triangle as welded vertices: equal numbers mean exactly equal positions.
  const std::array<uint32_t, 3>& welded(uint32_t triangle) const { return welded_[triangle]; }

 private:
  std::vector<std::array<uint32_t, 3>> welded_;
  std::vector<uint32_t> first_;
  bool any_copies_ = false;
  std::vector<uint32_t> begin_;  // [3 * triangle + edge] into neighbours_
  std::vector<uint32_t> neighbours_;
};

}  // namespace noonmark
