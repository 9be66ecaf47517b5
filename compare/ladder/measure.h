// The metrics of one point: pure functions of the ladder's images. Names and meanings: compare/store/metrics.h.
#pragma once
#include <map>
#include <string>

#include "compare/ladder/ladder.h"
#include "compare/store/records.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

struct MeasureInput {
  const Ladder& ladder;
  const ReceiverImage& receivers;
  const LightFrame& frame;
  const LookupProbe& probe;
  const Bias& bias;
  const Image<float>& edge_distance_texels;  // raytrace::LookupTruth
  const Image<float>& occluder_distance_m;   // of the pixels in peter_panning_mask; others are not read
};

// How far before a receiver, in metres along its light ray, Peter Panning can reach: the bias there, plus the most that
// the receiver's own depth changes within the lookup's taps. Of a part that moves the caster, infinity.
// light: P in the light's frame.
double panning_reach_m(const MeasureInput& input, size_t i, glm::dvec3 light);

// Every metric of the table but the times and those of compare/ladder/law_metrics.h; of a rung that was put on top of
// R5, the mean step of its cause by the cause's name, and `error` is against that rung. A value that is not finite in
// the images makes the metrics that it enters not finite; nothing is skipped. Without a counted receiver every
// fraction, gap and displacement is NaN.
std::map<std::string, double> measure_ladder(const MeasureInput& input);

// The counted pixels with any Peter Panning whose own truth is dark: those whose occluder's distance measure_ladder()
// needs.
Image<uint8_t> peter_panning_mask(const Ladder& ladder);

// The counted receiver with the largest |R5 - R1|; x = -1 where there is none.
PointRecord::Worst worst_pixel(const Ladder& ladder);

}  // namespace noonmark
