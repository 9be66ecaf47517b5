// Whether a map is the scene's: how far its depths lie from those of an exact map, along the light.
//
//   MapDistance apart(frame, DepthFormat::d24);
//   apart.add({12, 7}, exact.at({12, 7}), stored.at({12, 7}));   // of each texel that is read
//   if (apart.excess() > 1) print("not the scene's");            // drawn with another viewport, matrix or scene
//
// Rounding, a rasteriser's grid, silhouettes, a bias in the map, even half floats move less than half of the texels by less
// than a fiftieth of the depths' spread. A map that is turned over, or that fills only a corner, is off by a tenth and more.
#pragma once
#include <vector>

#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

class MapDistance {
 public:
  MapDistance(const LightFrame& frame, DepthFormat format);  // the frame must outlive this

  // Window depths of a texel; one that is not finite is infinitely far off.
  void add(glm::ivec2 texel, float exact, float stored);

  size_t texels() const { return off_m_.size(); }
  // NaN without a texel.
  double off_m() const;     // the median distance
  double spread_m() const;  // how far apart nine tenths of the exact depths are
  // The median distance as a multiple of the most that leaves the map the scene's: a fiftieth of the spread; where the depths
  // are alike, what a step of the format and float arithmetic move.
  double excess() const;

 private:
  const LightFrame& frame_;
  DepthFormat format_;
  double rounding_m_;
  std::vector<double> exact_m_, off_m_, step_m_;
};

}  // namespace noonmark
