#include "compare/ladder/law_bias.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

bool capped(const LookupProbe& probe) {
  return probe.tap_reference->reads_cap && probe.plane_cap < std::numeric_limits<float>::max();
}

// NaN if each tap has to be computed by itself: the taps do not form a square, or a cap keeps the references of distant
// taps away from their plane.
double reach(const LookupProbe& probe) {
  if (probe.tap_reference->at_texel) return 0;
  if (probe.tap_reference->plane) return capped(probe) ? std::numeric_limits<double>::quiet_NaN() : 0.5;
  const double k = probe.pattern.reach_texels();
  const auto corner = [&](const glm::vec3& o) { return std::abs(o.x) == k - 0.5 && std::abs(o.y) == k - 0.5; };
  const auto& offsets = probe.pattern.offsets;
  const bool square = std::count_if(offsets.begin(), offsets.end(), corner) == (k == 0.5 ? 1 : 4);
  return square ? k : std::numeric_limits<double>::quiet_NaN();
}

// The rise of the plane towards the light up to the furthest of these taps, and half a texel more. carried: the most,
// in window depth, that the reference follows the plane.
double need_of(std::span<const glm::vec3> offsets, glm::dvec2 g, double carried = 0) {
  double rise = 0;
  for (const glm::vec3& o : offsets) rise = std::max(rise, -glm::dot(glm::dvec2(o), g));
  return std::max(0.0, rise - carried) + (std::abs(g.x) + std::abs(g.y)) / 2;
}

// The least distance of the plane n.x = h (h > 0) along the directions of a square on a cube's face.
double least_distance(glm::dvec3 n, double h, const MapTile& face, glm::dvec2 low, glm::dvec2 high) {
  double least = infinity;
  const auto along = [&](glm::dvec3 c) {
    const double ahead = glm::dot(n, c);
    if (ahead > 0) least = std::min(least, h * glm::length(c) / ahead);
  };
  const auto corner = [&](double s, double t) { return face.forward + s * face.right + t * face.up; };
  const glm::dvec3 corners[4] = {corner(low.x, low.y), corner(high.x, low.y), corner(high.x, high.y),
                                 corner(low.x, high.y)};
  for (int side = 0; side < 4; ++side) {
    const glm::dvec3 a = corners[side], b = corners[(side + 1) % 4] - a;
    along(a);
    // The solution of d(|c| / n.c) = 0 on c = a + x b. Its terms in x^2 cancel.
    const double x = (glm::dot(a, a) * glm::dot(n, b) - glm::dot(a, b) * glm::dot(n, a)) /
                     (glm::dot(b, b) * glm::dot(n, a) - glm::dot(a, b) * glm::dot(n, b));
    if (x > 0 && x < 1) along(a + x * b);
  }
  const double ahead = glm::dot(n, face.forward);
  const glm::dvec2 foot = glm::dvec2(glm::dot(n, face.right), glm::dot(n, face.up)) / ahead;
  if (ahead > 0 && foot.x >= low.x && foot.x <= high.x && foot.y >= low.y && foot.y <= high.y)
    least = std::min(least, h / glm::length(n));
  return least;
}

}  // namespace

glm::dvec2 depth_gradient(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) {
  const glm::dvec2 across(glm::dot(normal, frame.right), glm::dot(normal, frame.up));
  const glm::dvec3 light = frame.to_light(position);
  const MapTile tile = frame.tile_at(light);
  const double range = tile.far_m - tile.near_m;
  if (tile.orthographic) return -across / glm::dot(normal, frame.forward) * (tile.texel_m(light) / range);
  const double h = glm::dot(normal, position - frame.origin_m);
  return -across / h * (tile.far_m * tile.near_m / range * 2 * tile.half / tile.resolution);
}

AcneLaw::AcneLaw(const LightFrame& frame, const LookupProbe& probe)
    : frame_(frame), probe_(probe), reach_texels_(reach(probe)) {
  const TapPattern& pattern = probe.pattern;
  if (!pattern.in_world) return;
  for (const glm::vec3& o : pattern.offsets)
    longest_offset_m_ = std::max(longest_offset_m_, glm::length(glm::dvec3(o)));
  if (pattern.scaled_by_view) {
    float largest = 0;
    for (float radius : probe.radius.pixels) largest = std::max(largest, radius);
    longest_offset_m_ *= largest;
  }
}

double AcneLaw::at(size_t i, glm::dvec3 position, glm::dvec3 normal) const {
  if (frame_.map_shape() == MapShape::cube) return cube_need(i, position, normal);
  if (reach_texels_ == 0) return 0;  // also if the light sees the plane edge on
  const glm::dvec2 g = depth_gradient(frame_, position, normal);
  if (!std::isnan(reach_texels_)) return reach_texels_ * (std::abs(g.x) + std::abs(g.y));
  const TapPattern& pattern = probe_.pattern;
  const auto taps = static_cast<size_t>(pattern.taps);
  const auto variant = static_cast<size_t>(tap_variant(static_cast<uint32_t>(i), pattern.variants));
  const double carried = capped(probe_) ? static_cast<double>(probe_.plane_cap) * probe_.bias_unit[i] : 0;
  return need_of(std::span(pattern.offsets).subspan(variant * taps, taps), g, carried);
}

double AcneLaw::cube_need(size_t i, glm::dvec3 position, glm::dvec3 normal) const {
  const glm::dvec3 p = frame_.to_light(position);
  const double h = -glm::dot(normal, p);              // the side that faces the light has n.P < 0
  if (!(h > 0)) return std::isnan(h) ? h : infinity;  // seen edge on
  const double half = 1.0 / frame_.resolution;        // half a texel on the face at distance 1
  double need = 0;
  for (int t = 0; t < probe_.taps(); ++t) {
    const glm::dvec3 place = frame_.tap_place(p, glm::dvec3(probe_.offset(i, t)));
    const MapTile face = frame_.tile_at(place);
    const glm::dvec2 at =
        glm::dvec2(glm::dot(place, face.right), glm::dot(place, face.up)) / glm::dot(place, face.forward);
    // The centres of a face's texels end half a texel before its edge.
    const glm::dvec2 low = glm::clamp(at - half, half - 1, 1 - half), high = glm::clamp(at + half, half - 1, 1 - half);
    need = std::max(need, glm::length(p) - least_distance(-normal, h, face, low, high));
  }
  return need * frame_.window_depth_slope(p);
}

double AcneLaw::of_face(const glm::dvec3 (&corners)[3], glm::dvec3 normal) const {
  if (frame_.map_shape() == MapShape::flat) {
    if (!std::isnan(reach_texels_)) return at(0, corners[0], normal);
    return need_of(probe_.pattern.offsets, depth_gradient(frame_, corners[0], normal));
  }
  double farthest = 0;
  for (const glm::dvec3& corner : corners) farthest = std::max(farthest, glm::length(frame_.to_light(corner)));
  const double h = -glm::dot(glm::normalize(normal), frame_.to_light(corners[0]));
  if (!(h > 0)) return std::isnan(h) ? h : infinity;
  const double turned =
      std::asin(std::min(1.0, longest_offset_m_ / farthest)) + std::numbers::sqrt2 / frame_.resolution;
  const double angle = std::acos(std::min(1.0, h / farthest)) - turned;
  return (farthest - h / std::cos(std::max(0.0, angle))) *
         frame_.tile_at(frame_.to_light(corners[0])).window_depth_slope(farthest);
}

}  // namespace noonmark
