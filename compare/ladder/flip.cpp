#include "compare/ladder/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "base/srgb.h"

namespace noonmark {
namespace {

constexpr double pi = std::numbers::pi;

// Names of constants and their values are the paper's.
constexpr double q_color = 0.7, q_feature = 0.5, p_color = 0.4, p_target = 0.95;
constexpr double feature_width_deg = 0.082;  // of the detector of edges and points

// sRGB's primaries and its white, D65.
const glm::dmat3& xyz_of_rgb() {
  static const glm::dmat3 m = glm::transpose(glm::dmat3(
      10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794, 2613072.0 / 12288897, 8788810.0 / 12288897,
      887015.0 / 12288897, 1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));
  return m;
}
const glm::dvec3& white_xyz() {
  static const glm::dvec3 white = xyz_of_rgb() * glm::dvec3(1);
  return white;
}

// YCxCz, a linear form of CIELAB in which the eye's blur is applied (section 4.1.1).
glm::dvec3 ycxcz_of_rgb(glm::dvec3 linear) {
  const glm::dvec3 relative = xyz_of_rgb() * linear / white_xyz();
  return {116 * relative.y - 16, 500 * (relative.x - relative.y), 200 * (relative.y - relative.z)};
}
glm::dvec3 rgb_of_ycxcz(glm::dvec3 c) {
  static const glm::dmat3 rgb_of_xyz = glm::inverse(xyz_of_rgb());
  const double y = (c.x + 16) / 116;
  return rgb_of_xyz * (glm::dvec3(y + c.y / 500, y, y - c.z / 200) * white_xyz());
}

// CIELAB whose chroma is less in the dark (Hunt 1952).
glm::dvec3 hunt_lab(glm::dvec3 linear) {
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const glm::dvec3 relative = xyz_of_rgb() * linear / white_xyz();
  const double fx = f(relative.x), fy = f(relative.y), fz = f(relative.z);
  const double lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

// HyAB (Abasi, Amani Tehran, Fairchild 2020), compressed.
double color_distance(glm::dvec3 a, glm::dvec3 b) {
  return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), q_color);
}

// Section 4.1.3: distances up to p_color of the largest one get the range up to p_target. The largest is that of green
// and blue.
double redistributed(double distance) {
  static const double largest = color_distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
  const double middle = p_color * largest;
  return distance < middle ? distance * p_target / middle
                           : p_target + (distance - middle) / (largest - middle) * (1 - p_target);
}

// One factor of a separable filter: weight(i), i from -radius to radius.
struct Taps {
  std::vector<double> weights;
  int radius() const { return static_cast<int>(weights.size() / 2); }
};

template <class Weight>
Taps taps_of(int radius, const Weight& weight) {
  Taps taps;
  for (int i = -radius; i <= radius; ++i) taps.weights.push_back(weight(i));
  return taps;
}

// The eye's contrast sensitivity (table 1): of each channel a sum of Gaussians a sqrt(pi/b) exp(-pi^2 r^2 / b), r in
// degrees. Y and Cx have one, Cz two. The weights of a channel sum to 1.
struct Blur {
  int radius;
  Taps y, cx, cz_narrow, cz_wide;

  explicit Blur(double pixels_per_degree) {
    constexpr double widest = 0.04;
    radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    const auto gaussian = [&](double b) {
      return [=](int i) {
        const double r = i / pixels_per_degree;
        return std::exp(-pi * pi * r * r / b);
      };
    };
    const auto sum = [&](double b) {
      double total = 0;
      for (int i = -radius; i <= radius; ++i) total += gaussian(b)(i);
      return total;
    };
    const auto normal = [&](double b, double weight) {
      const double scale = std::sqrt(weight) / sum(b);
      return taps_of(radius, [&](int i) { return scale * gaussian(b)(i); });
    };
    y = normal(0.0047, 1);
    cx = normal(0.0053, 1);
    constexpr double b1 = widest, b2 = 0.025;
    const double narrow = 13.5 * std::sqrt(pi / b2) * sum(b2) * sum(b2);
    const double wide = 34.1 * std::sqrt(pi / b1) * sum(b1) * sum(b1);
    cz_narrow = normal(b2, narrow / (narrow + wide));
    cz_wide = normal(b1, wide / (narrow + wide));
  }
};

// Detectors of edges and points (section 4.2): the first and second derivative of a Gaussian one way, the Gaussian the
// other way. Positive weights sum to 1 and negative ones to -1.
struct Features {
  Taps smooth, edge, point;

  explicit Features(double pixels_per_degree) {
    const double deviation = 0.5 * feature_width_deg * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gaussian = [=](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    const auto normal = [&](const auto& weight) {
      double positive = 0, negative = 0;
      for (int i = -radius; i <= radius; ++i) (weight(i) > 0 ? positive : negative) += std::abs(weight(i));
      return taps_of(radius, [&](int i) { return weight(i) / (weight(i) > 0 ? positive : negative); });
    };
    smooth = normal(gaussian);
    edge = normal([&](int i) { return -i * gaussian(i); });
    point = normal([&](int i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); });
  }
};

// The picture is filtered in tiles. A filter also reads a margin around its tile. A margin outside the picture has the values of
// the picture's nearest pixels.
constexpr int tile_side = 64;
using Plane = Image<double>;

// to[x] = the sum of weight[t] * row(t)[x] over all t in their order, for x from 0 to count - 1. Eight places at a time, so that
// their sums stay in registers.
template <class Row>
void weighted_sum(const std::vector<double>& weights, int count, double* to, const Row& row) {
  constexpr int lanes = 8;
  int x = 0;
  for (; x + lanes <= count; x += lanes) {
    double sum[lanes] = {};
    for (size_t t = 0; t < weights.size(); ++t) {
      const double weight = weights[t];
      const double* from = row(static_cast<int>(t)) + x;
      for (int lane = 0; lane < lanes; ++lane) sum[lane] += weight * from[lane];
    }
    std::copy_n(sum, lanes, to + x);
  }
  for (; x < count; ++x) {
    double sum = 0;
    for (size_t t = 0; t < weights.size(); ++t) sum += weights[t] * row(static_cast<int>(t))[x];
    to[x] = sum;
  }
}

// One separable filter over a plane, without the margin.
Plane filtered(const Plane& plane, int margin, const Taps& across, const Taps& down) {
  const int width = plane.width - 2 * margin, height = plane.height - 2 * margin;
  Plane rows(width, plane.height), made(width, height);
  for (int y = 0; y < plane.height; ++y)
    weighted_sum(across.weights, width, &rows.at(0, y),
                 [&](int t) { return &plane.at(margin - across.radius() + t, y); });
  for (int y = 0; y < height; ++y)
    weighted_sum(down.weights, width, &made.at(0, y),
                 [&](int t) { return &rows.at(0, y + margin - down.radius() + t); });
  return made;
}

// What the eye gets of one tile of a picture.
struct Seen {
  std::array<Plane, 3> color;  // YCxCz
  Plane edge, point;           // strengths
  bool same_at(size_t i, const Seen& other) const {
    return color[0][i] == other.color[0][i] && color[1][i] == other.color[1][i] && color[2][i] == other.color[2][i] &&
           edge[i] == other.edge[i] && point[i] == other.point[i];
  }
};

class Evaluator {
 public:
  explicit Evaluator(double pixels_per_degree)
      : blur_(pixels_per_degree),
        features_(pixels_per_degree),
        margin_(std::max(blur_.radius, features_.edge.radius())) {
    for (int v = 0; v < 256; ++v) linear_[static_cast<size_t>(v)] = srgb_decoded(static_cast<uint8_t>(v));
  }
  int margin() const { return margin_; }

  // Sets the errors of width x height pixels from (left, top) on.
  void evaluate(const Image<glm::u8vec3>& reference, const Image<glm::u8vec3>& test, int left, int top, int width,
                int height, Image<float>& error) const {
    const Seen a = see(reference, left, top, width, height), b = see(test, left, top, width, height);
    for (size_t i = 0; i < a.edge.size(); ++i) {
      if (a.same_at(i, b)) continue;  // no error: the filters read nothing that differs
      const auto lab = [&](const Seen& seen) {
        return hunt_lab(glm::clamp(rgb_of_ycxcz({seen.color[0][i], seen.color[1][i], seen.color[2][i]}), 0.0, 1.0));
      };
      const double color = redistributed(color_distance(lab(a), lab(b)));
      const double feature =
          std::pow(std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i])) / std::numbers::sqrt2,
                   q_feature);
      const int x = left + static_cast<int>(i) % width, y = top + static_cast<int>(i) / width;
      error.at(x, y) = static_cast<float>(std::pow(color, 1 - feature));
    }
  }

 private:
  Seen see(const Image<glm::u8vec3>& picture, int left, int top, int width, int height) const {
    std::array<Plane, 3> plane;
    for (Plane& channel : plane) channel = Plane(width + 2 * margin_, height + 2 * margin_);
    for (int y = 0; y < plane[0].height; ++y)
      for (int x = 0; x < plane[0].width; ++x) {
        const glm::u8vec3 here = picture.at(std::clamp(left + x - margin_, 0, picture.width - 1),
                                            std::clamp(top + y - margin_, 0, picture.height - 1));
        const glm::dvec3 color = ycxcz_of_rgb({linear_[here.x], linear_[here.y], linear_[here.z]});
        for (int c = 0; c < 3; ++c) plane[static_cast<size_t>(c)].at(x, y) = color[c];
      }
    Seen seen;
    seen.color = {filtered(plane[0], margin_, blur_.y, blur_.y), filtered(plane[1], margin_, blur_.cx, blur_.cx),
                  filtered(plane[2], margin_, blur_.cz_wide, blur_.cz_wide)};
    const Plane narrow = filtered(plane[2], margin_, blur_.cz_narrow, blur_.cz_narrow);
    for (size_t i = 0; i < narrow.size(); ++i) seen.color[2][i] += narrow[i];
    for (double& y : plane[0].pixels) y = (y + 16) / 116;  // from 0 to 1
    const auto strength = [&](const Taps& taps) {
      Plane made = filtered(plane[0], margin_, taps, features_.smooth);
      const Plane other = filtered(plane[0], margin_, features_.smooth, taps);
      for (size_t i = 0; i < made.size(); ++i) made[i] = std::hypot(made[i], other[i]);
      return made;
    };
    seen.edge = strength(features_.edge);
    seen.point = strength(features_.point);
    return seen;
  }

  Blur blur_;
  Features features_;
  int margin_;
  std::array<double, 256> linear_;
};

}  // namespace

Flip flip(const Image<glm::u8vec3>& reference, const Image<glm::u8vec3>& test, double pixels_per_degree) {
  if (reference.width != test.width || reference.height != test.height)
    throw std::logic_error("FLIP compares pictures of one size");
  Flip result{.mean = std::numeric_limits<double>::quiet_NaN(), .error = Image<float>(test.width, test.height, 0)};
  if (test.size() == 0) return result;
  const Evaluator evaluator(pixels_per_degree);
  const int across = (test.width + tile_side - 1) / tile_side, down = (test.height + tile_side - 1) / tile_side;
  tbb::parallel_for(tbb::blocked_range<int>(0, across * down, 1), [&](const tbb::blocked_range<int>& range) {
    for (int tile = range.begin(); tile != range.end(); ++tile) {
      const int left = tile % across * tile_side, top = tile / across * tile_side;
      const int right = std::min(left + tile_side, test.width), bottom = std::min(top + tile_side, test.height);
      // A pixel whose filters read nothing that differs has no error. Those of the tile that have one lie in a rectangle.
      const int margin = evaluator.margin();
      glm::ivec2 low(std::numeric_limits<int>::max()), high(std::numeric_limits<int>::min());
      for (int y = std::max(0, top - margin); y < std::min(bottom + margin, test.height); ++y)
        for (int x = std::max(0, left - margin); x < std::min(right + margin, test.width); ++x)
          if (reference.at(x, y) != test.at(x, y)) {
            low = glm::min(low, glm::ivec2(x, y));
            high = glm::max(high, glm::ivec2(x, y));
          }
      if (low.x > high.x) continue;
      low = glm::max(low - margin, glm::ivec2(left, top));
      high = glm::min(high + margin + 1, glm::ivec2(right, bottom));
      evaluator.evaluate(reference, test, low.x, low.y, high.x - low.x, high.y - low.y, result.error);
    }
  });
  double sum = 0;  // in the pixels' order, so that it is the same on every machine
  for (const float error : result.error.pixels) sum += error;
  result.mean = sum / static_cast<double>(test.size());
  return result;
}

}  // namespace noonmark
