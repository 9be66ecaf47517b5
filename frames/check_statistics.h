// The numbers that the checks of a frame read (frames/checks.h): coverage, and values by region.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"
#include "frames/alignment.h"
#include "frames/checks.h"
#include "frames/frame.h"
#include "frames/value_curve.h"
#include "raytrace/tracer.h"

namespace noonmark {

// 1 where there is a surface.
using Coverage = Image<uint8_t>;
Coverage coverage_of_visibility(const GivenFrame& frame);
Coverage coverage_of_positions(const GivenFrame& frame);  // of a frame that has some
Coverage coverage_of_frame(const GivenFrame& frame);      // where both have one
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

// What shading leaves in the values deep in true light, of the whole picture or part by part (each triangle where the scene has
// no parts).
struct Shading {
  // The share of the pixels that are as bright as a function of N.L says, where hardly a pixel is brighter. As many values of N.L
  // as the function has numbers can be met by choice; it must say the others, too. What a filter's taps make tells nothing. 0
  // without such a function.
  double explained = 0;
  bool is_one_value = false;  // nearly all have one value, between 0 and 1, which is no share of a filter's taps
};

// deep: R1 is the same at all pixels within `deep_px` of the pixel, and all of them are counted.
struct FrameStatistics {
  // 6 pixels of a picture with 360 rows or more, fewer of a smaller one, in which a filter is as much narrower.
  static constexpr int deep_px(int height) { return height >= 360 ? 6 : height >= 120 ? height / 60 : 2; }
  // How far a map of coarse texels may put a shadow beside its place: a texel of one with 16 texels over the picture's height.
  static constexpr int displaced_px(int height) { return height / 16; }
  Image<uint8_t> deep;  // 1: deep in true shadow, 2: deep in true light, 0: neither
  Region deep_lit, deep_dark;
  CurveEvidence curve;
  Shading shading;  // of the values deep in true light
  // Pixels deep in true light, with no true shadow within `displaced_px`, about which the frame is darker than one half at all
  // pixels within `deep_px`: the inside of a shadow that is not the truth's.
  size_t shadow_elsewhere = 0;
  OutlineAlignment outlines;
};
FrameStatistics frame_statistics(const CheckEvidence& evidence);

// The way along `direction` from p to the plane of a triangle, in lengths of it; not finite where it grazes the plane.
double way_to_plane(const Scene& scene, uint32_t triangle, glm::dvec3 p, glm::dvec3 direction);

// The value below which this share of the values lies; NaN of none.
double quantile(std::vector<double> values, double share);

// Whether the value is a half float (IEEE 754 binary16), subnormals included.
bool is_half(double value);

}  // namespace noonmark
