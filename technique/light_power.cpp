#include "technique/light_power.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noonmark {
namespace {

double cos_half(double whole_deg) { return std::cos(whole_deg * std::numbers::pi / 360); }

// The square of the part of the way from the outer cone to the inner one, in cosines. Where both are the same the light ends at
// once; the extension's own guard, 0.001, keeps the quotient finite.
double cone_falloff(const Light& light, double cosine) {
  const double outer = cos_half(light.cone_deg), inner = cos_half(std::min(light.power.inner_cone_deg, light.cone_deg));
  const double part = std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
  return part * part;
}

}  // namespace

double illuminance_lux(const Light& light, const LightFrame& frame, glm::dvec3 p, glm::dvec3 normal) {
  const glm::dvec3 to_light = frame.direction_to_light(p);
  const double cosine = glm::dot(normal, to_light);
  if (!(cosine > 0)) return 0;
  if (frame.light().rays().have_one_direction()) return light.power.intensity * cosine;
  const double distance = glm::length(frame.origin_m - p);
  double window = 1;
  if (light.power.range_m) window = std::clamp(1 - std::pow(distance / *light.power.range_m, 4), 0.0, 1.0);
  const double cone = frame.light().has_cone() ? cone_falloff(light, -glm::dot(to_light, frame.forward)) : 1;
  return light.power.intensity * cosine * window * cone / (distance * distance);
}

double luminance(glm::dvec3 rgb) { return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; }

}  // namespace noonmark
