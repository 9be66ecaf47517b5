// The metrics of one point: pure functions of the ladder's images. Names and meanings: compare/results/metrics.h.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/results/records.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"
#include "technique/point_maps.h"

namespace noonmark {

// A map, and how the receivers are looked up in it.
struct LookedUpMap {
  const LightFrame& frame;
  const LookupProbe& probe;
  const Bias& bias;
  const Image<float>& edge_distance_texels;  // raytrace::LookupTruth
};

struct MeasureInput {
  const Ladder& ladder;
  const ReceiverImage& receivers;
  std::vector<LookedUpMap> maps;            // one or more
  const Image<float>& occluder_distance_m;  // read only at the pixels of peter_panning_mask
  bool casters_moved = false;               // moves_casters(), technique/casters.h
  std::span<const uint32_t> surfaces = {};  // surfaces_of() (scenes/surfaces.h); empty: all receivers are of one
  const MapChoice& choice = only_map;

  const LookedUpMap& map_of(size_t i) const { return maps[choice.map_of(i)]; }
};

// The largest distance before a receiver, in metres along its light ray, at which Peter Panning can occur. It is the
// bias there, plus the largest change of the receiver's own depth within the lookup's taps. It is infinite if the casters
// are moved, because a moved occluder can be anywhere. light: P in the light's frame.
double panning_reach_m(const MeasureInput& input, size_t i, glm::dvec3 light);

// Mean |shown - R1| over the counted receivers, the metric `error`. NaN if there are none.
double error_of(const Ladder& ladder);

// Of each of ladder.causes its part in the mean |shown - R0| over the counted receivers: its step where it has the sign of the
// receiver's error, less its step where it has the other one. They sum to that mean. Below 0: it cancels more of other causes
// than it adds. NaN if there are none.
std::vector<double> parts_of_error(const Ladder& ladder);

// Every metric of the table that is about the ladder; those of the light's plane (law_metrics.h), of soundness, of the
// view, of the shaded frame and the times come from elsewhere. If a rung was put on top of R5, `error` is measured
// against that rung, and the mean step of its cause is added under the cause's name. A value in the images that is not
// finite makes every metric that reads it not finite; nothing is skipped. Without a counted receiver every fraction,
// gap and displacement is NaN.
std::map<std::string, double> measure_ladder(const MeasureInput& input);

// The counted pixels that have Peter Panning and whose own truth is dark. measure_ladder() needs the distance of their
// occluders.
Image<uint8_t> peter_panning_mask(const Ladder& ladder);

// The counted receiver with the largest error: |R5 - R1|, or that of the rung on top of R5. x = -1 if there is no counted receiver.
PointRecord::Worst worst_pixel(const Ladder& ladder);

// The worst pixel of each metric of measure_ladder() that is a mean or a maximum over the counted pixels and is above 0;
// of several the first from the top. `error` and `wrong` have worst_pixel().
std::vector<PointRecord::WorstOf> worst_pixels(const MeasureInput& in);

}  // namespace noonmark
