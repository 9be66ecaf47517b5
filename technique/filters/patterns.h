// Building blocks of the tap patterns, for the files in this folder.
#pragma once
#include "technique/tap_pattern.h"

namespace noonmark {

// side x side offsets around the middle. The rows begin at the lowest v, in the order of the shader's loops. The step
// is a float, so that the offsets are bit for bit the shader's own products.
std::vector<glm::vec3> square_of_taps(int side, float step_texels);

// The rotations of a pattern of so many taps: 64, or as many as the shader's table can hold. One if filter.rotate is off.
int rotations(const FilterSettings& settings, int taps);

// `fetches` x `fetches` linear fetches with a spacing of one texel. The weight of a fetch at the distance x is exp(-x^2
// / (2 sigma^2)).
TapPattern linear_fetches(int fetches, double sigma_texels);

// Taps that a sampler blends with weights along each axis, over size + 1 texels. `weight` is the function <name>_weight
// of the filter's formula.
TapPattern weighted_texels(int size, double (*weight)(int texel, double s, int size));

}  // namespace noonmark
