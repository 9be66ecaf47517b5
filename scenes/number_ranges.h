// The ranges of numbers that stand in more than one place: settings, the frame of another renderer, scene files.
#pragma once
#include <glm/glm.hpp>
#include <limits>

namespace noonmark {

// Inclusive limits. NaN is in no range.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool holds(double value) const { return value >= least && value <= most; }
};

namespace ranges {

// A coordinate of anything in the world, in metres. Floats are 64 m apart at its end, so a scene has no use for more. The
// fourth power of such a number is a float still, and Embree's asserts, which end the program, begin at 1.8e18.
inline constexpr NumberRange coordinate_m{-1e9, 1e9};
// A width or a distance that may not be 0.
inline constexpr NumberRange length_m{1e-6, coordinate_m.most};
// No two places of a scene are further apart.
inline constexpr double most_distance_m = 4 * coordinate_m.most;
// A part of a direction of any length, or of a rotation in each frame: the axis times the angle.
inline constexpr NumberRange of_direction{-1e9, 1e9};
inline constexpr NumberRange of_rotation_deg{-360, 360};
// The whole angle of a perspective camera of a file. For narrower or wider ones, the tangent of half the angle cannot be
// used to divide or to multiply.
inline constexpr NumberRange view_angle_rad{1e-4, 3.1415};
// The whole angle of a spot light's cone; a shadow map covers less.
inline constexpr NumberRange cone_deg{1e-3, 180};
// The whole angle of a spot light whose cone a shadow map covers.
inline constexpr NumberRange mapped_cone_deg{1, 170};

}  // namespace ranges

// Whether all three coordinates are in their range.
inline bool is_in_world(glm::dvec3 place_m) {
  return ranges::coordinate_m.holds(place_m.x) && ranges::coordinate_m.holds(place_m.y) &&
         ranges::coordinate_m.holds(place_m.z);
}
// Whether the vector can be normalised: the square of its length is a number of full precision.
inline bool has_direction(glm::dvec3 way) {
  const double square = glm::dot(way, way);
  return square >= std::numeric_limits<double>::min() && square <= std::numeric_limits<double>::max();
}

}  // namespace noonmark
