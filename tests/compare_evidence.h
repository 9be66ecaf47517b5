// Evidence made at random for the tests of the ladder and of the bias curves, and the plain, slow reading of it that
// they are held to. Nothing here calls the code under test.
#pragma once
#include <array>
#include <random>
#include <vector>

#include "compare/ladder.h"

namespace noonmark {

struct Synthetic {
  ReceiverTruth truth;
  LookupProbe probe;
  TapTruth taps;
  Image<float> exact, stored;
  MapSettings map;
  DepthBias bias;
  Image<float> r4, r5;  // as set_verdicts() reads them off the maps
  int kernel = 1;

  LookupEvidence evidence() const { return {truth, probe, taps, exact, map, bias, r4, r5}; }
};

struct Shape {
  int width = 12, height = 9, resolution = 6, kernel = 1;
  bool lattice = true;  // depths and biases of a few values, so that many are equal
};

// Any evidence that gl and raytrace could hand over, and more: receivers in and outside the map, at and beyond far,
// ambiguous ones, ones that face away (whose numbers are rubbish), every wrap mode.
inline Synthetic random_evidence(uint64_t seed, const Shape& shape) {
  std::mt19937_64 random(seed);
  const auto chance = [&](int percent) { return static_cast<int>(random() % 100) < percent; };
  const auto depth = [&] {
    return shape.lattice ? static_cast<float>(random() % 17) / 16 : std::uniform_real_distribution<float>(0, 1)(random);
  };
  Synthetic s;
  s.kernel = shape.kernel;
  const int w = shape.width, h = shape.height, n = shape.resolution, taps = shape.kernel * shape.kernel;
  s.exact = s.stored = Image<float>(n, n);
  for (float& d : s.exact.pixels) d = depth();
  for (size_t i = 0; i < s.stored.size(); ++i) s.stored[i] = chance(70) ? s.exact[i] : depth();
  s.map.resolution = n;
  s.map.wrap = static_cast<Wrap>(random() % 3);
  s.map.lit_beyond_far = chance(50);
  s.bias.form = static_cast<BiasForm>(random() % 4);
  if (s.bias.form == BiasForm::constant) s.bias.constant = depth() / 4;
  if (s.bias.form == BiasForm::slope) {
    s.bias.slope = depth();
    s.bias.floor = chance(50) ? 0 : depth() / 4;
  }
  if (s.bias.form == BiasForm::normal_offset) s.bias.normal_offset_m = 0.25f;
  s.truth.facing = s.truth.lit = s.truth.ambiguous = Image<uint8_t>(w, h, 0);
  s.truth.soft = s.probe.reference = s.probe.n_dot_l = Image<float>(w, h, 0);
  s.probe.texel = Image<glm::ivec2>(w, h);
  s.taps.taps_per_receiver = taps;
  s.taps.taps.assign(static_cast<size_t>(w) * h * taps, 0);
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    s.probe.texel[i] = {static_cast<int>(random() % (3 * n)) - n, static_cast<int>(random() % (3 * n)) - n};
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
    for (int t = 0; t < taps; ++t) {
      uint8_t bits = 0;
      // Unfiltered, the tap's exact place is the receiver itself.
      if (taps == 1 ? s.truth.lit[i] != 0 : chance(s.truth.lit[i] ? 80 : 20)) bits |= tap_exact_lit;
      if (chance(75) ? (bits & tap_exact_lit) != 0 : chance(50)) bits |= tap_texel_lit;
      if (chance(10)) bits |= tap_near_clipped;
      if (chance(3)) bits |= tap_ambiguous;
      if (s.bias.form == BiasForm::normal_offset && chance(20)) bits |= tap_displaced;
      s.taps.taps[i * static_cast<size_t>(taps) + static_cast<size_t>(t)] = bits;
    }
  }
  return s;
}

namespace naive {

// One tap in the plainest words: its truths (at its own exact place, at the one where a moved lookup asks, at the
// texel's centre), whether the map covers it, and the depth that OpenGL finds for it.
struct Tap {
  bool exact_lit, moved_lit, texel_lit, covered, beyond_far;
  float depth;
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
  const int n = map.width, r = (s.kernel - 1) / 2;
  size_t bits_at = receiver * static_cast<size_t>(s.kernel) * static_cast<size_t>(s.kernel);
  for (int dy = -r; dy <= r; ++dy) {
    for (int dx = -r; dx <= r; ++dx) {
      const uint8_t bits = s.taps.taps[bits_at++];
      const int x = s.probe.texel[receiver].x + dx, y = s.probe.texel[receiver].y + dy;
      const bool beyond = s.probe.reference[receiver] > 1;
      bool border = false;
      const int column = folded(x, n, s.map.wrap, border), row = folded(y, n, s.map.wrap, border);
      const float depth = border ? 1.0f : map.pixels[static_cast<size_t>(row * n + column)];
      const bool inside = 0 <= x && x < n && 0 <= y && y < n;
      const bool exact = (bits & 1) != 0, moved = (bits & 16) != 0 ? !exact : exact;
      result.push_back({exact, moved, (bits & 2) != 0, inside && !beyond && (bits & 4) == 0, beyond, depth});
    }
  }
  return result;
}

// The receiver's own verdict, or that of any of its taps, may be another one.
inline bool ambiguous(const Synthetic& s, size_t receiver) {
  bool result = s.truth.ambiguous[receiver] != 0;
  const size_t taps = static_cast<size_t>(s.kernel) * static_cast<size_t>(s.kernel);
  for (size_t t = 0; t < taps; ++t) result |= (s.taps.taps[receiver * taps + t] & 8) != 0;
  return result;
}

// The shader: lit_beyond_far first, else one float comparison.
inline bool verdict(const Synthetic& s, const Tap& tap, size_t receiver, float bias) {
  if (tap.beyond_far && s.map.lit_beyond_far) return true;
  const float biased = s.probe.reference[receiver] - bias;
  return !(biased > tap.depth);
}

inline float slope_bias(float slope, float n_dot_l, float floor) {
  const float turned = 1.0f - n_dot_l;
  const float scaled = slope * turned;
  return scaled > floor ? scaled : floor;
}

inline float bias_at(const DepthBias& bias, float n_dot_l) {
  if (bias.form == BiasForm::constant) return bias.constant;
  if (bias.form == BiasForm::slope) return slope_bias(bias.slope, n_dot_l, bias.floor);
  return 0;
}

// The design's table, all of it: [covered][D][V][L].
inline constexpr Cause causes[2][2][2][2] = {
    {{{Cause::none, Cause::coverage_light}, {Cause::none, Cause::coverage_light}},
     {{Cause::coverage_dark, Cause::none}, {Cause::coverage_dark, Cause::none}}},
    {{{Cause::none, Cause::peter_panning}, {Cause::none, Cause::aliasing_light}},
     {{Cause::aliasing_dark, Cause::none}, {Cause::acne, Cause::none}}},
};

inline Cause cause_of(const Tap& tap, bool lit) { return causes[tap.covered][tap.moved_lit][tap.texel_lit][lit]; }

inline float visibility(const Synthetic& s, const Image<float>& map, size_t receiver) {
  int lit = 0;
  for (const Tap& tap : taps_of(s, map, receiver))
    lit += verdict(s, tap, receiver, bias_at(s.bias, s.probe.n_dot_l[receiver]));
  return static_cast<float>(lit) / static_cast<float>(s.kernel * s.kernel);
}

}  // namespace naive

// R4 and R5 as OpenGL would give them for these maps.
inline void set_verdicts(Synthetic& s) {
  s.r4 = s.r5 = Image<float>(s.truth.facing.width, s.truth.facing.height, 0);
  for (size_t i = 0; i < s.r4.size(); ++i) {
    s.r4[i] = naive::visibility(s, s.exact, i);
    s.r5[i] = naive::visibility(s, s.stored, i);
  }
}

}  // namespace noonmark
