// The offset that lies in the depths of a handed map: how its texels differ from an exact map's, as a polygon offset does.
//
//   const MapOffset found = map_offset(given, exact, format);
//   if (found.in_map()) fmt::print("factor {}", found.factor);
//
// A polygon offset moves a triangle's window depth by factor * m + units * r. m is the steepest slope of its plane in depth
// per texel, and r a step of the map's format. So the differences of a map from an exact one are a line over m: the factor is
// its slope, the units are its height at m = 0. A bias along the light that the casters' shader adds is such a height too.
#pragma once
#include <cstddef>

#include "base/image.h"
#include "technique/map_depths.h"
#include "technique/settings.h"

namespace noonmark {

struct MapOffset {
  double factor = 0;                      // beside what the exact map has already
  double constant = 0;                    // window depth
  DepthFormat format = DepthFormat::d24;  // whose units the constant is in
  size_t texels = 0;                      // that the line was fitted to
  double unsure = 0;                      // window depth: how far what moves each surface by itself can move `constant`
  // Whether the offset is more than what rounding and a rasteriser's grid do to a map without one.
  bool in_map() const;
};

// Of the texels of `exact` where the given map has the slope of one plane. The line of the least sum of absolute differences,
// each as a share of what rounding and a rasteriser's grid can move that texel, so that silhouettes and other surfaces do not
// bend it. Without enough of such texels: no offset.
MapOffset map_offset(const Image<float>& given, const MapDepths& exact, DepthFormat format);

}  // namespace noonmark
