// Law 1: the least bias, in window depth, at which a plane is free of acne. The map holds the plane's depth at the
// centres of texels, the lookup compares it with the depth at P, and a texel's centre lies up to half a texel beside
// the exact place of its tap.
//
//   AcneLaw law(frame, probe);
//   double depth = law.at(i, P, N);                       // what receiver i needs, whatever the grid's alignment
//
// Flat maps. The window depth of a plane is affine in texels (spot: 1/z is, and window depth is affine in 1/z), so with
// o the tap furthest up the plane towards the light the least bias is exactly -o.(dd/di, dd/dj) + (|dd/di| + |dd/dj|) /
// 2 as the supremum over alignments; for the square of a box or of linear taps that is k (|dd/di| + |dd/dj|) with k =
// TapPattern::reach_texels(). There
//   directional  dd/di = -w (n.right / n.forward) / (far - near)
//   spot         dd/di = -far near / (far - near) * (n.right / n.P) * 2 tan(fov/2) / resolution
// where n is the plane's normal and P a point of it in the light's axes. Where the reference is the plane's depth at
// each tap's exact place, k = 1/2 whatever the pattern's reach, and what a cap (bias.plane_cap) keeps the reference
// from following comes on top; at the centre of its texel, 0.
//
// Cube maps of distances. With h = n.P the plane lies at the distance t(c) = h |c| / (n.c) along a direction c, which
// is affine in nothing; but its sets {t <= level} are cones around n, so convex on a face. The least bias is
//   max over taps of |P| - min t(c) over the square of half a texel around the tap's exact place in its face,
// and that minimum is at n itself, where it is in the square, else on a side, where dt = 0 is linear, or in a corner:
// all are tried, so the formula has no error but double's own. It is the supremum over where texels' centres may lie;
// one grid has them in fewer places.
#pragma once
#include <glm/glm.hpp>

#include "technique/evidence.h"
#include "technique/light_frame.h"

namespace noonmark {

// The window depth's change per texel of a flat map, over a plane through P with this normal; world coordinates.
glm::dvec2 depth_gradient(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal);

class AcneLaw {
 public:
  AcneLaw(const LightFrame& frame, const LookupProbe& probe);

  // Of receiver i. Rounding and the format's quantum come on top.
  double at(size_t i, glm::dvec3 position, glm::dvec3 normal) const;

  // What no receiver on this triangle, turned to the light, can exceed. Flat maps: what each needs, for that is one
  // number. Cube maps: an upper bound, at the corner farthest from the light, of a direction turned towards n by the
  // angles of the pattern's longest offset and of half a texel's diagonal in the middle of a face.
  double of_face(const glm::dvec3 (&corners)[3], glm::dvec3 normal) const;

 private:
  double cube_need(size_t i, glm::dvec3 position, glm::dvec3 normal) const;

  const LightFrame& frame_;
  const LookupProbe& probe_;
  double reach_texels_;          // flat maps: k; NaN where the taps are no square
  double longest_offset_m_ = 0;  // cube maps
};

}  // namespace noonmark
