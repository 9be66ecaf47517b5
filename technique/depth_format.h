// The depths that a format of a map can hold.
//
//   depth_step(DepthFormat::d16, 0.5f);            // 1 / 65535
//   told_format(depths);                           // d24, of a map that was drawn with 24 bits
#pragma once
#include <optional>
#include <span>

#include "technique/settings.h"

namespace noonmark {

// From this depth in [0,1] to the next one.
double depth_step(DepthFormat format, float depth);

// Whether the float is a depth of the format: k / (2^n - 1), or a neighbouring float, if the driver's conversion rounds.
bool is_held_by(DepthFormat format, float depth);

bool are_held_by(DepthFormat format, std::span<const float> depths);

// The format that the depths of a map are of: the coarsest that can hold them all. Empty: they do not tell. From 1/4 on each
// float is a depth of 24 bits or next to one, so that takes enough nearer depths; and what 24 bits cannot hold is of 32.
std::optional<DepthFormat> told_format(std::span<const float> depths);

}  // namespace noonmark
