// For the files beside this one: what several patterns of taps are made of.
#pragma once
#include "technique/tap_pattern.h"

namespace noonmark {

// side x side places around the middle, rows from the lowest v, as the shader's loops run. With a float's step the
// offsets are the shader's own products.
std::vector<glm::vec3> square_of_taps(int side, float step_texels);

// `fetches` x `fetches` linear fetches a texel apart; weights by exp(-x^2 / (2 sigma^2)) of a fetch's distance.
TapPattern linear_fetches(int fetches, double sigma_texels);

// Taps that a sampler blends by weights of their own along each axis: of size + 1 texels, by <name>_weight of the
// filter's formula.
TapPattern weighted_texels(int size, double (*weight)(int texel, double s, int size));

}  // namespace noonmark
