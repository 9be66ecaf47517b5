// R0: how much of a sun's disc each receiver sees.
#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/embree_scene.h"
#include "scenes/light_frame.h"
#include "scenes/receivers.h"

namespace noonmark {

// Samples the disc, 16 rays at a time, until the standard error of each receiver's fraction is at most standard_error.
// The error is judged as sqrt(p (1 - p) / n) with p = (k + 1) / (n + 2), so that n rays that all agree are not taken
// for certainty. What of the disc lies below the receiver's own horizon is not seen. Deterministic: the samples of a
// pixel depend on its index alone. Pixels not in `facing`: 0.
Image<float> sample_sun(const Scene& scene, const EmbreeScene& embree, const ReceiverImage& receivers,
                        const std::vector<uint32_t>& facing, const LightFrame& frame, double angular_diameter_deg,
                        double standard_error, uint64_t& rays);

}  // namespace noonmark
