// The bias at which a tap becomes lit, bit for bit as the shader compares. The functions stand in the header because a
// curve calls them for every tap.
//
// A threshold is a float, because the shader compares floats. The search starts from a guess that is computed in double,
// so that it is only a step or two away.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "compare/ladder/numbers.h"

namespace noonmark {

namespace threshold_search {

// The next float above or below one that is at least 0 and finite; std::nextafter is a call for every tap.
inline float above(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) + 1); }
inline float below(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) - 1); }  // x > 0

// The smallest float >= 0 for which `enough` holds; infinity if there is none. guess: at most a few steps away. enough is
// monotone. The first step is made without a branch, because no processor predicts which of three floats it is.
template <class Enough>
float smallest(float guess, const Enough& enough) {
  if (enough(0.0f)) return 0;
  float value = guess > 0 ? guess : 0;
  while (!enough(value)) {
    value = above(value);
    if (value == infinity_f) return infinity_f;
  }
  for (float less = below(value); less > 0 && enough(less); less = below(value)) value = less;
  return value;
}

}  // namespace threshold_search

// The smallest float bias b >= 0 for which `reference - b > stored` is false in float arithmetic. reference and stored
// are finite. The search starts from (float)(reference - midpoint(stored, next float above)), computed in double, which
// is at most one step away. A search from reference - stored can take millions of steps.
inline float lit_threshold(float reference, float stored) {
  using namespace threshold_search;
  const double midpoint =
      (static_cast<double>(stored) + (stored >= 0 ? above(stored + 0.0f) : std::nextafter(stored, infinity_f))) / 2;
  return smallest(static_cast<float>(reference - midpoint), [&](float bias) { return !(reference - bias > stored); });
}

// The smallest float x >= 0 for which x * factor >= product in float arithmetic; infinity if there is none. factor: not
// NaN. product: not NaN, for instance a lit_threshold. The search starts from the midpoint below product, for the same
// reason: if product is denormal, a search from product / factor can take millions of steps.
inline float factor_threshold(float product, float factor) {
  using namespace threshold_search;
  if (factor == 1) return product > 0 ? product : 0;  // no search needed: a constant bias has this factor
  if (product <= 0) return 0;
  if (!(factor > 0) || product == infinity_f) return infinity_f;
  const double midpoint = (static_cast<double>(product) + below(product)) / 2;
  const double guess = midpoint / factor;
  if (guess > std::numeric_limits<float>::max()) return infinity_f;
  return smallest(static_cast<float>(guess), [&](float x) { return x * factor >= product; });
}

// The smallest float x >= 0 for which addend + x >= sum in float arithmetic; infinity if there is none. addend: finite,
// at least 0. sum: not NaN, for instance a lit_threshold.
inline float addend_threshold(float sum, float addend) {
  using namespace threshold_search;
  if (addend == 0) return sum > 0 ? sum : 0;  // no search needed: the bias has one part, as most biases have
  if (sum == infinity_f) return infinity_f;
  if (addend >= sum) return 0;
  const double midpoint = (static_cast<double>(sum) + below(sum)) / 2;
  return smallest(static_cast<float>(midpoint - addend), [&](float x) { return addend + x >= sum; });
}

}  // namespace noonmark
