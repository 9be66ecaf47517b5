#include "technique/filters/patterns.h"

#include <algorithm>
#include <cmath>

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

TapPattern linear_fetches(int fetches, double sigma) {
  TapPattern pattern;
  double sum = 0;
  for (int i = 0; i < fetches; ++i) {
    const double x = i - (fetches - 1) / 2.0;
    pattern.kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    sum += pattern.kernel.back();
  }
  for (double& g : pattern.kernel) g /= sum;
  pattern.taps = (fetches + 1) * (fetches + 1);
  pattern.blended_side = fetches + 1;
  pattern.offsets = square_of_taps(fetches + 1, 1);
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
