// Random distributions of depth under a kernel, for the tests of filtered maps.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace noonmark {

struct DepthsAndReceiver {
  std::vector<double> depths, weights;
  double receiver = 0;
};

// Two to nine depths in [0, 1], each a float as in a map, in clusters with gaps of 1e-7 and more. The receiver is at one of
// them, 1e-7 or more before or behind it, or anywhere.
inline DepthsAndReceiver random_depths(std::mt19937_64& random) {
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto near = [&](double depth) {
    const double gap = std::pow(10, within(-7, 0));
    return static_cast<double>(static_cast<float>(std::clamp(depth + (random() % 2 ? gap : -gap), 0.0, 1.0)));
  };
  DepthsAndReceiver made;
  const size_t count = 2 + random() % 8;
  made.depths.push_back(static_cast<double>(static_cast<float>(within(0, 1))));
  while (made.depths.size() < count) made.depths.push_back(near(made.depths[random() % made.depths.size()]));
  for (size_t i = 0; i < count; ++i) made.weights.push_back(-std::log(within(1e-9, 1)));
  const double at = made.depths[random() % count];
  const auto kind = random() % 3;
  made.receiver = kind == 0 ? at : kind == 1 ? near(at) : static_cast<double>(static_cast<float>(within(0, 1)));
  return made;
}

}  // namespace noonmark
