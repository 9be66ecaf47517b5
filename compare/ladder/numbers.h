#pragma once

#include <cmath>
#include <limits>

// Values and functions of numbers that several files of compare need.
namespace noonmark {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr float infinity_f = std::numeric_limits<float>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// std::max that keeps a NaN, whichever value it is.
inline void raise(double& value, double candidate) {
  if (!(candidate <= value) && !std::isnan(value)) value = candidate;
}

}  // namespace noonmark
