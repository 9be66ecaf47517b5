// How large a texel of the shadow map is in the picture, before any shadow edge is drawn: Lloyd, Tuft, Yoon, Manocha, "Warping and
// Partitioning for Low Error Shadow Maps", EGSR 2006, section 3. Their error m of a receiver is the width of a texel over that of a
// pixel: above 1 a stair of texels shows. It is the product of two factors. The first, perspective aliasing, holds for a surface
// that faces light and eye alike: the map spends its texels where the camera is far. The second comes from the slopes of the surface.
//
//   const TexelFootprint footprint = texel_footprint(receivers, camera, frame, facing);
//   footprint.pixels[i];       // m, in the direction in which the texel is longest in the picture
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "base/image.h"
#include "scenes/camera_frame.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"
#include "technique/point_maps.h"

namespace noonmark {

// Of the receivers that face the light; NaN elsewhere. Infinite where the light or the eye looks along the surface.
struct TexelFootprint {
  Image<float> pixels;       // the longest side of a texel on the surface, in pixels of the picture
  Image<float> perspective;  // w over the width of a pixel there, both across their rays
};
TexelFootprint texel_footprint(const ReceiverImage& receivers, const CameraFrame& camera, const LightFrame& frame,
                               const Image<uint8_t>& facing);
// The same of all maps of a point.
TexelFootprint texel_footprint(const ReceiverImage& receivers, const CameraFrame& camera,
                               std::span<const LightFrame* const> frames, const MapChoice& choice,
                               const Image<uint8_t>& facing);

// undersampled, perspective_aliasing, perspective_aliasing_p95 (compare/results/metrics.cpp); NaN if nothing faces the light.
std::map<std::string, double> footprint_metrics(const TexelFootprint& footprint);

}  // namespace noonmark
