// A number and how far the shader's float arithmetic may have it off: forward error analysis, operation by operation,
// of the formulas that GLSL and C++ share.
//
//   Bounded n = rounded(0.1);           // 0.1 in double, u of it in error
//   Bounded product = n * n;            // product.value = 0.01, product.error = what float can be off by
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace noonmark {

// Relative errors. GLSL 4.50, 4.7.1: sums and products are correctly rounded, a division is within 2.5 units in the
// last place of 2 u each, sqrt is 1 / inversesqrt, which is within 2. No factor is added for comfort.
constexpr double float_rounding = 0x1p-24;  // u
constexpr double float_division = 5 * float_rounding;
constexpr double float_square_root = 4 * float_rounding + float_division;

struct Bounded {
  double value = 0, error = 0;
  constexpr Bounded() = default;
  constexpr explicit Bounded(double exact) : value(exact) {}  // a float's value, such as 1
  constexpr Bounded(double v, double e) : value(v), error(e) {}
};

namespace bounded {

// value and the error of the operands, and then one rounding of what was computed.
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
inline Bounded abs(Bounded a) { return {std::abs(a.value), a.error}; }
inline Bounded max(Bounded a, Bounded b) { return {std::max(a.value, b.value), std::max(a.error, b.error)}; }
inline Bounded min(Bounded a, Bounded b) { return {std::min(a.value, b.value), std::max(a.error, b.error)}; }
inline Bounded clamp(Bounded a, Bounded low, Bounded high) { return min(max(a, low), high); }
// Near 0 the root is steeper than any bound, but no farther off than the root of the error.
inline Bounded sqrt(Bounded a) {
  const double root = std::sqrt(std::max(0.0, a.value));
  const double lost = root > 0 ? std::min(std::sqrt(a.error), a.error / root) : std::sqrt(a.error);
  return computed(root, lost, float_square_root);
}

struct vec2 {
  Bounded x, y;
};
struct vec3 {
  Bounded x, y, z;
};
inline vec3 operator+(const vec3& a, const vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline vec3 operator-(const vec3& a, const vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline vec3 operator*(Bounded s, const vec3& v) { return {s * v.x, s * v.y, s * v.z}; }
// In whatever order it is summed: each product may go through both sums.
inline Bounded dot(const vec3& a, const vec3& b) {
  const Bounded x = a.x * b.x, y = a.y * b.y, z = a.z * b.z;
  const double sizes = std::abs(x.value) + std::abs(y.value) + std::abs(z.value);
  const double errors = x.error + y.error + z.error;
  return {x.value + y.value + z.value, errors + 2 * float_rounding * (1 + float_rounding) * (sizes + errors)};
}

}  // namespace bounded
}  // namespace noonmark
