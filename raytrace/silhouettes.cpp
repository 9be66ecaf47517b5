#include "raytrace/silhouettes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace noonmark {
namespace {

constexpr int least_cells = 256, most_cells = 2048;  // on a side: from 0.25 to 16 MiB of offsets

// Does another triangle go on across this edge, on its other side as the light sees it?
bool goes_on(const Adjacency& adjacency, const LightView& view, uint32_t triangle, int edge) {
  const glm::dvec2 a = view.corner2(triangle, edge), b = view.corner2(triangle, (edge + 1) % 3);
  const double own = orientation(a, b, view.corner2(triangle, (edge + 2) % 3));
  for (uint32_t other : adjacency.across(triangle, edge)) {
    if (view.edge_on(other)) continue;
    for (int i = 0; i < 3; ++i) {
      const uint32_t v = adjacency.welded(other)[i];
      if (v == adjacency.welded(triangle)[edge] || v == adjacency.welded(triangle)[(edge + 1) % 3]) continue;
      const double side = orientation(a, b, view.corner2(other, i));
      if ((own > 0 && side < 0) || (own < 0 && side > 0)) return true;
    }
  }
  return false;
}

}  // namespace

// Every cell that the edge, widened by the reach, touches: row by row, from the edge's part over that row.
void Silhouettes::each_cell(const Edge& edge, double reach_m, const auto& visit) const {
  const glm::dvec2 a = (glm::dvec2(edge.a) - low_) * cells_per_m_, b = (glm::dvec2(edge.b) - low_) * cells_per_m_;
  const double reach = reach_m * cells_per_m_ + 1e-6;
  const auto cell = [&](double at) { return static_cast<int>(std::clamp(at, 0.0, size_ - 1.0)); };
  for (int row = cell(std::min(a.y, b.y) - reach); row <= cell(std::max(a.y, b.y) + reach); ++row) {
    double left = std::min(a.x, b.x), right = std::max(a.x, b.x);
    if (a.y != b.y) {
      const auto x_at = [&](double y) { return a.x + std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x); };
      const double x0 = x_at(row - reach), x1 = x_at(row + 1 + reach);
      left = std::min(x0, x1);
      right = std::max(x0, x1);
    }
    for (int column = cell(left - reach); column <= cell(right + reach); ++column)
      visit(static_cast<size_t>(row) * static_cast<size_t>(size_) + static_cast<size_t>(column));
  }
}

Silhouettes::Silhouettes(const Adjacency& adjacency, const LightView& view, double reach_m) : reach_m_(reach_m) {
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
  for (uint32_t t = 0; t < adjacency.triangles(); ++t) {
    for (int e = 0; e < 3; ++e) {
      if (goes_on(adjacency, view, t, e)) continue;
      const Edge edge{view.corner(t, e), view.corner(t, (e + 1) % 3), t};
      edges_.push_back(edge);
      low = glm::min(low, glm::dvec2(glm::min(edge.a, edge.b)));
      high = glm::max(high, glm::dvec2(glm::max(edge.a, edge.b)));
    }
  }
  if (edges_.empty()) return;
  size_ = std::clamp(static_cast<int>(4 * std::sqrt(static_cast<double>(edges_.size()))), least_cells, most_cells);
  low_ = low - reach_m;
  const double width = std::max(high.x - low.x, high.y - low.y) + 2 * reach_m;
  cells_per_m_ = size_ / (width * (1 + 1e-9));

  begin_.assign(static_cast<size_t>(size_) * static_cast<size_t>(size_) + 1, 0);
  for (const Edge& edge : edges_) each_cell(edge, reach_m, [&](size_t cell) { ++begin_[cell + 1]; });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  listed_.resize(begin_.back());
  std::vector<uint32_t> fill(begin_.begin(), begin_.end() - 1);
  for (uint32_t e = 0; e < edges_.size(); ++e)
    each_cell(edges_[e], reach_m, [&](size_t cell) { listed_[fill[cell]++] = e; });
}

size_t Silhouettes::cell_of(glm::dvec2 x) const {
  const glm::dvec2 at = glm::clamp((x - low_) * cells_per_m_, glm::dvec2(0), glm::dvec2(size_ - 1.0));
  return static_cast<size_t>(at.y) * static_cast<size_t>(size_) + static_cast<size_t>(at.x);
}

std::vector<Silhouettes::Crossing> Silhouettes::crossings(glm::dvec2 from, glm::dvec2 to) const {
  std::vector<Crossing> at;
  if (edges_.empty()) return at;
  // Most taps stay within a cell that lists no edge: an edge is listed wherever it comes within reach of the cell.
  const size_t begin = cell_of(from), end = cell_of(to);
  if (begin == end && begin_[begin] == begin_[begin + 1]) return at;
  const glm::dvec2 way = to - from;
  const double length2 = glm::dot(way, way);
  each_cell({glm::dvec3(from, 0), glm::dvec3(to, 0), 0}, 0, [&](size_t cell) {
    for (uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      const Edge& edge = edges_[listed_[i]];
      const glm::dvec2 start(edge.a), along = glm::dvec2(edge.b) - start;
      const double a = orientation(from, to, start), b = orientation(from, to, glm::dvec2(edge.b));
      if ((a > 0 && b > 0) || (a < 0 && b < 0) || a == b) continue;
      const double part = a / (a - b), t = glm::dot(start + part * along - from, way) / length2;
      const double sine = std::abs(a - b) / std::sqrt(length2 * glm::dot(along, along));
      if (t > 0 && t < 1) at.push_back({t, sine, edge.a.z + part * (edge.b.z - edge.a.z)});
    }
  });
  std::sort(at.begin(), at.end(), [](const Crossing& x, const Crossing& y) { return x.t < y.t; });
  at.erase(std::unique(at.begin(), at.end()), at.end());  // an edge is listed in many cells
  return at;
}

void Silhouettes::near(glm::dvec2 x, std::vector<uint32_t>& triangles) const {
  const glm::dvec2 at = (x - low_) * cells_per_m_;
  if (!(at.x >= 0 && at.y >= 0 && at.x < size_ && at.y < size_)) return;
  near_listed(x, static_cast<size_t>(at.y) * static_cast<size_t>(size_) + static_cast<size_t>(at.x), reach_m_,
              &triangles);
}

bool Silhouettes::near_listed(glm::dvec2 x, size_t cell, double within_m, std::vector<uint32_t>* triangles) const {
  bool any = false;
  for (uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
    const Edge& edge = edges_[listed_[i]];
    const glm::dvec2 start(edge.a), way = glm::dvec2(edge.b) - start;
    const double length2 = glm::dot(way, way);
    const double along = length2 > 0 ? std::clamp(glm::dot(x - start, way) / length2, 0.0, 1.0) : 0;
    const glm::dvec2 beside = x - start - along * way;
    if (glm::dot(beside, beside) > within_m * within_m) continue;
    if (!triangles) return true;
    triangles->push_back(edge.triangle);
    any = true;
  }
  return any;
}

}  // namespace noonmark
