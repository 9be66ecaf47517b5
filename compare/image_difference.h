// By how much two pictures of one scene differ: to a formula, and to an eye. Pictures are grey, in linear light where 1
// is white; they have one size. A value that is not finite makes the result so.
//
//   double rms = root_mean_square_difference(truth, map);
//   Image<float> seen = flip_difference(truth, map);   // 0: no eye tells them apart; 1: as different as can be
//   double mean = mean_of(seen);
#pragma once
#include "scenes/image.h"

namespace noonmark {

// sqrt(mean((a - b)^2)) over all pixels; 0 of pictures without any.
double root_mean_square_difference(const Image<float>& a, const Image<float>& b);

double mean_of(const Image<float>& image);  // 0 without pixels

// A display 0.7 m away, 0.7 m wide, of 3840 pixels: FLIP's own default.
inline constexpr double flip_pixels_per_degree = 67.0;

// LDR-FLIP (Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020) of grey pictures: what a person sees flicker when the two are shown in turn, for each
// pixel. Values are clamped to [0,1] first, as a display does. A grey has no chroma, so the paper's two chromatic
// filters, and the Hunt adjustment but in the scale's upper end, have nothing to do.
Image<float> flip_difference(const Image<float>& reference, const Image<float>& test,
                             double pixels_per_degree = flip_pixels_per_degree);

}  // namespace noonmark
