// A number with a bound of the error that the shader's float arithmetic makes. The bound is made by forward error
// analysis, operation by operation, of the formulas that GLSL and C++ share.
//
//   Bounded n = rounded(0.1);           // 0.1 in double, with an error of u
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

// The number and its operations stand in one namespace, where the vectors find them.
namespace bounded {

struct Bounded {
  double value = 0, error = 0;
  constexpr Bounded() = default;
  constexpr explicit Bounded(double exact) : value(exact) {}  // a value that float holds exactly, such as 1
  constexpr Bounded(double v, double e) : value(v), error(e) {}
};

// The value with the error that comes from the operands, plus one rounding of the computed value.
inline Bounded computed(double value, double error, double relative) {
  return {value, error + relative * (std::abs(value) + error)};
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

using vec2 = Vector2<Bounded>;
using vec3 = Vector3<Bounded>;
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
