// The geometry of a light's rays: they are parallel, or they come from one point. Each function here has one branch for
// the two cases, so that other files seldom need to ask. Those that do ask what follows from the case: whether the rays
// start at the light, or have one direction. KindOfLight::rays() says which case a kind of light is.
//
// Points are in the light's frame. Places are normalised: (u, v, 1) for parallel rays; (x / z, y / z, 1) or a unit
// vector for rays from one point (technique/light_frame.h).
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <optional>

namespace noonmark {

class LightRays {
 public:
  enum Shape { parallel, from_one_point };
  constexpr LightRays(Shape shape) : parallel_(shape == parallel) {}

  // True if the rays start at the origin of the light's frame, so that the light itself is a point of the scene.
  bool start_at_light() const { return !parallel_; }
  // True if the direction to the light is the same at every point.
  bool have_one_direction() const { return parallel_; }

  // Positive if three points of the light's frame, or three places, run counter-clockwise as the light sees them, in
  // the map's u and v. The value is twice the area of their triangle for parallel rays and the determinant of their
  // directions otherwise, so only the sign can be compared between lights.
  double orientation(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b) const {
    if (parallel_) return (a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x);
    return glm::dot(p, glm::cross(a - p, b - p));
  }

  // The sign says which side of the plane through a with this normal the light sees: negative if the normal points to
  // the light.
  double facing_away(glm::dvec3 normal, glm::dvec3 a) const { return parallel_ ? normal.z : glm::dot(normal, a); }
  // Whether the light sees that plane from the side, within double's rounding of a direction and of corners (2^-53
  // each, with a large margin, because double cannot tell a point inside so thin a triangle).
  bool edge_on(glm::dvec3 normal, glm::dvec3 a) const {
    const double length = parallel_ ? glm::length(normal) : glm::length(normal) * glm::length(a);
    return !(std::abs(facing_away(normal, a)) > 0x1p-30 * length);
  }
  // How much deeper that plane becomes for a metre across the ray through place x. gradient: for parallel rays the
  // plane's dz/d(u, v), and `steepness` its length.
  double slope(glm::dvec3 normal, double steepness, glm::dvec3 x) const {
    return parallel_ ? steepness : glm::length(glm::cross(normal, x)) / std::abs(glm::dot(normal, x));
  }
  // The depth at which the ray through place x meets that plane; infinity if it does not.
  double plane_depth(glm::dvec3 normal, glm::dvec2 gradient, glm::dvec3 a, glm::dvec3 x) const {
    if (parallel_) return a.z + glm::dot(gradient, glm::dvec2(x) - glm::dvec2(a));
    const double along = glm::dot(normal, a) / glm::dot(normal, x);  // x is normal: its own depth is 1
    return along < 0 ? std::numeric_limits<double>::infinity() : along;
  }
  glm::dvec3 at_depth(glm::dvec3 x, double depth) const { return parallel_ ? glm::dvec3(x.x, x.y, depth) : x * depth; }
  // A point of the light's frame as a place of any length.
  glm::dvec3 as_place(glm::dvec3 p) const { return parallel_ ? glm::dvec3(p.x, p.y, 1) : p; }
  // A function of the place (x, y, 1), as a dot product, that grows as the plane through a comes nearer to the light:
  // minus the depth for parallel rays, and one over the depth otherwise. is_ahead: of its value, that the ray meets the
  // plane at all.
  glm::dvec3 nearness(glm::dvec3 normal, glm::dvec2 gradient, glm::dvec3 a) const {
    if (parallel_) return {-gradient.x, -gradient.y, glm::dot(gradient, glm::dvec2(a)) - a.z};
    return normal / glm::dot(normal, a);
  }
  bool is_ahead(double nearness) const { return parallel_ || nearness > 0; }
  // Metres across the rays for a step of 1 between places, at this depth.
  double metres_across(double depth_m) const { return parallel_ ? 1 : depth_m; }
  // Of a place on one side of all three edges of a triangle: whether its ray meets the triangle before the light, not
  // behind it. left: the place lies to the left of the edges. turned_left: so does the triangle itself.
  bool ahead(bool left, bool turned_left) const { return parallel_ || left == turned_left; }

  // The distance across the rays from the ray through place x to the segment from a to b, squared; infinity if the
  // nearest point of the segment lies on the other side of the light.
  double distance2_across(glm::dvec3 x, glm::dvec3 a, glm::dvec3 b) const {
    glm::dvec3 start = a - x, way = b - a, along_ray(0, 0, 1);
    if (parallel_) {
      start.z = way.z = 0;
    } else {
      along_ray = glm::normalize(x);
      const auto across = [&](glm::dvec3 v) { return v - glm::dot(v, along_ray) * along_ray; };
      start = across(a);
      way = across(way);
    }
    const double length2 = glm::dot(way, way);
    const double along = length2 > 0 ? std::clamp(-glm::dot(start, way) / length2, 0.0, 1.0) : 0;
    if (!parallel_ && !(glm::dot(a + along * (b - a), along_ray) > 0)) return std::numeric_limits<double>::infinity();
    const glm::dvec3 beside = start + along * way;
    return glm::dot(beside, beside);
  }

  // Where the straight way between two places crosses an edge. where: the point of the edge at which it does.
  struct Crossing {
    double t = 0;     // fraction of the way; outside [0, 1] or NaN if they do not cross
    double sine = 1;  // of the angle between the way and the edge
  };
  Crossing crossing(glm::dvec3 from, glm::dvec3 to, glm::dvec3 a, glm::dvec3 b, glm::dvec3 where) const {
    const glm::dvec3 way = to - from;
    if (parallel_) {
      const glm::dvec2 along = glm::dvec2(b) - glm::dvec2(a);
      const double length2 = glm::dot(glm::dvec2(way), glm::dvec2(way));
      const double turned = orientation(from, to, a) - orientation(from, to, b);
      return {glm::dot(glm::dvec2(where) - glm::dvec2(from), glm::dvec2(way)) / length2,
              std::abs(turned) / std::sqrt(length2 * glm::dot(along, along))};
    }
    const glm::dvec3 edge_plane = glm::cross(a, b - a), way_plane = glm::cross(from, way);
    const double t = glm::dot(edge_plane, from) / -glm::dot(edge_plane, way);
    if (!(glm::dot(where, from + t * way) > 0)) return {std::numeric_limits<double>::quiet_NaN(), 0};  // behind
    return {t, glm::length(glm::cross(edge_plane, way_plane)) / (glm::length(edge_plane) * glm::length(way_plane))};
  }

  // How much further along the ray of a receiver a plane through it can lie, `across` metres beside that ray. cosine: of
  // the angle between the ray and the plane's normal; distance_m: from the light. Infinity if a spreading ray may run
  // along the plane.
  double rise_m(double across, double cosine, double distance_m) const {
    if (parallel_) return across * std::sqrt(1 - cosine * cosine) / cosine;
    // The plane stands at the angle theta to the receiver's ray. A ray at `angle` to that ray meets the plane at the
    // distance |P| cos(theta) / cos(theta + angle), or never if it is parallel to the plane.
    const double turned = std::acos(cosine) + std::asin(std::min(1.0, across / distance_m));
    return turned < std::numbers::pi / 2 ? distance_m * (cosine / std::cos(turned) - 1)
                                         : std::numeric_limits<double>::infinity();
  }

  // ---- charts: planes on which each place is a point and each way between places is straight. Parallel rays have one,
  // the light's plane. Rays from one point have six, the faces of a cube around the light.

  int charts() const { return parallel_ ? 1 : 6; }
  // The chart of place x; at: where x lies in it.
  int chart_of(glm::dvec3 x, glm::dvec2& at) const;
  // Half the side of a chart that is a square around 0; no value for a plane without bounds.
  std::optional<double> chart_half() const;
  // The part of the segment between two points of the light's frame that a chart shows. A chart that has bounds reaches a
  // little into its neighbours.
  struct ChartSegment {
    glm::dvec2 a{0}, b{0};
    double reach =
        0;  // at most so far a place in the chart moves if a point of the segment moves reach_m across its ray
  };
  std::optional<ChartSegment> in_chart(int chart, glm::dvec3 a, glm::dvec3 b, double reach_m) const;

 private:
  bool parallel_;
};

}  // namespace noonmark
