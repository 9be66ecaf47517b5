// Where the drawn shadow edges lie beside the true ones, in pixels of the picture.
//
// The truth is R1, and the drawn visibility is R1 with the steps that move edges: filter, displacement and aliasing. Acne
// and Peter Panning are no part of it, because such a patch has no true edge beside which it could lie. A receiver is on
// the lit side if its visibility is at least one half, so a soft edge lies where it crosses one half.
//
// An edge pixel is a receiver that has a neighbour (above, below, left or right) on the same surface, and one of both is lit
// and the other one is not. Its displacement is the distance to the nearest edge pixel of the truth that is lit as it is (or dark as it is) and on the same surface.
// The true edge can be hidden where the visible part of a surface ends: at an outline, at the picture's border, and where
// the surface turns away from the light. If such an end is nearer, the displacement is the distance to it, so it is never
// more than the edge has moved.
#pragma once
#include <cstdint>
#include <span>

#include "base/image.h"
#include "compare/ladder/ladder.h"
#include "scenes/receivers.h"

namespace noonmark {

struct EdgeDisplacements {
  double largest = 0, mean = 0, p95 = 0;  // pixels, over the drawn edge pixels that are counted; 0 if there are none
};

// surfaces: of each triangle, surfaces_of() (scenes/surfaces.h); empty: all receivers are of one. p95 is the least
// displacement that 95% of the edge pixels do not exceed. All are NaN if the visibility of a counted receiver is NaN.
EdgeDisplacements edge_displacements(const Ladder& ladder, const ReceiverImage& receivers,
                                     std::span<const uint32_t> surfaces);

// For every pixel, the distance to the nearest pixel whose mask is not 0; infinity if the mask is 0 everywhere. Method:
// Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled functions". Float is precise enough for distances
// in a picture, and squares of whole pixels up to 4096 are exact.
Image<float> distance_to(const Image<uint8_t>& mask);

}  // namespace noonmark
