// FLIP: how different two pictures look to a person who sees them in turn at the same place. 0: alike; 1: the largest
// difference.
//
//   double difference = flip(truth, drawn).mean;
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020. Both pictures are blurred as the eye does at that distance, and compared in a colour space in which
// equal steps look equal; the difference counts more where an edge or a point of one picture is not in the other.
#pragma once
#include <glm/glm.hpp>

#include "base/image.h"

namespace noonmark {

struct Flip {
  double mean = 0;       // over all pixels; NaN without a pixel
  Image<float> error{};  // of each pixel, from 0 to 1
};

// The viewing conditions of the paper: a screen of 3840 pixels and 0.7 m width, seen from a distance of 0.7 m.
inline constexpr double flip_pixels_per_degree = 3840 * 3.14159265358979323846 / 180;

// How far from its pixel a filter reads, in pixels along a row or a column. A pixel's error depends on no others.
int flip_reach(double pixels_per_degree = flip_pixels_per_degree);

// The pictures are 8-bit sRGB, as they are shown. Throws std::logic_error if their sizes differ. Costs nothing where the
// pictures are equal.
Flip flip(const Image<glm::u8vec3>& reference, const Image<glm::u8vec3>& test,
          double pixels_per_degree = flip_pixels_per_degree);

}  // namespace noonmark
