// A number that counts the operations it goes through. With it the formulas that GLSL and C++ share are asked what they
// cost (technique/cost.h), so no count is written by hand.
//
//   int operations = 0;
//   Counted n = Counted::input(&operations);
//   Counted product = n * n;    // operations is 1
//
// An addition, a product, a division, a root, an exponential, a minimum, a maximum and a choice count 1 each. A change of sign and an absolute
// value count nothing, because a GPU does them with the operand of another operation. An operation on constants alone
// counts nothing, because a compiler does it.
#pragma once
#include "technique/formula_vectors.h"

namespace noonmark {

// The number and its operations stand in one namespace, where the vectors find them.
namespace counting {

struct Counted {
  int* count = nullptr;  // null: a constant
  constexpr Counted() = default;
  constexpr explicit Counted(double /*constant*/) {}
  static constexpr Counted input(int* counter) {
    Counted made;
    made.count = counter;
    return made;
  }
};

inline Counted rounded(double constant) { return Counted(constant); }

inline Counted done(Counted a, Counted b) {
  int* const count = a.count ? a.count : b.count;
  if (count) ++*count;
  return Counted::input(count);
}
inline Counted operator-(Counted a) { return a; }
inline Counted operator+(Counted a, Counted b) { return done(a, b); }
inline Counted operator-(Counted a, Counted b) { return done(a, b); }
inline Counted operator*(Counted a, Counted b) { return done(a, b); }
inline Counted operator/(Counted a, Counted b) { return done(a, b); }
inline Counted abs(Counted a) { return a; }
inline int abs(int a) { return a < 0 ? -a : a; }
inline Counted min(Counted a, Counted b) { return done(a, b); }
inline Counted max(Counted a, Counted b) { return done(a, b); }
inline Counted clamp(Counted a, Counted low, Counted high) { return min(max(a, low), high); }
inline Counted sqrt(Counted a) { return done(a, a); }
inline Counted exp(Counted a) { return done(a, a); }
// The choices are computed before one of them is taken, so the result depends on all four.
inline Counted where_less(Counted a, Counted b, Counted yes, Counted no) {
  Counted both = a.count ? a : b;
  if (!both.count) both = yes.count ? yes : no;
  return done(both, both);
}

using vec2 = Vector2<Counted>;
using vec3 = Vector3<Counted>;
using vec4 = Vector4<Counted>;
inline Counted dot(const vec3& a, const vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace counting

using counting::Counted;
}  // namespace noonmark
