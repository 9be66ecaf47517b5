// V(P, x): is P's surface lit at the place x of the light's plane, when it is carried along itself from P to there? The
// one function behind the ladder's rungs R1 to R3, and the rule that tells an occluder from P's own surface.
//
// - H is the first hit of the light's ray through x; z_H is its depth.
// - S is the depth at x of P's own sheet. The sheet is walked straight from P to x, across any dihedral angle, over
//   triangles whose edges have equal corners, or whose borders meet but for the rounding of their vertices. Where the
//   walk ends before x, at E (a fold as the light sees it, or a border), S is the smaller of two depths: that of E, and
//   that of P's tangent plane at x.
// - V is lit where z_H >= S. It is also lit where P is lit and the depth of the first hit has no jump on the way from P
//   to x: then no shadow's edge lies between the two, and a tap that is dark there is acne, not aliasing.
// - A step that the rounding of vertices can have made is no jump, and a hit that may be of one plane with P's sheet is
//   that sheet (raytrace/vertex_rounding.h).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "raytrace/adjacency.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "raytrace/silhouettes.h"

namespace noonmark {

struct SurfacePoint {
  glm::dvec3 at{0};            // the place of P as the light sees it (raytrace/light_view.h)
  uint32_t primitive = 0;      // the triangle it lies on
  bool lit = false;            // R1
  bool on_silhouette = false;  // lit, and on one to within double's rounding, its own surface's border for one
};

class OwnSurface {
 public:
  // silhouettes: of the same light. All of them must outlive it.
  OwnSurface(const EmbreeScene& embree, const Adjacency& adjacency, const LightView& view,
             const Silhouettes& silhouettes)
      : embree_(embree), adjacency_(adjacency), view_(view), silhouettes_(silhouettes) {}

  SurfacePoint point(glm::dvec3 light, uint32_t primitive, bool lit) const;  // light: P in the light's frame

  // sure: float error changes neither the verdict nor on which side of the near plane the light is first met.
  struct Verdict {
    bool lit = false;
    bool sure = true;
  };

  // hit: the triangle of the first hit on the light ray through x, or no_primitive.
  Verdict lit_at(const SurfacePoint& p, glm::dvec3 x, uint32_t hit) const;

  // Where V changes between two places with different verdicts, to 2^-8 of the way: the distance from `from` to there,
  // in texels.
  double edge_distance_texels(const SurfacePoint& p, glm::dvec3 from, glm::dvec3 to, bool lit_from) const;

  // Does the light ray through x pass the triangle, in double?
  bool covers(uint32_t triangle, glm::dvec3 x) const;

  // Is what the light meets first at x before the map's near plane?
  bool clipped(uint32_t hit, glm::dvec3 x) const;

  struct Sheet {
    double depth_m = 0;                // S
    uint32_t triangle = no_primitive;  // where the walk arrived, or no_primitive when it ended early
  };
  // over_seams: also where borders meet but for rounding.
  Sheet walk(const SurfacePoint& p, glm::dvec3 x, bool over_seams = true) const;

 private:
  uint32_t first_hit(glm::dvec3 x) const;
  // The same, exactly: of all that the ray through x meets, and of the sheets that end so near that it may have passed
  // them by, the first that covers x in double.
  uint32_t exact_first(glm::dvec3 x) const;

  // The verdict at this one hit, crossed: the silhouettes between P and x.
  Verdict verdict(const SurfacePoint& p, glm::dvec3 x, uint32_t hit,
                  const std::vector<Silhouettes::Crossing>& crossed) const;
  // Silhouettes within this distance of x may part the ray that was cast from the exact one, or from one as far away.
  double beside_m() const { return Silhouettes::reach_of(view_); }
  uint32_t next_on_sheet(uint32_t triangle, int edge, uint32_t from, glm::dvec3 x) const;
  // end: of the sheet, in the light's frame.
  uint32_t across_seam(uint32_t triangle, glm::dvec3 end, glm::dvec3 x) const;
  // Has the first-hit depth no jump between P, lit, and x? It can have one only where the way crosses a silhouette.
  Verdict continuous(const SurfacePoint& p, glm::dvec3 x, uint32_t hit,
                     const std::vector<Silhouettes::Crossing>& crossed) const;
  // Do the two first hits on either side of these crossings belong together, but for the rounding of their vertices?
  Verdict joins(uint32_t before, uint32_t after, const std::vector<Silhouettes::Crossing>& at, size_t first,
                size_t last, const auto& place) const;
  // Does a surface go on at P, lit, where P's own rounding put it beside its triangle?
  bool goes_on_at(const SurfacePoint& p) const;
  // Is this hit P's own sheet, or behind it, but for the ray's error?
  bool may_be_lit(const SurfacePoint& p, glm::dvec3 x, uint32_t hit) const;
  double length_m(const SurfacePoint& p, glm::dvec3 x) const;  // of the way, across the light's rays at P
  double rounding_of_sheet(const SurfacePoint& p, glm::dvec3 x, const Sheet& sheet, uint32_t hit) const;
  // By how much two depths that are one may differ: a ray that passes beside x by its float error may meet the sheet's
  // next triangle, whose plane differs there by the error times the slopes. Edge-on triangles have no slope to speak
  // of.
  double depth_error(uint32_t a, uint32_t b, glm::dvec3 x) const;

  const EmbreeScene& embree_;
  const Adjacency& adjacency_;
  const LightView& view_;
  const Silhouettes& silhouettes_;
};

}  // namespace noonmark
