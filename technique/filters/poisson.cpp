#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "technique/filters/patterns.h"

namespace noonmark {
namespace {

// 16 points of the unit disk. Each is the candidate, out of many, that is furthest from the points before it (Mitchell
// 1991). The C++ standard defines the generator's bits, so every platform has the same points.
const std::array<glm::dvec2, 16>& poisson_disk() {
  static const std::array<glm::dvec2, 16> disk = [] {
    std::array<glm::dvec2, 16> points;
    std::mt19937 bits(1991);
    const auto in_square = [&] { return 2.0 * static_cast<double>(bits()) * 0x1p-32 - 1; };
    for (size_t n = 0; n < points.size(); ++n) {
      double best = -1;
      for (int candidate = 0; candidate < 1000;) {
        const double x = in_square(), y = in_square();
        if (x * x + y * y > 1) continue;
        ++candidate;
        double nearest = 4;
        for (size_t i = 0; i < n; ++i) nearest = std::min(nearest, glm::length(points[i] - glm::dvec2(x, y)));
        if (nearest > best) {
          best = nearest;
          points[n] = {x, y};
        }
      }
    }
    return points;
  }();
  return disk;
}

}  // namespace

TapPattern poisson_taps(const FilterSettings& f) {
  TapPattern pattern;
  pattern.taps = 16;
  pattern.variants = rotations(f, pattern.taps);
  for (int v = 0; v < pattern.variants; ++v) {
    const double angle = 2 * std::numbers::pi * v / pattern.variants;
    const double c = std::cos(angle) * f["radius_texels"], s = std::sin(angle) * f["radius_texels"];
    for (glm::dvec2 p : poisson_disk()) pattern.offsets.emplace_back(c * p.x - s * p.y, s * p.x + c * p.y, 0);
  }
  return pattern;
}

}  // namespace noonmark
