#include "technique/sun.h"

#include <cmath>

namespace noonmark {
namespace {

// The angle is reduced in degrees, where a right angle is exact, and the cosine stands where it is flat. So multiples
// of 90 degrees give exactly 0, 1 and -1; std::sin of a float multiple of pi does not.
double sine_of_deg(double deg) {
  double reduced = std::remainder(deg, 360);
  if (std::abs(reduced) > 90) reduced = std::copysign(180, reduced) - reduced;
  if (std::abs(reduced) <= 45) return std::sin(glm::radians(reduced));
  return std::copysign(std::cos(glm::radians(90 - std::abs(reduced))), reduced);
}

double cosine_of_deg(double deg) { return sine_of_deg(90 - std::abs(deg)); }

}  // namespace

glm::dvec3 direction_to_sun(const SunPlace& sun) {
  const double level = cosine_of_deg(sun.elevation_deg);
  return {level * sine_of_deg(sun.azimuth_deg), sine_of_deg(sun.elevation_deg), level * cosine_of_deg(sun.azimuth_deg)};
}

SunPlace place_of_sun(const glm::dvec3& direction) {
  const double level = std::hypot(direction.x, direction.z);
  return {level > 0 ? glm::degrees(std::atan2(direction.x, direction.z)) : 0,
          glm::degrees(std::atan2(direction.y, level))};
}

}  // namespace noonmark
