#include "technique/filters/patterns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noonmark {

std::vector<glm::vec3> square_of_taps(int side, float step) {
  std::vector<glm::vec3> offsets;
  const float middle = static_cast<float>(side - 1) / 2;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      offsets.emplace_back((static_cast<float>(x) - middle) * step, (static_cast<float>(y) - middle) * step, 0);
  return offsets;
}

int rotations(const FilterSettings& settings, int taps) {
  return settings["rotate"] != 0 ? std::min(64, most_listed_taps / taps) : 1;
}

std::vector<double> equal_weights(int size) { return std::vector<double>(static_cast<size_t>(size), 1.0 / size); }

std::vector<double> gaussian_weights(int size, double sigma) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = 0; i < size; ++i) {
    const double x = i - (size - 1) / 2.0;
    weights.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    sum += weights.back();
  }
  for (double& g : weights) g /= sum;
  return weights;
}

TapPattern fetches_of(std::vector<double> kernel, int block) {
  TapPattern pattern;
  pattern.block = block;
  pattern.blended_side = block * (static_cast<int>(kernel.size()) + 1);
  pattern.kernel = std::move(kernel);
  pattern.taps = pattern.blended_side * pattern.blended_side;
  pattern.offsets = square_of_taps(pattern.blended_side, 1);
  return pattern;
}

TapPattern weighted_texels(int size, double (*weight)(int texel, double s, int size)) {
  TapPattern pattern;
  pattern.blended_side = size + 1;
  pattern.axis_weight = weight;
  pattern.taps = pattern.blended_side * pattern.blended_side;
  pattern.offsets = square_of_taps(pattern.blended_side, 1);
  return pattern;
}

}  // namespace noonmark
