// The place of a sun in the sky, in degrees, and the direction to it. The frame is glTF's: +Y is up, a model's front
// faces +Z.
//
//   glm::dvec3 l = direction_to_sun({.azimuth_deg = 90, .elevation_deg = 0});   // {1, 0, 0}: above +X, at the horizon
#pragma once
#include <glm/glm.hpp>

namespace noonmark {

// Azimuth: the side on which the sun stands, 0 above +Z, 90 above +X, as a rotation about +Y turns it. Elevation: the
// angle above the horizon, the plane of X and Z, -90 ... 90.
struct SunPlace {
  double azimuth_deg = 0;
  double elevation_deg = 90;
};

// From the scene to the sun, a unit vector in double. Components that are 0 or 1 at a multiple of 90 degrees are
// exactly that, so that a sun overhead is exactly along +Y.
glm::dvec3 direction_to_sun(const SunPlace& sun);

// Its inverse, for a direction of any length but 0. The azimuth is in (-180, 180]; of a vertical direction it is 0.
SunPlace place_of_sun(const glm::dvec3& direction);

}  // namespace noonmark
