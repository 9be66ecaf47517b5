#include "compare/soundness.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double farthest_texel = 1048576;  // the shader clamps texels there (gl/shaders/receiver.glsl)
constexpr double u = 0x1p-24;               // the relative error of one float operation

// std::max that takes a NaN for an error without bound.
void raise(double& value, double candidate) {
  if (!(candidate <= value)) value = std::isnan(candidate) ? infinity : candidate;
}

struct Found {
  uint64_t facing = 0, broken = 0;
  double excess = 0, address_texels = 0, reference = 0;
};

Found join(Found a, const Found& b) {
  a.facing += b.facing;
  a.broken += b.broken;
  raise(a.excess, b.excess);
  raise(a.address_texels, b.address_texels);
  raise(a.reference, b.reference);
  return a;
}

// The probe's numbers at one receiver against the frame. What float arithmetic may be off by, for a row of the matrix
// with S = sum |m_j p_j|: rounding the row u S, four products and three sums 4 u S, the division by w (2.5 ulp in GLSL)
// 3 u S, halving and adding one half 2 u (S/2 + 1/2), times the resolution u more; halved on the way from clip space to
// the window that is less than u (6 S + 2). Where the lookup is moved by d N, p is P + d N, each part of which is a
// rounded product in a rounded sum: u (|d N_j| + |p_j|) times |m_j|, halved too. No factor is added for comfort.
void compare_probe(const SoundnessInput& in, const glm::dmat4& clip, size_t i, Found& found) {
  const DepthBias& bias = in.evidence.bias;
  const glm::dvec3 at(in.receivers.position[i]);
  const glm::dvec4 p(bias.looked_up(at, in.receivers.normal[i]), 1);
  const auto most = [&](int row) {
    double sum = 0, moved = 0;
    for (int j = 0; j < 4; ++j) {
      sum += std::abs(clip[j][row] * p[j]);
      if (bias.moves_lookup() && j < 3) moved += std::abs(clip[j][row]) * (std::abs(p[j] - at[j]) + std::abs(p[j]));
    }
    return u * (6 * sum + 2 + moved / 2);
  };
  const LookupProbe& probe = in.evidence.probe;
  const glm::dvec3 light = in.frame.to_light(glm::dvec3(p));
  const double reference = std::abs(probe.reference[i] - in.frame.window_depth(light.z));
  raise(found.reference, reference);
  raise(found.excess, reference / most(2));

  for (int axis = 0; axis < 2; ++axis) {
    const double place = (light[axis] / in.frame.extent_m + 0.5) * in.frame.resolution;
    const double beside = std::abs(std::clamp(place, -farthest_texel, farthest_texel) - (probe.texel[i][axis] + 0.5));
    const double outside = std::max(0.0, beside - 0.5);
    raise(found.address_texels, outside);
    raise(found.excess, outside / (in.frame.resolution * most(axis)));
  }

  // Three products of which the light's component is rounded, and two sums.
  const glm::dvec3 products = glm::dvec3(in.receivers.normal[i]) * in.frame.direction_to_light();
  const double n_dot_l = products.x + products.y + products.z;
  const double sum = std::abs(products.x) + std::abs(products.y) + std::abs(products.z);
  raise(found.excess, std::abs(probe.n_dot_l[i] - n_dot_l) / (5 * u * sum));
}

float technique(const LookupEvidence& e, const Image<float>& map, int kernel, size_t i) {
  const int taps = e.taps.taps_per_receiver;
  const float biased = e.probe.reference[i] - e.bias.at(e.probe.n_dot_l[i]);
  int lit = 0;
  for (int t = 0; t < taps; ++t) {
    const Tap tap = tap_of(e.probe, e.taps, e.map, map, i, kernel, t);
    lit += tap.always_lit || !(biased > tap.depth);
  }
  return static_cast<float>(lit) / static_cast<float>(taps);
}

double quantum(DepthFormat format, float depth) {
  switch (format) {
    case DepthFormat::d16:
      return 1.0 / 65535;
    case DepthFormat::d24:
      return 1.0 / 16777215;
    case DepthFormat::d32f:
      break;
  }
  return static_cast<double>(std::nextafter(depth, 2.0f)) - depth;
}

// Whether the float is what n bits read as: k / (2^n - 1), or a float beside it, where the driver's conversion rounds.
bool held_by(int bits, float depth) {
  const double steps = std::exp2(bits) - 1;
  const float nearest = static_cast<float>(std::round(depth * steps) / steps);
  return std::abs(nearest - depth) <= std::nextafter(depth, 2.0f) - depth;
}

struct MapFound {
  double error_quanta = 0;
  int bits = 16;
};

MapFound compare_maps(const SoundnessInput& in) {
  const Image<float>& exact = in.evidence.exact_map;
  Image<uint8_t> asked(exact.width, exact.height);
  for (size_t i = 0; i < in.evidence.truth.facing.size(); ++i) {
    const glm::ivec2 texel = in.evidence.probe.texel[i];
    if (in.evidence.truth.facing[i] && inside_map(texel, exact.width)) asked.at(texel.x, texel.y) = 1;
  }
  std::vector<double> errors;
  MapFound found;
  for (size_t i = 0; i < asked.size(); ++i) {
    if (!asked[i]) continue;
    const double error = std::abs(static_cast<double>(in.stored_map[i]) - exact[i]);
    errors.push_back(std::isnan(error) ? infinity : error / quantum(in.evidence.map.format, exact[i]));
    if (found.bits == 16 && !held_by(16, in.stored_map[i])) found.bits = 24;
    if (found.bits == 24 && !held_by(24, in.stored_map[i])) found.bits = 32;
  }
  if (errors.empty()) return found;  // nothing of the map was looked at
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  found.error_quanta = *middle;
  return found;
}

}  // namespace

Image<float> tie_map(const LookupEvidence& e) {
  Image<float> map(e.exact_map.width, e.exact_map.height, 1.0f);
  for (size_t i = 0; i < e.truth.facing.size(); ++i) {
    const glm::ivec2 read = wrapped(e.probe.texel[i], map.width, e.map.wrap);
    if (!e.truth.facing[i] || read.x < 0) continue;
    const float biased = e.probe.reference[i] - e.bias.at(e.probe.n_dot_l[i]);
    const float depth = (read.x + read.y) % 2 ? std::nextafter(biased, -1.0f) : biased;
    if (depth > 0 && depth <= 1) map.at(read.x, read.y) = depth;
  }
  return map;
}

std::map<std::string, double> measure_soundness(const SoundnessInput& in) {
  const LookupEvidence& e = in.evidence;
  const int kernel = kernel_of(e.taps);
  const glm::dmat4 clip = in.frame.clip_from_world();
  const Found found = tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, e.truth.facing.size(), 8192), Found{},
      [&](const tbb::blocked_range<size_t>& range, Found so_far) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
          if (!e.truth.facing[i]) continue;
          ++so_far.facing;
          // Written so that a NaN is broken.
          so_far.broken +=
              !(e.r4[i] == technique(e, e.exact_map, kernel, i) && e.r5[i] == technique(e, in.stored_map, kernel, i) &&
                in.tie_lookup[i] == technique(e, in.ties, kernel, i));
          compare_probe(in, clip, i, so_far);
        }
        return so_far;
      },
      join);
  const MapFound map = compare_maps(in);
  const auto measured = [&](double value) {
    return found.facing == 0 ? std::numeric_limits<double>::quiet_NaN() : value;
  };
  return {
      {"contract", measured(static_cast<double>(found.broken) / static_cast<double>(found.facing))},
      {"rounding_excess", measured(found.excess)},
      {"address_error_texels", measured(found.address_texels)},
      {"reference_error_m", measured(found.reference * (in.frame.far_m - in.frame.near_m))},
      {"map_error_quanta", measured(map.error_quanta)},
      {"map_bits", measured(map.bits)},
  };
}

}  // namespace noonmark
