// V(P, x): whether P's surface is lit at the place x, if the surface is continued from P to there. The rungs R1 to R3
// of the ladder are this one function at different places. It also contains the rule that distinguishes an occluder
// from P's own surface.
//
// - H is the first hit of the light's ray through x; z_H is the depth of H.
// - S is the depth of P's own sheet at x. The sheet is followed in a straight line, as the light sees it, from P to x,
//   from triangle to triangle. Two triangles belong to one sheet if their edges have equal corners, or if their borders
//   meet except for the rounding of their vertices; the dihedral angle does not matter. If the sheet ends before x, at
//   a point E of a fold or a boundary, S is the smaller of the depth of E and the depth of P's tangent plane at x.
// - V is lit if z_H >= S. V is also lit if P is lit and the depth of the first hit does not jump on the way from P to
//   x: then no shadow edge lies between P and x, and a tap that is dark there is acne and not aliasing.
// - A step that the rounding of vertices can have made is not a jump. A hit that may lie in one plane with P's sheet
//   belongs to the sheet (raytrace/vertex_rounding.h).
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>

#include "raytrace/adjacency.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_cells.h"
#include "raytrace/light_view.h"
#include "raytrace/silhouettes.h"

namespace noonmark {

struct SurfacePoint {
  glm::dvec3 at{0};            // the place of P as the light sees it (raytrace/light_view.h)
  uint32_t primitive = 0;      // the triangle it lies on
  bool lit = false;            // R1
  bool on_silhouette = false;  // lit, and on a silhouette within double's rounding, such as its own surface's border
  bool beside = true;          // a silhouette is so near that P may lie on it; false only if none is
  bool on_surface = false;     // the rounding of P has not put it beside its surface
};

class OwnSurface {
 public:
  // silhouettes, cells: of the same light. All of them must outlive it. Without cells, rays are cast instead.
  OwnSurface(const EmbreeScene& embree, const Adjacency& adjacency, const LightView& view,
             const Silhouettes& silhouettes, LightCells* cells = nullptr)
      : embree_(embree), adjacency_(adjacency), view_(view), silhouettes_(silhouettes), cells_(cells) {}

  SurfacePoint point(glm::dvec3 light, uint32_t primitive, bool lit) const;  // light: P in the light's frame

  // sure: neither float error nor the error of a cut mask's border (Scene::mask_error_m) changes the verdict, and float
  // error does not change whether the first hit is before the near plane.
  struct Verdict {
    bool lit = false;
    bool sure = true;
  };

  // V(P, x). hit: the triangle of the first hit on the light ray through x, or no_primitive.
  Verdict lit_at(const SurfacePoint& p, glm::dvec3 x, uint32_t hit) const {
    return lit_at<Silhouettes>(p, x, hit, silhouettes_, silhouettes_.near(x));
  }
  // The same, if these silhouettes were listed around P and x. away: none is near x, for sure.
  Verdict lit_at(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, const Silhouettes::Nearby& nearby,
                 bool away = false) const {
    return lit_at<Silhouettes::Nearby>(p, x, hit, nearby, !away && nearby.near(x));
  }

  // Remembers which triangles known_in() compared: P's with one, or with those of a sheet.
  class Pair {
   public:
    struct Of {
      uint32_t own = no_primitive, front = no_primitive;
      const uint32_t* sheet = nullptr;  // the first one in its list
      bool operator==(const Of&) const = default;
    };
    bool apart(const Of& pair, const auto& compare) {
      const uintptr_t sheet = reinterpret_cast<uintptr_t>(pair.sheet) / sizeof(uint32_t);
      Entry& entry = entries_[(pair.own * 7 + pair.front + sheet + sheet / entries_.size()) % entries_.size()];
      if (!(entry.pair == pair)) entry = {pair, compare()};
      return entry.apart;
    }

   private:
    struct Entry {
      Of pair;
      bool apart = false;
    };
    std::array<Entry, 64> entries_;  // those of different places replace one another
  };
  // V(P, x) if it is the same at every place x of a rectangle of the light's plane, for sure, because certified surfaces are
  // before everything else there; no value if that is not known. reader: reads this surface's cells, which know the first hit of
  // a ray without tracing it.
  std::optional<bool> known_in(const SurfacePoint& p, glm::dvec2 low, glm::dvec2 high, LightCells::Reader& reader,
                               Pair& last) const;
  // The same where the walk from P to each place of the rectangle leaves P's triangle: if it arrives in one triangle, or ends on
  // one edge. p: in the frame of the cells.
  std::optional<bool> known_on_sheet(const SurfacePoint& p, glm::dvec2 low, glm::dvec2 high, LightCells::Reader& reader,
                                     Pair& last) const;

  // V differs at `from` and `to`, so it changes between them.
  struct EdgeSearch {
    const SurfacePoint* p = nullptr;
    glm::dvec3 from{0}, to{0};
    bool lit_from = false;
    float distance_texels = 0;
  };
  // Raises distance_texels of each to the distance from `from` to the change, in texels, found to 2^-8 of the way. Of a distance
  // that is less only this is found out. At most packet_size searches, because they share the packets of rays.
  void find_edges(std::span<EdgeSearch> searches) const;

  // Whether the light ray through x passes through the triangle, in double.
  bool covers(uint32_t triangle, glm::dvec3 x) const;

  // The triangle that the exact ray through x meets first, or no_primitive: of all triangles of x's cell, the first one
  // that covers x in double. Without cells: of all triangles that the float ray meets, and of those that end so near to
  // x that it may have missed them.
  uint32_t exact_first(glm::dvec3 x) const;

  // Every triangle that the exact ray through x may meet: those that the float ray meets, those that end so near to x
  // that it may have missed them, and where their sheets continue to below x. With repetitions; some do not cover x.
  void list_met(glm::dvec3 x, std::vector<uint32_t>& met) const;

  struct Sheet {
    double depth_m = 0;                // S
    uint32_t triangle = no_primitive;  // where the walk arrived, or no_primitive when it ended early
  };
  // over_seams: the sheet also continues where borders meet except for rounding.
  Sheet walk(const SurfacePoint& p, glm::dvec3 x, bool over_seams = true) const;

 private:
  // Edges: Silhouettes, or those nearby. beside: one of them is near x.
  template <class Edges>
  Verdict lit_at(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, const Edges& silhouettes, bool beside) const;

  // S at x, walked to when it is first asked for: several steps of a verdict need it.
  class SheetAt {
   public:
    SheetAt(const OwnSurface& surface, const SurfacePoint& p, glm::dvec3 x) : surface_(surface), p_(p), x_(x) {}
    const Sheet& operator*() {
      if (!sheet_) sheet_ = surface_.walk(p_, x_);
      return *sheet_;
    }

   private:
    const OwnSurface& surface_;
    const SurfacePoint& p_;
    glm::dvec3 x_;
    std::optional<Sheet> sheet_;
  };

  // The silhouettes between P and x, where a jump of the first hit matters: not of a dark P. Searched for when they are first
  // asked for.
  template <class Edges>
  class CrossedBy {
   public:
    CrossedBy(const Edges& silhouettes, const SurfacePoint& p, glm::dvec3 x)
        : silhouettes_(silhouettes), p_(p), x_(x) {}
    const std::vector<Silhouettes::Crossing>& operator*() {
      if (!crossed_) crossed_ = p_.lit ? silhouettes_.crossings(p_.at, x_) : std::vector<Silhouettes::Crossing>();
      return *crossed_;
    }

   private:
    const Edges& silhouettes_;
    const SurfacePoint& p_;
    glm::dvec3 x_;
    std::optional<std::vector<Silhouettes::Crossing>> crossed_;
  };

  // The verdict for this first hit, if it needs no silhouette that is crossed.
  std::optional<Verdict> whatever_is_crossed(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, SheetAt& own) const;
  // The verdict for this first hit. own: of P at x. crossed: a CrossedBy of P and x.
  template <class Crossed>
  Verdict verdict(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, SheetAt& own, Crossed& crossed) const;
  // The ray that was cast may lie on the other side of a silhouette than the exact ray only if the silhouette is nearer
  // to x than this.
  double beside_m() const { return Silhouettes::reach_of(view_); }
  // A place nearer than this to a silhouette lies on either side of it, by the rounding of double. It is more than the
  // distance between the places of one point in two frames of one light, whose origins differ by the shift of the
  // map's grid: so a tie in one frame is a tie in all of them.
  double tie_m() const;
  // The triangles that cover x in double; with repetitions where no cells are.
  void list_covering(glm::dvec3 x, std::vector<uint32_t>& covering) const;
  // On a silhouette (within tie_m()): every triangle, or no_primitive, that may be the first hit, by rounding.
  void firsts_of_tie(glm::dvec3 x, std::vector<uint32_t>& firsts) const;
  // Where the walks to all places of a rectangle of the light's plane arrive.
  struct SheetIn {
    uint32_t triangle = no_primitive;  // or no_primitive, when they all end early, on one edge
    double end_m = 0;                  // where they end no point has less depth
  };
  // No value if they go different ways, or rounding may decide which. x: the rectangle's corners. Of parallel rays. What is asked
  // of a place changes linearly over the rectangle, so it holds in the rectangle if it holds at its corners.
  std::optional<SheetIn> walk_in(const SurfacePoint& p, const std::array<glm::dvec3, 4>& x) const;
  static std::array<glm::dvec3, 4> corners_of(glm::dvec2 low, glm::dvec2 high) {
    return {{{low.x, low.y, 1}, {high.x, low.y, 1}, {low.x, high.y, 1}, {high.x, high.y, 1}}};
  }
  // The depths of a triangle's plane in a rectangle.
  struct DepthsIn {
    double nearest_m = std::numeric_limits<double>::infinity(), deepest_m = -nearest_m;
  };
  DepthsIn depths_in(uint32_t triangle, const std::array<glm::dvec3, 4>& corners) const;
  // V in a rectangle where P's sheet is the triangle `own`, which covers it; no value if it is not known.
  std::optional<bool> as_seen(const SurfacePoint& p, uint32_t own, glm::dvec2 low, glm::dvec2 high,
                              LightCells::Reader& reader, Pair& last) const;
  uint32_t next_on_sheet(uint32_t triangle, int edge, uint32_t from, glm::dvec3 x) const;
  // end: of the sheet, in the light's frame.
  uint32_t across_seam(uint32_t triangle, glm::dvec3 end, glm::dvec3 x) const;
  // Whether the depth of the first hit does not jump between P, which is lit, and x. It can jump only where the way
  // crosses a silhouette.
  Verdict continuous(const SurfacePoint& p, glm::dvec3 x, uint32_t hit,
                     const std::vector<Silhouettes::Crossing>& crossed) const;
  // Whether the first hits on the two sides of these crossings belong to one sheet, except for the rounding of
  // vertices.
  Verdict joins(uint32_t before, uint32_t after, const std::vector<Silhouettes::Crossing>& at, size_t first,
                size_t last, const auto& place) const;
  // Whether a surface continues at P, which is lit, if the rounding of P has put it beside its triangle.
  bool goes_on_at(const SurfacePoint& p) const;
  // Whether this hit is P's own sheet, or behind it, within the error of the ray.
  bool may_be_lit(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, SheetAt& own) const;
  double length_m(const SurfacePoint& p, glm::dvec3 x) const;  // of the way, across the light's rays at P
  double rounding_of_sheet(const SurfacePoint& p, glm::dvec3 x, const Sheet& sheet, uint32_t hit) const;
  // The largest difference between two computed depths of the same point. A ray that misses x by its float error may
  // meet the sheet's next triangle, whose plane differs there by the error times the slopes. The slope of edge-on
  // triangles is not used.
  double depth_error(uint32_t a, uint32_t b, glm::dvec3 x) const;

  const EmbreeScene& embree_;
  const Adjacency& adjacency_;
  const LightView& view_;
  const Silhouettes& silhouettes_;
  LightCells* cells_;
};

}  // namespace noonmark
