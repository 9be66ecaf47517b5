// Building blocks of the tap patterns, for the files in this folder.
#pragma once
#include "technique/tap_pattern.h"

namespace noonmark {

// side x side offsets around the middle. The rows begin at the lowest v, in the order of the shader's loops. The step
// is a float, so that the offsets are bit for bit the shader's own products.
std::vector<glm::vec3> square_of_taps(int side, float step_texels);

// The rotations of a pattern of so many taps: 64, or as many as the shader's table can hold. One if filter.rotate is off.
int rotations(const FilterSettings& settings, int taps);

// Of a blur of `size` texels: equal weights, or those of a Gaussian.
std::vector<double> equal_weights(int size);
std::vector<double> gaussian_weights(int size, double sigma_texels);

// A square of linear fetches with these weights along each axis. They stand one texel apart. The texels are those of a mip
// level: each is the mean of block x block texels of the map. With block 1 they are the map's own.
TapPattern fetches_of(std::vector<double> kernel, int block = 1);

// Taps that a sampler blends with weights along each axis, over size + 1 texels. `weight` is the function <name>_weight
// of the filter's formula.
TapPattern weighted_texels(int size, double (*weight)(int texel, double s, int size));

}  // namespace noonmark
