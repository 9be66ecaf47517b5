// How the values of a picture are encoded, by what a shadow's own error cannot change: the exact values that a filter of equal
// taps has (k of n taps are lit), and the ramps of a filter that blends texels, which are straight along a plane.
//
//   const CurveEvidence found = curve_evidence(evidence);
//   if (const ValueCurve* curve = found.by_levels()) print(curve->name);
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "frames/checks.h"

namespace noonmark {

// The functions with which values may be encoded; the first is none.
struct ValueCurve {
  const char* name;
  double (*linear)(double value);  // of an encoded value
};
double linear_of_srgb(double value);  // IEC 61966-2-1
inline constexpr size_t curve_count = 6;
extern const std::array<ValueCurve, curve_count> value_curves;

// How well values are multiples of 1/taps.
struct TapFit {
  int taps = 0;     // 0: they are of no number of taps
  double bits = 0;  // by chance they are with a probability of 2^-bits at most
};

struct CurveEvidence {
  std::vector<double> levels;  // values between 0 and 1 that many pixels share, those of the most pixels first
  std::array<TapFit, curve_count> fits;
  size_t ramps = 0;                            // triples of pixels that tell a straight ramp from a curved one
  std::array<double, curve_count> straight{};  // the share of them that is straight, by curve
  double straight_by_chance = 0;               // the same of a curve that nobody writes
  // The curve that the evidence names, or null where it names none.
  const ValueCurve* by_levels() const;
  const ValueCurve* by_ramps() const;
};
CurveEvidence curve_evidence(const CheckEvidence& evidence);

// Sums of a filter's weights in float are off by a few last places.
inline constexpr double rounding_of_sums = 1e-5;
// What rounding can have done to a value of the picture: half a step of 8 or 16 bits, of a half float, or of a shader's float.
double rounding_of(const Image<float>& visibility);

}  // namespace noonmark
