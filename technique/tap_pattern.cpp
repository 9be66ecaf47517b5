#include "technique/tap_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace noonmark {
namespace {

// Rows from the lowest v, as the shader's loops run. With a float's step the offsets are the shader's own products.
std::vector<glm::vec3> square(int side, float step) {
  std::vector<glm::vec3> offsets;
  const float middle = static_cast<float>(side - 1) / 2;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      offsets.emplace_back((static_cast<float>(x) - middle) * step, (static_cast<float>(y) - middle) * step, 0);
  return offsets;
}

// 16 points of the unit disk, each the best of many candidates: the one furthest from those before it (Mitchell 1991).
// The generator's bits are the standard's, so every platform has the same points.
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

TapPattern poisson(double radius, bool rotate) {
  TapPattern pattern;
  pattern.taps = 16;
  pattern.variants = rotate ? 64 : 1;
  for (int v = 0; v < pattern.variants; ++v) {
    const double angle = 2 * std::numbers::pi * v / pattern.variants;
    const double c = std::cos(angle) * radius, s = std::sin(angle) * radius;
    for (glm::dvec2 p : poisson_disk()) pattern.offsets.emplace_back(c * p.x - s * p.y, s * p.x + c * p.y, 0);
  }
  return pattern;
}

TapPattern bilinear(int fetches, double sigma) {
  TapPattern pattern;
  double sum = 0;
  for (int i = 0; i < fetches; ++i) {
    const double x = i - (fetches - 1) / 2.0;
    pattern.kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    sum += pattern.kernel.back();
  }
  for (double& g : pattern.kernel) g /= sum;
  pattern.taps = (fetches + 1) * (fetches + 1);
  pattern.offsets = square(fetches + 1, 1);
  return pattern;
}

// The tutorials' loops from -offset up to, but without, +offset: a grid that is not centred on the receiver.
TapPattern cube_grid(double offset_m) {
  TapPattern pattern;
  pattern.taps = 64;
  pattern.in_world = true;
  const auto at = [&](int i) { return offset_m * (i - 2) / 2.0; };
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) pattern.offsets.emplace_back(at(x), at(y), at(z));
  return pattern;
}

// The corners of a cube and the middles of its edges, of lengths sqrt(3) and sqrt(2).
TapPattern cube_disk(DiskRadius radius, double radius_m) {
  TapPattern pattern;
  pattern.in_world = true;
  pattern.scaled_by_view = radius == DiskRadius::view_distance;
  const double scale = pattern.scaled_by_view ? 1 : radius_m;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) >= 2) pattern.offsets.emplace_back(scale * x, scale * y, scale * z);
  pattern.taps = static_cast<int>(pattern.offsets.size());
  return pattern;
}

}  // namespace

double TapPattern::weight(int tap, glm::dvec2 fraction) const {
  if (!bilinear()) return 1.0 / taps;
  const int fetches = static_cast<int>(kernel.size()), side = fetches + 1;
  const auto along = [&](int i, double f) {
    return (i < fetches ? kernel[static_cast<size_t>(i)] * (1 - f) : 0) +
           (i > 0 ? kernel[static_cast<size_t>(i) - 1] * f : 0);
  };
  return along(tap % side, fraction.x) * along(tap / side, fraction.y);
}

double TapPattern::reach_texels() const {
  float reach = 0;
  for (const glm::vec3& o : offsets) reach = std::max({reach, std::abs(o.x), std::abs(o.y)});
  return static_cast<double>(reach) + 0.5;
}

uint32_t hash_pixel(uint32_t x) {
  // A 32-bit integer hash (Wellons' lowbias32 constants).
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

TapPattern tap_pattern(const FilterSettings& f) {
  switch (f.kind) {
    case FilterKind::none: {
      TapPattern pattern;
      pattern.offsets = {glm::vec3(0)};
      return pattern;
    }
    case FilterKind::box: {
      TapPattern pattern;
      pattern.taps = f.size * f.size;
      pattern.offsets = square(f.size, static_cast<float>(f.step_texels));
      return pattern;
    }
    case FilterKind::hardware:
      return bilinear(1, 1);
    case FilterKind::gaussian:
      return bilinear(f.size, f.sigma_texels);
    case FilterKind::poisson:
      return poisson(f.radius_texels, f.rotate);
    case FilterKind::cube_grid:
      return cube_grid(f.offset_m);
    case FilterKind::cube_disk:
      return cube_disk(f.disk, f.radius_m);
  }
  throw std::logic_error("a filter without a pattern of taps");
}

}  // namespace noonmark
