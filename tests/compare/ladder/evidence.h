// Random evidence for the tests of the ladder and of the bias curves, and a plain, slow evaluation of it, with which
// the results are compared. Nothing here calls the code under test.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "compare/ladder/bias_curves.h"
#include "compare/ladder/ladder.h"

namespace noonmark {

enum class Lookup { box, linear, cube };  // the kinds of tap patterns

struct Synthetic {
  ReceiverTruth truth;
  LookupProbe probe;
  TapTruth taps;
  Image<float> exact, stored;
  MapSettings map;
  BiasSettings bias;
  Image<float> r4, r5;  // set_verdicts() computes them from the maps
  Lookup lookup = Lookup::box;
  int kernel = 1;  // box, cube: taps on a side; linear: fetches of 2 x 2 texels on a side

  int side() const { return lookup == Lookup::linear ? kernel + 1 : kernel; }
  // The evidence refers to this object; it has the exact map as it is now.
  LookupEvidence evidence() const {
    exact_map_ = MapDepths(exact);
    return {truth, probe, taps, exact_map_, map, Bias(bias), r4, r5};
  }
  MapDepths stored_map() const { return MapDepths(stored); }

 private:
  mutable MapDepths exact_map_;
};

// The same evidence with the taps of one strip only, as in a measurement with many taps.
inline Synthetic only(const Synthetic& s, PixelRange strip) {
  Synthetic part = s;
  const auto cut = [&](auto& per_tap) {
    const auto at = [&](size_t pixel) {
      return per_tap.begin() + static_cast<std::ptrdiff_t>(pixel) * s.taps.taps_per_receiver;
    };
    per_tap = {at(strip.first), at(strip.end)};
  };
  cut(part.taps.taps);
  part.taps.first = strip.first;
  if (s.probe.cube_resolution > 0) cut(part.probe.cube_texel);
  part.probe.cube_first = strip.first;
  return part;
}

// Calls `visit` with the evidence of strips of random sizes that cover the picture.
template <class Visit>
void for_each_strip(const Synthetic& s, uint64_t seed, const Visit& visit) {
  std::mt19937_64 random(seed);
  const size_t pixels = s.truth.facing.size();
  for (size_t first = 0, end; first < pixels; first = end) {
    end = std::min(pixels, first + 1 + random() % (pixels / 2));
    visit(only(s, {first, end}), PixelRange{first, end});
  }
}

struct Shape {
  int width = 12, height = 9, resolution = 6, kernel = 1;
  bool lattice = true;  // depths and biases have only a few values, so that many are equal
  Lookup lookup = Lookup::box;
};

// Weights of a linear pattern's fetches. They are binary fractions; together with the weights of 1/64 between texels
// every sum is exact.
inline std::vector<double> fetch_weights(int kernel) {
  if (kernel == 1) return {1};
  if (kernel == 3) return {0.25, 0.5, 0.25};
  return {0.125, 0.25, 0.25, 0.25, 0.125};
}

inline TapPattern pattern_of(const Shape& shape) {
  TapPattern pattern;
  const int side = shape.lookup == Lookup::linear ? shape.kernel + 1 : shape.kernel;
  pattern.taps = side * side;
  pattern.in_world = shape.lookup == Lookup::cube;
  if (shape.lookup == Lookup::linear) {
    pattern.blended_side = side;
    pattern.kernel = fetch_weights(shape.kernel);
  }
  if (shape.lookup == Lookup::box) pattern.square_side = side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      pattern.offsets.emplace_back(static_cast<float>(2 * x + 1 - side) / 2, static_cast<float>(2 * y + 1 - side) / 2,
                                   0);
  return pattern;
}

// Random evidence with all cases that gl and raytrace can produce, and more: receivers in and outside the map, at and
// beyond far, ambiguous receivers, receivers that face away (their numbers are arbitrary), every wrap mode, any sum of
// biases with any reference of the lookup, and units that differ from receiver to receiver.
inline Synthetic random_evidence(uint64_t seed, const Shape& shape) {
  std::mt19937_64 random(seed);
  const auto chance = [&](int percent) { return static_cast<int>(random() % 100) < percent; };
  const auto depth = [&] {
    return shape.lattice ? static_cast<float>(random() % 17) / 16 : std::uniform_real_distribution<float>(0, 1)(random);
  };
  Synthetic s;
  s.kernel = shape.kernel;
  s.lookup = shape.lookup;
  s.probe.pattern = pattern_of(shape);
  const int w = shape.width, h = shape.height, n = shape.resolution, taps = s.probe.pattern.taps;
  const bool cube = shape.lookup == Lookup::cube;
  s.exact = s.stored = Image<float>(n, cube ? 6 * n : n);
  for (float& d : s.exact.pixels) d = depth();
  for (size_t i = 0; i < s.stored.size(); ++i) s.stored[i] = chance(70) ? s.exact[i] : depth();
  s.map.resolution = n;
  s.map.format = chance(50) ? DepthFormat::d24 : DepthFormat::d32f;
  s.map.wrap = static_cast<Wrap>(random() % 3);
  s.map.lit_beyond_far = chance(50);
  if (chance(50)) s.bias["constant"] = depth() / 4;
  if (chance(50)) s.bias["slope"] = depth();
  if (chance(25)) s.bias["slope_floor"] = depth() / 4;
  if (chance(50)) s.bias["tan"] = depth();
  if (chance(25)) s.bias["tan_floor"] = depth() / 4;
  if ((s.bias["tan"] > 0 || s.bias["tan_floor"] > 0) && chance(50))
    s.bias["tan_cap"] = s.bias["tan_floor"] + depth() / 2;
  if (chance(12)) s.bias["normal_offset"] = 0.25;
  if (shape.lookup == Lookup::box) s.bias.reference = std::string(tap_references()[random() % 3].name);
  if (chance(30)) s.bias.plane_cap = depth() / 8;
  s.probe.tap_reference = &Bias(s.bias).reference();
  s.probe.plane_cap = Bias(s.bias).plane_cap();
  s.truth.facing = s.truth.lit = s.truth.ambiguous = Image<uint8_t>(w, h, 0);
  s.truth.soft = s.probe.reference = s.probe.n_dot_l = s.probe.tan_theta = Image<float>(w, h, 0);
  s.probe.bias_unit = Image<float>(w, h, 1);
  s.probe.gradient = Image<glm::vec2>(w, h, glm::vec2(0));
  s.probe.map_texels = Image<glm::vec2>(w, h);
  s.taps.taps_per_receiver = taps;
  s.taps.taps.assign(static_cast<size_t>(w) * h * taps, 0);
  if (cube) {
    s.probe.cube_resolution = n;
    s.probe.cube_texel.resize(s.taps.taps.size());
    for (uint32_t& texel : s.probe.cube_texel) texel = static_cast<uint32_t>(random() % (6 * n * n));
    s.probe.cube_middle = Image<uint32_t>(w, h);
    for (size_t i = 0; i < s.probe.cube_middle.size(); ++i)
      s.probe.cube_middle[i] = s.probe.cube_texel[i * static_cast<size_t>(taps) + static_cast<size_t>(taps / 2)];
  }
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    const auto place = [&] { return static_cast<float>(static_cast<int>(random() % (3 * n * 64)) - n * 64) / 64; };
    s.probe.map_texels[i] = {place(), place()};
    if (!chance(85)) {
      s.probe.reference[i] = chance(50) ? std::numeric_limits<float>::quiet_NaN() : depth();
      s.probe.n_dot_l[i] = -depth();
      continue;
    }
    s.truth.facing[i] = 1;
    s.truth.ambiguous[i] = chance(10);
    s.truth.lit[i] = chance(50);
    s.truth.soft[i] = chance(60) ? static_cast<float>(s.truth.lit[i]) : depth();
    s.probe.reference[i] = chance(10) ? 1 + depth() : depth();
    s.probe.n_dot_l[i] = chance(5) ? 1 + 0x1p-23f : chance(10) ? 1.0f : depth();
    s.probe.tan_theta[i] = chance(10) ? 0 : 4 * depth();
    if (chance(60)) s.probe.bias_unit[i] = shape.lattice ? std::exp2(static_cast<float>(random() % 5) - 3) : depth();
    s.probe.gradient[i] = (glm::vec2(depth(), depth()) - 0.5f) / 8.0f;
    for (int t = 0; t < taps; ++t) {
      uint8_t bits = 0;
      // Without a filter, the exact place of the tap is the receiver itself.
      if (taps == 1 ? s.truth.lit[i] != 0 : chance(s.truth.lit[i] ? 80 : 20)) bits |= tap_exact_lit;
      if (chance(75) ? (bits & tap_exact_lit) != 0 : chance(50)) bits |= tap_texel_lit;
      if (chance(10)) bits |= tap_near_clipped;
      const bool moves = s.bias["normal_offset"] != 0;
      if (moves && chance(20)) bits |= tap_displaced;
      if (chance(5)) bits |= tap_texel_unsure;
      if (taps > 1 && chance(5)) bits |= moves ? tap_exact_unsure : tap_exact_unsure | tap_moved_unsure;
      if (moves && chance(5)) bits |= tap_moved_unsure;
      s.taps.taps[i * static_cast<size_t>(taps) + static_cast<size_t>(t)] = bits;
    }
    if (i % 3 == 0) {  // the taps of many receivers have the same truth
      const auto first = s.taps.taps.begin() + static_cast<std::ptrdiff_t>(i) * taps;
      std::fill_n(first, taps, *first);
    }
  }
  return s;
}

namespace naive {

// All facts about one tap: its truths (at its exact place, at the place of a moved lookup, at the texel's centre),
// which of them float error can change, whether the map covers the tap, and the depth that OpenGL reads for it.
struct Tap {
  bool exact_lit, moved_lit, texel_lit, exact_sure, moved_sure, texel_sure, covered, beyond_far;
  float reference, depth;
  double weight;  // 1, unless a sampler blends
};

inline int folded(int i, int n, Wrap wrap, bool& border) {
  if (wrap == Wrap::repeat) {
    while (i < 0) i += n;
    while (i >= n) i -= n;
  } else if (wrap == Wrap::clamp_to_edge) {
    if (i < 0) i = 0;
    if (i > n - 1) i = n - 1;
  } else if (i < 0 || i > n - 1) {
    border = true;
  }
  return i;
}

inline std::vector<Tap> taps_of(const Synthetic& s, const Image<float>& map, size_t receiver) {
  std::vector<Tap> result;
  const int n = map.width, side = s.side();
  size_t bits_at = receiver * static_cast<size_t>(side) * static_cast<size_t>(side);
  const float u = s.probe.map_texels[receiver].x, v = s.probe.map_texels[receiver].y;
  // The texel of the first tap in the lowest row. A box is centred on P's own texel, fetches on the four texels around
  // P.
  const float back = s.lookup == Lookup::linear ? 0.5f : 0;
  const int first_x = static_cast<int>(std::floor(u - back)) - (s.kernel - 1) / 2;
  const int first_y = static_cast<int>(std::floor(v - back)) - (s.kernel - 1) / 2;
  const auto weight = [&](int index, float at) {
    if (s.lookup != Lookup::linear) return 1.0;
    const std::vector<double> fetches = fetch_weights(s.kernel);
    const double right = (at - 0.5f) - std::floor(at - 0.5f);
    double sum = 0;
    for (int f = 0; f < s.kernel; ++f)
      sum += fetches[static_cast<size_t>(f)] * (index == f ? 1 - right : index == f + 1 ? right : 0);
    return sum;
  };
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      int x = first_x + i, y = first_y + j;
      if (s.lookup == Lookup::cube) {
        x = static_cast<int>(s.probe.cube_texel[bits_at]) % n;
        y = static_cast<int>(s.probe.cube_texel[bits_at]) / n;
      }
      const uint8_t bits = s.taps.taps[bits_at++];
      const bool beyond = s.probe.reference[receiver] > 1;
      bool border = false;
      const int column = folded(x, n, s.map.wrap, border), row = folded(y, map.height, s.map.wrap, border);
      const float depth = border ? 1.0f : map.pixels[static_cast<size_t>(row * n + column)];
      const bool inside = 0 <= x && x < n && 0 <= y && y < map.height;
      const bool exact = (bits & 1) != 0, moved = (bits & 16) != 0 ? !exact : exact;
      float reference = s.probe.reference[receiver];
      const glm::vec2 slope = s.probe.gradient[receiver];
      if (s.bias.reference == "receiver_plane") {
        float rise = slope.x * static_cast<float>(i - s.kernel / 2) + slope.y * static_cast<float>(j - s.kernel / 2);
        if (s.bias.plane_cap) {
          const float most = static_cast<float>(*s.bias.plane_cap) * s.probe.bias_unit[receiver];
          rise = rise > most ? most : rise < -most ? -most : rise;
        }
        reference += rise;
      }
      if (s.bias.reference == "texel_plane")
        reference += slope.x * (static_cast<float>(x) + 0.5f - u) + slope.y * (static_cast<float>(y) + 0.5f - v);
      result.push_back({exact, moved, (bits & 2) != 0, (bits & 8) == 0, (bits & 32) == 0, (bits & 64) == 0,
                        inside && !beyond && (bits & 4) == 0, beyond, reference, depth, weight(i, u) * weight(j, v)});
    }
  }
  return result;
}

// Float error can change the verdict of the receiver.
inline bool ambiguous(const Synthetic& s, size_t receiver) { return s.truth.ambiguous[receiver] != 0; }
// Float error can change the verdict of one of its taps. Taps without a weight are not read.
inline bool undecided(const Synthetic& s, size_t receiver) {
  for (const Tap& tap : taps_of(s, s.exact, receiver))
    if (tap.weight > 0 && !(tap.exact_sure && tap.moved_sure && tap.texel_sure)) return true;
  return false;
}

// What the shader does: first lit_beyond_far, otherwise one float comparison. With fixed-point depths, a comparison
// sampler clamps the compared value, so nothing is beyond 1.
inline bool verdict(const Synthetic& s, const Tap& tap, float bias, DepthFormat format) {
  if (tap.beyond_far && s.map.lit_beyond_far) return true;
  float biased = tap.reference - bias;
  if (s.lookup == Lookup::linear && format != DepthFormat::d32f && biased > 1) biased = 1;
  return !(biased > tap.depth);
}
inline bool verdict(const Synthetic& s, const Tap& tap, float bias) { return verdict(s, tap, bias, s.map.format); }

inline float turned(float scale, float by, float floor) {
  const float scaled = scale * by;
  return scaled > floor ? scaled : floor;
}

// The sum of the parts, in their order. The part `varied` has the value x instead of its own.
inline float bias_at(const Synthetic& s, size_t i, std::string_view varied = "", float x = 0) {
  const auto value = [&](std::string_view name) {
    return name == varied ? x : static_cast<float>(std::min(s.bias[name], 1e30));
  };
  float units = value("constant");
  units += turned(value("slope"), 1.0f - s.probe.n_dot_l[i], value("slope_floor"));
  const float by_tan = turned(value("tan"), s.probe.tan_theta[i], value("tan_floor"));
  units += by_tan > value("tan_cap") ? value("tan_cap") : by_tan;
  return units * s.probe.bias_unit[i];
}

// The cause of every combination: [covered][D][V][L]. compare/ladder/ladder.h gives the rule in words.
inline constexpr Cause causes[2][2][2][2] = {
    {{{Cause::none, Cause::coverage_light}, {Cause::none, Cause::coverage_light}},
     {{Cause::coverage_dark, Cause::none}, {Cause::coverage_dark, Cause::none}}},
    {{{Cause::none, Cause::peter_panning}, {Cause::none, Cause::aliasing_light}},
     {{Cause::aliasing_dark, Cause::none}, {Cause::acne, Cause::none}}},
};

// The cause of a tap whose truths are sure.
inline Cause cause_of(const Tap& tap, bool lit) {
  const Cause cause = causes[tap.covered][tap.moved_lit][tap.texel_lit][lit];
  return cause != Cause::none && !(tap.moved_sure && tap.texel_sure) ? Cause::undecided : cause;
}

inline float visibility(const Synthetic& s, const Image<float>& map, size_t receiver, DepthFormat format) {
  double lit = 0;
  for (const Tap& tap : taps_of(s, map, receiver)) lit += verdict(s, tap, bias_at(s, receiver), format) * tap.weight;
  if (s.lookup == Lookup::linear) return static_cast<float>(lit);
  return static_cast<float>(lit) / static_cast<float>(s.kernel * s.kernel);
}

}  // namespace naive

// Sets R4 and R5 to what OpenGL would give for these maps. The exact map is uploaded as floats.
inline void set_verdicts(Synthetic& s) {
  s.r4 = s.r5 = Image<float>(s.truth.facing.width, s.truth.facing.height, 0);
  for (size_t i = 0; i < s.r4.size(); ++i) {
    s.r4[i] = naive::visibility(s, s.exact, i, DepthFormat::d32f);
    s.r5[i] = naive::visibility(s, s.stored, i, s.map.format);
  }
}

}  // namespace noonmark
