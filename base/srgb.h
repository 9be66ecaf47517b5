// sRGB (IEC 61966-2-1), in which pictures are stored and shown.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace noonmark {

// The 8-bit value of a linear light, where 1 is white. NaN is black.
inline uint8_t srgb_encoded(double linear) {
  const double v = linear > 0 ? std::min(linear, 1.0) : 0;
  return static_cast<uint8_t>(std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
}

// The linear light of an 8-bit value.
inline double srgb_decoded(uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// The pixels of a picture that see no surface.
inline constexpr std::array<uint8_t, 3> background_srgb{30, 32, 38};

}  // namespace noonmark
