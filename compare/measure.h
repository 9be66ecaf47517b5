// The metrics of one point: pure functions of the ladder's images. Names and meanings: compare/metrics.h.
#pragma once
#include <map>
#include <string>

#include "compare/ladder.h"
#include "compare/records.h"

namespace noonmark {

struct MeasureInput {
  const Ladder& ladder;
  const Image<uint32_t>& primitive;         // ReceiverImage::primitive
  const Image<float>& edge_distance_m;      // raytrace::LookupTruth
  const Image<float>& occluder_distance_m;  // of the pixels in peter_panning_mask; others are not read
  const Image<float>& n_dot_l;
  double texel_m = 1;
  double m_per_depth = 1;  // far - near
  DepthBias bias{};
  int kernel = 1;  // taps on a side
};

// Every metric of the table but the times and those of compare/law_metrics.h. A value that is not finite in the images
// makes the metrics that it enters not finite; nothing is skipped. Without a counted receiver every fraction, gap and
// displacement is NaN.
std::map<std::string, double> measure_ladder(const MeasureInput& input);

// The counted pixels with any Peter Panning whose own truth is dark: those whose occluder's distance measure_ladder()
// needs.
Image<uint8_t> peter_panning_mask(const Ladder& ladder);

// The counted receiver with the largest |R5 - R1|; x = -1 where there is none.
PointRecord::Worst worst_pixel(const Ladder& ladder);

}  // namespace noonmark
