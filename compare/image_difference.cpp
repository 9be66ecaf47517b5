#include "compare/image_difference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace noonmark {
namespace {

// Constants of the paper, by their names there.
constexpr double csf_b1 = 0.0047;        // achromatic contrast sensitivity, section 4.1.1: one Gaussian in degrees
constexpr double widest_b = 0.04;        // of the blue-yellow filter, from which the radius of all follows
constexpr double q_c = 0.7;              // exponent of the colour difference, 4.1.2
constexpr double p_c = 0.4, p_t = 0.95;  // p_c of its largest value is mapped to p_t, 4.1.2
constexpr double w = 0.082;              // degrees from peak to trough of the feature detectors, 4.2
// The exponent of the feature difference, q_f, is 1/2, 4.2: a square root below.

using Taps = std::vector<float>;  // odd; the middle one is the pixel's own

void each_row(const Image<float>& image, const auto& work) {
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height, 16), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y) work(y);
  });
}

// Both repeat the border's pixels beyond it.
Image<float> along_x(const Image<float>& image, const Taps& taps) {
  const int radius = static_cast<int>(taps.size()) / 2, width = image.width;
  Image<float> out(width, image.height);
  each_row(image, [&](int y) {
    std::vector<float> padded(static_cast<size_t>(width + 2 * radius));
    for (int x = 0; x < width + 2 * radius; ++x)
      padded[static_cast<size_t>(x)] = image.at(std::clamp(x - radius, 0, width - 1), y);
    float* const to = &out.at(0, y);
    for (size_t k = 0; k < taps.size(); ++k) {
      const float* const from = padded.data() + k;
      const float tap = taps[k];
      for (int x = 0; x < width; ++x) to[x] += tap * from[x];
    }
  });
  return out;
}

Image<float> along_y(const Image<float>& image, const Taps& taps) {
  const int radius = static_cast<int>(taps.size()) / 2, width = image.width;
  Image<float> out(width, image.height);
  each_row(image, [&](int y) {
    float* const to = &out.at(0, y);
    for (size_t k = 0; k < taps.size(); ++k) {
      const float* const from = &image.at(0, std::clamp(y + static_cast<int>(k) - radius, 0, image.height - 1));
      const float tap = taps[k];
      for (int x = 0; x < width; ++x) to[x] += tap * from[x];
    }
  });
  return out;
}

Taps taps_of(int radius, const auto& weight) {
  Taps taps;
  for (int x = -radius; x <= radius; ++x) taps.push_back(static_cast<float>(weight(static_cast<double>(x))));
  return taps;
}

// Positive weights sum to 1, negative ones to -1.
Taps normalised(Taps taps) {
  double positive = 0, negative = 0;
  for (float t : taps) (t > 0 ? positive : negative) += std::abs(static_cast<double>(t));
  for (float& t : taps) t = static_cast<float>(t / (t > 0 ? positive : negative));
  return taps;
}

// CIELAB's lightness of a relative luminance (ISO/CIE 11664-4).
double lightness(double y) {
  constexpr double delta = 6.0 / 29.0;
  return 116 * (y > delta * delta * delta ? std::cbrt(y) : y / (3 * delta * delta) + 4.0 / 29.0) - 16;
}

// The largest colour difference of the Hunt-adjusted sRGB cube, between its green and its blue, to the power
// q_c: 41.28.
double largest_color_difference() {
  const auto hunt_adjusted = [](glm::dvec3 xyz_of_white) {  // tristimulus values relative to D65
    const auto f = [](double t) { return (lightness(t) + 16) / 116; };
    const double l = lightness(xyz_of_white.y);
    return glm::dvec3(l, 0.01 * l * 500 * (f(xyz_of_white.x) - f(xyz_of_white.y)),
                      0.01 * l * 200 * (f(xyz_of_white.y) - f(xyz_of_white.z)));
  };
  // What the primaries and the white of sRGB (ITU-R BT.709) make in CIE XYZ.
  const glm::dvec3 white(0.950429, 1, 1.088900);
  const glm::dvec3 green = hunt_adjusted(glm::dvec3(0.357592, 0.715183, 0.119197) / white);
  const glm::dvec3 blue = hunt_adjusted(glm::dvec3(0.180450, 0.072180, 0.950373) / white);
  const glm::dvec3 d = glm::abs(green - blue);
  return std::pow(d.x + std::hypot(d.y, d.z), q_c);  // HyAB
}

// 0 ... 1 of a difference in lightness.
double color_term(double lightness_difference, double largest) {
  const double power = std::pow(lightness_difference, q_c), knee = p_c * largest;
  return power < knee ? p_t / knee * power : p_t + (power - knee) / (largest - knee) * (1 - p_t);
}

// How strongly each pixel is an edge, and how strongly a point or line: lengths of the first and second derivatives.
struct Features {
  Image<float> edge_x, edge_y, point_x, point_y;
};
Features features(const Image<float>& y, double pixels_per_degree) {
  const double sd = 0.5 * w * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sd));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sd * sd)); };
  const Taps blur = normalised(taps_of(radius, gauss));
  const Taps first = normalised(taps_of(radius, [&](double x) { return -x * gauss(x); }));
  const Taps second = normalised(taps_of(radius, [&](double x) { return (x * x / (sd * sd) - 1) * gauss(x); }));
  const Image<float> blurred = along_x(y, blur);
  return {along_y(along_x(y, first), blur), along_y(blurred, first), along_y(along_x(y, second), blur),
          along_y(blurred, second)};
}

Image<float> as_displayed(const Image<float>& image) {
  Image<float> out = image;
  for (float& v : out.pixels) v = std::clamp(v, 0.0f, 1.0f);  // NaN stays
  return out;
}

void check_sizes(const Image<float>& a, const Image<float>& b) {
  if (a.width != b.width || a.height != b.height) throw std::logic_error("pictures of two sizes are compared");
}

}  // namespace

double root_mean_square_difference(const Image<float>& a, const Image<float>& b) {
  check_sizes(a, b);
  if (a.size() == 0) return 0;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double mean_of(const Image<float>& image) {
  double sum = 0;
  for (float v : image.pixels) sum += static_cast<double>(v);
  return image.size() == 0 ? 0 : sum / static_cast<double>(image.size());
}

Image<float> flip_difference(const Image<float>& reference, const Image<float>& test, double pixels_per_degree) {
  check_sizes(reference, test);
  Image<float> out(reference.width, reference.height, 0);
  const auto same = [](float a, float b) { return a == b && std::isfinite(a); };
  if (std::equal(reference.pixels.begin(), reference.pixels.end(), test.pixels.begin(), same)) return out;

  const Image<float> y[2] = {as_displayed(reference), as_displayed(test)};
  const int csf_radius = static_cast<int>(
      std::ceil(3 * std::sqrt(widest_b / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));
  const Taps csf = normalised(taps_of(csf_radius, [&](double x) {
    const double degrees = x / pixels_per_degree;
    return std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / csf_b1);
  }));
  const Image<float> seen[2] = {along_y(along_x(y[0], csf), csf), along_y(along_x(y[1], csf), csf)};
  const Features f[2] = {features(y[0], pixels_per_degree), features(y[1], pixels_per_degree)};
  const double largest = largest_color_difference();

  each_row(out, [&](int row) {
    for (int x = 0; x < out.width; ++x) {
      const size_t i = out.index(x, row);
      const double finite = (reference[i] - test[i]) * 0.0;  // NaN where either is not finite, else 0
      const float s0 = seen[0][i], s1 = seen[1][i];
      if (s0 == s1 && finite == 0) continue;  // no colour term: 0 whatever the features
      const auto l = [](float v) { return lightness(std::clamp(static_cast<double>(v), 0.0, 1.0)); };
      const auto length = [](float u, float v) { return std::sqrt(u * u + v * v); };
      const auto edge = [&](int k) { return length(f[k].edge_x[i], f[k].edge_y[i]); };
      const auto point = [&](int k) { return length(f[k].point_x[i], f[k].point_y[i]); };
      const double color = color_term(std::abs(l(s0) - l(s1)), largest);
      const float feature = std::max(std::abs(edge(0) - edge(1)), std::abs(point(0) - point(1)));
      const double shown = std::sqrt(std::min(static_cast<double>(feature) / std::numbers::sqrt2, 1.0));  // q_f
      out[i] = static_cast<float>(std::pow(color, 1 - shown) + finite);
    }
  });
  return out;
}

}  // namespace noonmark
