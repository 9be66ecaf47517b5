// Where the light-side depth may jump: the edges at which a surface, as the light sees it, does not go on (folds and
// boundaries), in a grid over the light's plane. A ray that keeps its distance from all of them meets what the exact
// ray meets; the few that do not are asked again beside their places. Built once for a light.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "raytrace/adjacency.h"
#include "raytrace/light_view.h"

namespace noonmark {

class Silhouettes {
 public:
  // reach_m: how near is near, in metres of the light's plane.
  Silhouettes(const Adjacency& adjacency, const LightView& view, double reach_m);

  // Is x within reach of such an edge, or nearer than that?
  bool near(glm::dvec2 x) const { return near(x, reach_m_); }
  bool near(glm::dvec2 x, double within_m) const {
    const glm::dvec2 at = (x - low_) * cells_per_m_;
    if (!(at.x >= 0 && at.y >= 0 && at.x < size_ && at.y < size_)) return false;
    const size_t cell = static_cast<size_t>(at.y) * static_cast<size_t>(size_) + static_cast<size_t>(at.x);
    return begin_[cell] != begin_[cell + 1] && near_listed(x, cell, within_m, nullptr);
  }
  // The same, and the triangles that have those edges.
  void near(glm::dvec2 x, std::vector<uint32_t>& triangles) const;

  struct Crossing {
    double t = 0;        // fraction of the way
    double sine = 1;     // of the angle between the way and the edge
    double depth_m = 0;  // of the edge
    bool operator==(const Crossing&) const = default;
  };
  // Where the straight way crosses such edges, in order.
  std::vector<Crossing> crossings(glm::dvec2 from, glm::dvec2 to) const;

 private:
  struct Edge {
    glm::dvec3 a, b;
    uint32_t triangle = 0;
  };
  void each_cell(const Edge& edge, double reach_m, const auto& visit) const;
  size_t cell_of(glm::dvec2 x) const;  // of the grid's nearest place, where x lies outside
  bool near_listed(glm::dvec2 x, size_t cell, double within_m, std::vector<uint32_t>* triangles) const;

  double reach_m_;
  glm::dvec2 low_{0};
  double cells_per_m_ = 0;
  int size_ = 0;                 // cells on a side
  std::vector<uint32_t> begin_;  // [cell] into listed_
  std::vector<uint32_t> listed_;
  std::vector<Edge> edges_;
};

}  // namespace noonmark
