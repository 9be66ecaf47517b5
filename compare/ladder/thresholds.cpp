#include "compare/ladder/thresholds.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace noonmark {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// The next float above or below one that is at least 0 and finite; std::nextafter is a call for every tap.
float above(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) + 1); }
float below(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) - 1); }  // x > 0

// The smallest float >= 0 for which `enough` holds. guess: at most a few steps away. enough is monotone.
template <class Enough>
float smallest(float guess, const Enough& enough) {
  if (enough(0.0f)) return 0;
  float value = guess > 0 ? guess : 0;
  while (!enough(value)) {
    value = above(value);
    if (value == infinity) return infinity;
  }
  for (float less = below(value); less > 0 && enough(less); less = below(value)) value = less;
  return value;
}

}  // namespace

float lit_threshold(float reference, float stored) {
  const double midpoint =
      (static_cast<double>(stored) + (stored >= 0 ? above(stored + 0.0f) : std::nextafter(stored, infinity))) / 2;
  return smallest(static_cast<float>(reference - midpoint), [&](float bias) { return !(reference - bias > stored); });
}

float factor_threshold(float product, float factor) {
  if (product <= 0) return 0;
  if (!(factor > 0) || product == infinity) return infinity;
  const double midpoint = (static_cast<double>(product) + below(product)) / 2;
  const double guess = midpoint / factor;
  if (guess > std::numeric_limits<float>::max()) return infinity;
  return smallest(static_cast<float>(guess), [&](float x) { return x * factor >= product; });
}

float addend_threshold(float sum, float addend) {
  if (sum == infinity) return infinity;
  if (addend >= sum) return 0;
  if (addend == 0) return sum;  // no search needed: the bias has one part, as most biases have
  const double midpoint = (static_cast<double>(sum) + below(sum)) / 2;
  return smallest(static_cast<float>(midpoint - addend), [&](float x) { return addend + x >= sum; });
}

}  // namespace noonmark
