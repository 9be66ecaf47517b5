#include "technique/light_rays.h"

#include "technique/light_frame.h"

namespace noonmark {
namespace {

constexpr double face_margin = 1e-3;  // how far the chart of a cube's face reaches into its neighbours

// A direction, or a point, in the axes of a face: s, t and the way out.
glm::dvec3 in_face(int face, glm::dvec3 p) {
  const CubeFace& f = cube_face(face);
  return {glm::dot(p, f.right), glm::dot(p, f.up), glm::dot(p, f.forward)};
}

// The part of the segment that the face sees, margin included; false where there is none. It ends before the light.
bool clip_to_face(glm::dvec3& a, glm::dvec3& b) {
  double begin = 0, end = 1;
  for (int side = 0; side < 4; ++side) {
    const auto inside = [&](glm::dvec3 p) {
      return (1 + face_margin) * p.z + (side % 2 ? -1.0 : 1.0) * (side < 2 ? p.x : p.y);
    };
    const double at_a = inside(a), at_b = inside(b);
    if (at_a < 0 && at_b < 0) return false;
    if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
    if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
  }
  if (!(begin <= end)) return false;
  const glm::dvec3 way = b - a;
  b = a + end * way;
  a = a + begin * way;
  return a.z > 0 && b.z > 0;
}

}  // namespace

int LightRays::chart_of(glm::dvec3 x, glm::dvec2& at) const {
  if (parallel_) {
    at = glm::dvec2(x);
    return 0;
  }
  const int face = cube_face_of(x);
  const glm::dvec3 p = in_face(face, x);
  at = glm::dvec2(p) / p.z;
  return face;
}

std::optional<double> LightRays::chart_half() const {
  return parallel_ ? std::nullopt : std::optional(1 + 2 * face_margin);
}

std::optional<LightRays::ChartSegment> LightRays::in_chart(int chart, glm::dvec3 a, glm::dvec3 b,
                                                           double reach_m) const {
  if (parallel_) return ChartSegment{glm::dvec2(a), glm::dvec2(b), reach_m};
  a = in_face(chart, a);
  b = in_face(chart, b);
  if (!clip_to_face(a, b)) return std::nullopt;
  // A metre across the ray moves its place in the face by at most sqrt(3) / z. More than the whole face is not needed.
  return ChartSegment{glm::dvec2(a) / a.z, glm::dvec2(b) / b.z, std::min(2 * reach_m / std::min(a.z, b.z), 4.0)};
}

}  // namespace noonmark
