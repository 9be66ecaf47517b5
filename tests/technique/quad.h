// Numbers of 113 bits, for a second implementation of a formula.
#pragma once

#include <cmath>

namespace noonmark {

#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;
#else
using Quad = long double;  // of 113 bits where the compiler has no __float128
#endif

inline Quad abs_of(Quad x) { return x < 0 ? -x : x; }

// The root in long double has 64 correct bits. One step of Newton's method doubles them.
inline Quad root_of(Quad x) {
  if (!(x > 0)) return 0;
  Quad root = std::sqrt(static_cast<long double>(x));
  for (int step = 0; step < 2; ++step) root = (root + x / root) / 2;
  return root;
}

// Taylor's series at x / 2^17, squared 17 times. |x|: at most 200.
inline Quad exponential_of(Quad x) {
  const Quad small = x / 131072;
  Quad sum = 1;
  for (int term = 12; term > 0; --term) sum = 1 + sum * small / term;
  for (int twice = 0; twice < 17; ++twice) sum *= sum;
  return sum;
}

}  // namespace noonmark
