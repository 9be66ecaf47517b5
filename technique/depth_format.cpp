#include "technique/depth_format.h"

#include <algorithm>
#include <cmath>

namespace noonmark {
namespace {

// Below 1/8 at most 3 of 8 floats are a depth of 24 bits or next to one, so that many are no chance.
constexpr std::ptrdiff_t enough = 100;

double steps_of(DepthFormat format) { return format == DepthFormat::d16 ? 65535 : 16777215; }

}  // namespace

double depth_step(DepthFormat format, float depth) {
  if (format != DepthFormat::d32f) return 1 / steps_of(format);
  return static_cast<double>(std::nextafter(depth, 2.0f)) - depth;
}

bool is_held_by(DepthFormat format, float depth) {
  if (format == DepthFormat::d32f) return true;
  const double steps = steps_of(format);
  const float nearest = static_cast<float>(std::round(depth * steps) / steps);
  return std::abs(nearest - depth) <= std::nextafter(depth, 2.0f) - depth;
}

bool are_held_by(DepthFormat format, std::span<const float> depths) {
  return std::all_of(depths.begin(), depths.end(), [&](float depth) { return is_held_by(format, depth); });
}

std::optional<DepthFormat> told_format(std::span<const float> depths) {
  if (are_held_by(DepthFormat::d16, depths)) return DepthFormat::d16;
  if (!are_held_by(DepthFormat::d24, depths)) return DepthFormat::d32f;
  const auto tells = [](float depth) { return depth > 0 && depth < 0.125f; };
  if (std::count_if(depths.begin(), depths.end(), tells) >= enough) return DepthFormat::d24;
  return std::nullopt;
}

}  // namespace noonmark
