// R0: how much of a light with a size each receiver sees.
#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/embree_scene.h"
#include "raytrace/light_cells.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

bool has_size(const Light& light);

// Samples the light, 16 rays at a time, until the standard error of each receiver's fraction is at most standard_error.
// - A sun is a disc in the plane that touches the unit sphere of directions at its middle, sampled uniformly over its
//   area. Over its solid angle a wide sun would be sampled more in the middle. A sphere is sampled uniformly over the solid angle that it fills at the receiver, a
//   disc uniformly over its area.
// - The standard error is sqrt(p (1 - p) / n) with p = (k + 1) / (n + 2), because n rays that all agree do not make the
//   result certain.
// - The part of the light below the receiver's own horizon is not seen. A receiver inside the sphere sees all of it.
// - Deterministic: the samples of a pixel depend only on its index.
// - Pixels that are not in `facing` are 0.
// - cells may be null. Where they prove that every ray would have the same verdict, no ray is cast. The result is the
//   0 or 1 that the rays would give.
Image<float> sample_light(const Scene& scene, const EmbreeScene& embree, const ReceiverImage& receivers,
                          const std::vector<uint32_t>& facing, const LightFrame& frame, const Light& light,
                          double standard_error, LightCells* cells);

}  // namespace noonmark
