// Silhouettes: the edges at which a surface, as the light sees it, does not continue. These are folds (both triangles
// lie on the same side of the edge) and boundaries (the edge has one triangle). The depth that the light sees can jump
// only there. The edges are listed in a grid for each chart of the light's rays (technique/light_rays.h).
// A ray that is further from every silhouette than its float error meets the same triangle as the exact ray; the other
// rays, which are few, are checked in double. Built once for a light (raytrace/traced_scene.h).
#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/adjacency.h"
#include "raytrace/light_view.h"

namespace noonmark {

// Calls visit(other) for each triangle over which the surface continues beyond this edge, as the light sees it: the
// other triangle lies on the other side of the edge. An edge without one is a silhouette.
template <class Visit>
void each_beyond(const Adjacency& adjacency, const LightView& view, uint32_t triangle, int edge, const Visit& visit) {
  const glm::dvec3 a = view.corner(triangle, edge), b = view.corner(triangle, (edge + 1) % 3);
  const double own = view.orientation(a, b, view.corner(triangle, (edge + 2) % 3));
  const std::array<uint32_t, 3>& corners = adjacency.welded(triangle);
  for (uint32_t other : adjacency.across(triangle, edge)) {
    if (view.edge_on(other)) continue;
    for (int i = 0; i < 3; ++i) {
      const uint32_t v = adjacency.welded(other)[i];
      if (v == corners[edge] || v == corners[(edge + 1) % 3]) continue;
      const double side = view.orientation(a, b, view.corner(other, i));
      if ((own > 0 && side < 0) || (own < 0 && side > 0)) {
        visit(other);
        break;
      }
    }
  }
}

// Bytes of the silhouettes of a light, of so many edges of triangles and charts. open: the edges with one triangle, each of which
// is a silhouette: the edge, its pieces and the cells that list it [220 measured]. A third of the closed ones may be silhouettes
// too, if the light sees a fold.
inline double silhouette_bytes(double edges, double open, double charts) {
  constexpr double per_open_edge = 240, per_closed_edge = 70, per_cell = 8;
  constexpr double least_cells = 256 * 256, most_cells = 2048 * 2048;
  return per_open_edge * open + per_closed_edge * (edges - open) +
         per_cell * charts * std::clamp(16 * edges, least_cells, most_cells);
}

class Silhouettes {
 public:
  // reach_m: the distance that counts as near, in metres across the light's rays.
  Silhouettes(const Adjacency& adjacency, const LightView& view, double reach_m);
  // The ray that was cast may pass on the other side of a silhouette than the exact ray only if the silhouette is
  // nearer to the exact ray than this. A silhouette that is the border of a cut mask may itself lie elsewhere.
  static double reach_of(const LightView& view) { return 2 * view.ray_error_m() + view.scene().mask_error_m; }

  // Whether a silhouette lies within reach_m, or within within_m, of x.
  bool near(glm::dvec3 x) const { return near(x, reach_m_); }
  bool near(glm::dvec3 x, double within_m) const {
    glm::dvec2 at;
    const Grid& grid = grid_of(x, at);
    return grid.holds(at) && !grid.empty(grid.cell_of(at)) && near_listed(x, within_m, nullptr);
  }
  // The same, and the triangles that have those edges.
  void near(glm::dvec3 x, std::vector<uint32_t>& triangles) const { near(x, reach_m_, triangles); }
  void near(glm::dvec3 x, double within_m, std::vector<uint32_t>& triangles) const {
    near_listed(x, within_m, &triangles);
  }

  struct Crossing {
    double t = 0;           // fraction of the way
    double sine = 1;        // of the angle between the way and the edge
    double depth_m = 0;     // of the edge
    double rounding_m = 0;  // by how much the rounding of the edge's ends may have moved it
    bool operator==(const Crossing&) const = default;
  };
  // Where the straight way crosses silhouettes, in order.
  std::vector<Crossing> crossings(glm::dvec3 from, glm::dvec3 to) const;

  // A rectangle of a chart. Of parallel rays, it is a rectangle of the light's plane.
  struct Rectangle {
    int chart = 0;
    glm::dvec2 low{0}, high{0};
  };

  // Straight ways of the light's plane from one place, as flat arrays, so that many of them are asked at once.
  struct Ways {
    glm::dvec2 from{0};
    double unit_m = 1;        // of x and y
    double most_m = 0;        // the largest coordinate from which `from` and the ends were computed
    std::vector<float> x, y;  // from `from` to the end of each way
    // The answers of Nearby::answer().
    std::vector<int32_t> open;    // 0 only if the way is clear
    std::vector<int32_t> beside;  // 0 only if near(end) is false
    void clear() { x.clear(), y.clear(); }
    void push(glm::dvec2 way) {
      x.push_back(static_cast<float>(way.x));
      y.push_back(static_cast<float>(way.y));
    }
  };

  // The silhouettes among a set of places that lie close together, listed once for many questions. The answers are the
  // same as those of all silhouettes, for places within the rectangle around the set and within_m up to reach_m.
  class Nearby {
   public:
    bool none() const { return listed_ && edges_.empty(); }
    bool near(glm::dvec3 x) const { return near(x, all_->reach_m_); }
    bool near(glm::dvec3 x, double within_m) const;
    std::vector<Crossing> crossings(glm::dvec3 from, glm::dvec3 to) const;
    // True only if none of them comes within reach_m of a place of the rectangle, so that none crosses a way inside it. Of
    // parallel rays.
    bool none_in(const Rectangle& rectangle) const;
    // Which ways are clear: crossings(from, end) is empty and near(end) is false; and of which only the second is known. Of parallel rays; the ways must lie inside
    // the rectangle around which the silhouettes were listed.
    void answer(Ways& ways) const;

   private:
    friend class Silhouettes;
    const Silhouettes* all_ = nullptr;
    bool listed_ = false;  // false: the places lie in several charts, and all silhouettes are asked
    std::vector<uint32_t> edges_;
    // Of parallel rays: the ends of the edges in the light's plane, and the largest coordinate of them.
    struct Ends {
      glm::dvec2 a, b;
    };
    std::vector<Ends> ends_;
    double farthest_m_ = 0;
  };
  // True only if no silhouette comes within reach_m of a place of the rectangle, so that none crosses a way inside it.
  bool none_in(const Rectangle& rectangle) const {
    const Grid& grid = grids_[static_cast<size_t>(rectangle.chart)];
    return grid.size == 0 || grid.empty_between(rectangle.low, rectangle.high);
  }
  // True only if near() is false at each place of the quadrilateral with these corners.
  bool none_between(std::span<const glm::dvec3> corners) const {
    const std::optional<Rectangle> around = rectangle(corners);
    return around && none_in(*around);
  }
  // Whether of(triangle) is true of a triangle that has a silhouette which comes, or may come, within reach_m of a place of the
  // rectangle.
  bool any_near(const Rectangle& rectangle, const auto& of) const {
    const Grid& grid = grids_[static_cast<size_t>(rectangle.chart)];
    if (none_in(rectangle)) return false;
    const size_t begin = grid.cell_of(rectangle.low), end = grid.cell_of(rectangle.high);
    const size_t row = static_cast<size_t>(grid.size), columns = (end - begin) % row;
    for (size_t cell = begin; cell <= end; cell += row)
      for (uint32_t i = grid.begin[cell]; i < grid.begin[cell + columns + 1]; ++i) {
        const Edge& edge = edges_[grid.listed[i]];
        const auto segment = view_.rays().in_chart(rectangle.chart, edge.a, edge.b, reach_m_);
        if (segment && !beside(rectangle.low, rectangle.high, segment->a, segment->b, segment->reach) &&
            of(edge.triangle))
          return true;
      }
    return false;
  }
  // nearby: its memory is used again.
  void list_in(const Rectangle& rectangle, Nearby& nearby) const;
  // The same around these places.
  void list_nearby(std::span<const glm::dvec3> places, Nearby& nearby) const;

 private:
  struct Edge {
    glm::dvec3 a, b;  // in the light's frame
    uint32_t triangle = 0;
    double rounding_m = 0;
  };
  // Whether x lies within within_m of an edge.
  bool is_near(const Edge& edge, glm::dvec3 x, double within_m) const {
    if (view_.rays().have_one_direction()) {     // most edges are further away along one axis already
      const double far = within_m * (1 + 1e-9);  // and the rounding of double
      if (x.x - std::max(edge.a.x, edge.b.x) > far || std::min(edge.a.x, edge.b.x) - x.x > far ||
          x.y - std::max(edge.a.y, edge.b.y) > far || std::min(edge.a.y, edge.b.y) - x.y > far)
        return false;
    }
    return view_.rays().distance2_across(x, edge.a, edge.b) <= within_m * within_m;
  }
  // A square of a chart.
  struct Grid {
    glm::dvec2 low{0};
    double cells_per_unit = 0;
    int size = 0;                 // cells on a side; 0: no edge is in it
    std::vector<uint32_t> begin;  // [cell] into listed
    std::vector<uint32_t> listed;

    bool holds(glm::dvec2 x) const {
      const glm::dvec2 at = (x - low) * cells_per_unit;
      return at.x >= 0 && at.y >= 0 && at.x < size && at.y < size;
    }
    size_t cell_of(glm::dvec2 x) const {  // of the nearest place in the grid, where x lies outside
      const glm::dvec2 at = glm::clamp((x - low) * cells_per_unit, glm::dvec2(0), glm::dvec2(size - 1.0));
      return static_cast<size_t>(at.y) * static_cast<size_t>(size) + static_cast<size_t>(at.x);
    }
    void each_cell(glm::dvec2 a, glm::dvec2 b, double reach, const auto& visit) const;
    bool empty(size_t cell) const { return begin[cell] == begin[cell + 1]; }
    // The same of all cells of the rectangle between a and b. The cells of one row follow each other in `begin`.
    bool empty_between(glm::dvec2 a, glm::dvec2 b) const {
      const size_t first = cell_of(glm::min(a, b)), last = cell_of(glm::max(a, b)), row = static_cast<size_t>(size);
      const size_t columns = (last - first) % row;  // last lies in no column before first's
      for (size_t cell = first; cell <= last; cell += row)
        if (begin[cell] != begin[cell + columns + 1]) return false;
      return true;
    }
  };
  // A part of an edge in one grid.
  struct Piece {
    glm::dvec2 a, b;
    double reach;
    uint32_t edge;
  };

  void fill(Grid& grid, const std::vector<Piece>& pieces);
  // The rectangle around these places in their chart; no value if they lie in several.
  std::optional<Rectangle> rectangle(std::span<const glm::dvec3> places) const;
  // The grid that x lies in, and where.
  const Grid& grid_of(glm::dvec3 x, glm::dvec2& at) const {
    return grids_[static_cast<size_t>(view_.rays().chart_of(x, at))];
  }
  bool near_listed(glm::dvec3 x, double within_m, std::vector<uint32_t>* triangles) const;
  void cross(uint32_t edge, glm::dvec3 from, glm::dvec3 to, std::vector<Crossing>& at) const;
  static void put_in_order(std::vector<Crossing>& at);
  // True only if the segment from a to b passes beside the rectangle by more than reach.
  static bool beside(glm::dvec2 low, glm::dvec2 high, glm::dvec2 a, glm::dvec2 b, double reach);

  LightView view_;
  double reach_m_;
  std::vector<Edge> edges_;
  std::vector<Grid> grids_;  // one for each chart
};

}  // namespace noonmark
