// A number with a bound of the error that the shader's float arithmetic makes. The bound is made by forward error
// analysis, operation by operation, of the formulas that GLSL and C++ share.
//
//   Bounded n = bounded::rounded(0.1);  // 0.1 in double, with an error of u
//   Bounded product = n * n;            // product.value = 0.01, product.error = the bound of the float error
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "technique/formula_vectors.h"

namespace noonmark {

// Relative errors of the operations (GLSL 4.50, 4.7.1). Sums and products are correctly rounded. A division is within
// 2.5 units in the last place, of 2 u each. sqrt is 1 / inversesqrt, and inversesqrt is within 2 units. No safety
// factor is added.
constexpr double float_rounding = 0x1p-24;  // u
constexpr double float_division = 5 * float_rounding;
constexpr double float_square_root = 4 * float_rounding + float_division;
constexpr double float_least_normal = 0x1p-126;

// The number and its operations stand in one namespace, where the vectors find them.
namespace bounded {

struct Bounded {
  double value = 0, error = 0;
  constexpr Bounded() = default;
  constexpr explicit Bounded(double exact) : value(exact) {}  // a value that float holds exactly, such as 1
  constexpr Bounded(double v, double e) : value(v), error(e) {}
};

// A constant that float may have to round.
inline Bounded rounded(double constant) { return {constant, float_rounding * std::abs(constant)}; }

// The value with the error that comes from the operands, plus one rounding of the computed value. A result below the
// least normal float may be flushed to 0 (GLSL 4.50, 4.7.1). 0 times an infinite error has no bound.
inline Bounded computed(double value, double error, double relative) {
  const double rounded = error + relative * (std::abs(value) + error);
  if (std::isnan(rounded)) return {value, HUGE_VAL};
  const bool flushed = value != 0 && std::abs(value) - rounded < float_least_normal;
  return {value, flushed ? rounded + float_least_normal : rounded};
}

inline Bounded operator-(Bounded a) { return {-a.value, a.error}; }
inline Bounded operator+(Bounded a, Bounded b) {
  return computed(a.value + b.value, a.error + b.error, float_rounding);
}
inline Bounded operator-(Bounded a, Bounded b) { return a + -b; }
inline Bounded operator*(Bounded a, Bounded b) {
  return computed(a.value * b.value, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error,
                  float_rounding);
}
// The bound is infinite if the divisor can be 0.
inline Bounded operator/(Bounded a, Bounded b) {
  const double quotient = a.value / b.value, least = std::abs(b.value) - b.error;
  const double lost = least > 0 ? (a.error + std::abs(quotient) * b.error) / least : HUGE_VAL;
  return computed(quotient, lost, float_division);
}
inline Bounded abs(Bounded a) { return {std::abs(a.value), a.error}; }
inline Bounded max(Bounded a, Bounded b) { return {std::max(a.value, b.value), std::max(a.error, b.error)}; }
inline Bounded min(Bounded a, Bounded b) { return {std::min(a.value, b.value), std::max(a.error, b.error)}; }
inline Bounded clamp(Bounded a, Bounded low, Bounded high) { return min(max(a, low), high); }
// Near 0 the slope of the root has no bound, but the error of the root is at most the root of the error.
inline Bounded sqrt(Bounded a) {
  const double root = std::sqrt(std::max(0.0, a.value));
  const double lost = root > 0 ? std::min(std::sqrt(a.error), a.error / root) : std::sqrt(a.error);
  return computed(root, lost, float_square_root);
}

// Within 3 + 2 |x| units in the last place (GLSL 4.50, 4.7.1); a unit is at most 2 u of the value.
inline Bounded exp(Bounded a) {
  const double units = 3 + 2 * (std::abs(a.value) + a.error);
  const double value = std::exp(a.value);
  return computed(value, value * std::expm1(a.error), units * 2 * float_rounding);
}
// yes if a < b, else no. Where the errors leave the order open, the bound holds for both.
inline Bounded where_less(Bounded a, Bounded b, Bounded yes, Bounded no) {
  const bool less = a.value < b.value;
  const Bounded chosen = less ? yes : no, other = less ? no : yes;
  const double unsure = a.error + b.error;
  if (unsure == 0 || std::abs(a.value - b.value) > unsure) return chosen;
  const double farthest = std::abs(other.value - chosen.value) + other.error;
  return {chosen.value, std::max(chosen.error, farthest)};
}

using vec2 = Vector2<Bounded>;
using vec3 = Vector3<Bounded>;
using vec4 = Vector4<Bounded>;
// The order of the sums is not known, so each product may be rounded in both sums.
inline Bounded dot(const vec3& a, const vec3& b) {
  const Bounded x = a.x * b.x, y = a.y * b.y, z = a.z * b.z;
  const double sizes = std::abs(x.value) + std::abs(y.value) + std::abs(z.value);
  const double errors = x.error + y.error + z.error;
  return {x.value + y.value + z.value, errors + 2 * float_rounding * (1 + float_rounding) * (sizes + errors)};
}

}  // namespace bounded

using bounded::Bounded;
}  // namespace noonmark
