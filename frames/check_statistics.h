// The numbers that the checks of a frame read (frames/checks.h): coverage, and values by region.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"
#include "frames/frame.h"
#include "raytrace/tracer.h"
#include "technique/evidence.h"

namespace noonmark {

// 1 where there is a surface.
using Coverage = Image<uint8_t>;
Coverage coverage_of_frame(const GivenFrame& frame);
Coverage coverage_of(const Image<uint32_t>& seen);
Coverage flipped(const Coverage& coverage, bool left_to_right, bool upside_down);
size_t differing(const Coverage& a, const Coverage& b);
// Pixels where the scene has a surface and the frame has none.
size_t lost_surfaces(const Coverage& frame, const Coverage& scene);
// Pixels one of whose four neighbours differs from them.
size_t outline_pixels(const Coverage& coverage);

// The shift of the samples, of up to one pixel in steps of a half, with which the scene's coverage is most like the frame's.
struct Shift {
  glm::dvec2 pixels{0};  // x to the right, y down: where the frame's samples lie, seen from the pixels' centres
  size_t differing = 0;  // pixels that differ after the shift
};
Shift best_shift(const raytrace::Tracer& tracer, const ViewMatrix& view, const Coverage& frame, const Coverage& scene);

// Values in a region of the picture.
struct Region {
  size_t count = 0;
  double median = 0, low = 0, high = 0, mean = 0;  // low, high: the 5th and the 95th percentile. NaN without a pixel
};

// deep: R1 is the same at all counted pixels within `deep_px` of the pixel, and all of them are counted. filtered: the pixel
// is beside a true edge, and the frame goes over it from 0 to 1: both truths and both values are within `edge_px`. Only
// values between `between_low` and `between_high`.
struct FrameStatistics {
  static constexpr int deep_px = 6, edge_px = 4;
  static constexpr float between_low = 0.1f, between_high = 0.9f;
  Region deep_lit, deep_dark, filtered;
  // Deep in true light: the mean step from a pixel to its neighbour over the standard deviation of the values, 0 if all are
  // equal. Shading is smooth, acne is rough.
  double deep_lit_roughness = 0;
  // The share of the values deep in true light that are between.
  double deep_lit_between = 0;
};
FrameStatistics frame_statistics(const GivenFrame& frame, const ReceiverTruth& truth, const Image<uint8_t>& counted);

// The value below which this share of the values lies; NaN of none.
double quantile(std::vector<double> values, double share);

// Whether the value is a half float (IEEE 754 binary16), subnormals included.
bool is_half(double value);

}  // namespace noonmark
