// Law 1: the least bias, in window depth, at which a plane is free of acne. The map holds the plane's depth at texel
// centres, and the lookup compares it with the depth at P. The centre of a texel lies up to half a texel away from the
// exact place of its tap.
//
//   AcneLaw law(frame, probe);
//   double depth = law.at(i, P, N);                       // what receiver i needs, for any alignment of the grid
//
// Flat maps. The window depth of a plane is affine in texels (under a spot light 1/z is affine, and window depth is
// affine in 1/z). Let o be the offset of the tap that lies furthest up the plane towards the light. The least bias is
// exactly
//   -o.(dd/di, dd/dj) + (|dd/di| + |dd/dj|) / 2
// as the supremum over all alignments of the grid. For the square of a box or of linear taps this is k (|dd/di| +
// |dd/dj|) with k = TapPattern::reach_texels(). The gradient is
//   directional  dd/di = -w (n.right / n.forward) / (far - near)
//   spot         dd/di = -far near / (far - near) * (n.right / n.P) * 2 tan(fov/2) / resolution
// where n is the plane's normal and P a point of it, in the light's axes. If the reference is the plane's depth at each
// tap's exact place, k = 1/2 for any reach of the pattern. A cap (bias.plane_cap) limits how far the reference follows
// the plane; the part beyond the cap is added. If the reference is the plane's depth at the texel's centre, the least
// bias is 0.
//
// Cube maps of distances. With h = n.P the plane lies at the distance t(c) = h |c| / (n.c) along a direction c. This is
// not an affine function. But the sets {t <= level} are cones around n, so they are convex on a face. The least bias is
//   max over taps of |P| - min t(c) over the square of half a texel around the tap's exact place in its face.
// If n lies in the square, the minimum is at n. Otherwise it is on a side, where dt = 0 is linear, or in a corner. All
// of these are tried, so the formula has no error except the rounding of double. It is the supremum over all possible
// places of texel centres; one grid has its centres at fewer places.
#pragma once
#include <glm/glm.hpp>

#include "technique/evidence.h"
#include "technique/light_frame.h"

namespace noonmark {

// The change of window depth per texel of a flat map, over a plane through P with this normal, in world coordinates.
glm::dvec2 depth_gradient(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal);

class AcneLaw {
 public:
  AcneLaw(const LightFrame& frame, const LookupProbe& probe);

  // The bias that receiver i needs. Rounding and the format's quantum have to be added.
  double at(size_t i, glm::dvec3 position, glm::dvec3 normal) const;

  // A bias that no receiver on this triangle (with its face towards the light) can exceed. Flat maps: the bias of each
  // receiver, because it is the same for all. Cube maps: an upper bound. It is taken at the corner farthest from the
  // light, for a direction turned towards n by two angles: that of the pattern's longest offset, and that of half a
  // texel's diagonal in the middle of a face.
  double of_face(const glm::dvec3 (&corners)[3], glm::dvec3 normal) const;

 private:
  double cube_need(size_t i, glm::dvec3 position, glm::dvec3 normal) const;

  const LightFrame& frame_;
  const LookupProbe& probe_;
  double reach_texels_;          // flat maps: k; NaN if the taps do not form a square
  double longest_offset_m_ = 0;  // cube maps
};

}  // namespace noonmark
