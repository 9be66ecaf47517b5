#include "technique/corner_fits.h"

#include <algorithm>
#include <cmath>

#include "technique/light_frame.h"
#include "technique/technique.h"

namespace noonmark {
namespace {

double rounded_up(double half, double step) { return step > 0 ? step * std::ceil(half / step) : half; }

struct Range {
  glm::dvec3 low, high;
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  glm::dvec3 size() const { return high - low; }
};

Range range_of(const SliceCorners& corners) {
  Range range{corners[0], corners[0]};
  for (const glm::dvec3& corner : corners) {
    range.low = glm::min(range.low, corner);
    range.high = glm::max(range.high, corner);
  }
  return range;
}

CornerSquare around_sphere(const SliceCorners& corners, double round_m) {
  glm::dvec3 centre(0);
  for (const glm::dvec3& corner : corners) centre += corner / 8.0;
  double radius = 0;
  for (const glm::dvec3& corner : corners) radius = std::max(radius, glm::distance(corner, centre));
  radius = rounded_up(radius, round_m);
  return {glm::dvec2(centre), radius, centre.z - radius, centre.z + radius};
}

CornerSquare around_diagonals(const SliceCorners& corners, double round_m) {
  const Range range = range_of(corners);
  const double longest = std::max(glm::distance(corners[7], corners[4]), glm::distance(corners[7], corners[0]));
  return {glm::dvec2(range.middle()), rounded_up(longest / 2, round_m), range.low.z, range.high.z};
}

CornerSquare around_box(const SliceCorners& corners, double round_m) {
  const Range range = range_of(corners);
  return {glm::dvec2(range.middle()), rounded_up(std::max(range.size().x, range.size().y) / 2, round_m), range.low.z,
          range.high.z};
}

}  // namespace

SliceCorners corners_of_slice(const CameraFrame& camera, const ViewSlice& slice, const LightFrame& axes) {
  SliceCorners corners;
  for (size_t i = 0; i < corners.size(); ++i) {
    const double depth = i & 4 ? slice.end_m : slice.begin_m;
    const double wide = camera.camera.projection == Projection::perspective ? depth : 1;
    const glm::dvec3 there((i & 1 ? 1 : -1) * camera.half_width * wide, (i & 2 ? 1 : -1) * camera.half_height * wide,
                           depth);
    corners[i] = axes.to_light(camera.to_world(there));
  }
  return corners;
}

std::span<const CornerFit> corner_fits() {
  static const CornerFit all[] = {
      {MapFit::corner_sphere, "corner_sphere",
       "around the sphere about the mean of the slice's eight corners, as Babylon.js's stabilizeCascades and "
       "three.js's "
       "SunLight fit",
       around_sphere},
      {MapFit::corner_square, "corner_square",
       "about the middle of the corners' box in the light's axes, as wide as the slice's longest diagonal, as "
       "three.js's "
       "CSM and Bevy fit",
       around_diagonals},
      {MapFit::corner_box, "corner_box",
       "around the corners' box in the light's axes, as wide as its longer side (Babylon.js without stabilizeCascades "
       "fits the box itself, with oblong texels)",
       around_box},
  };
  return all;
}

const CornerFit* find_corner_fit(MapFit fit) {
  for (const CornerFit& one : corner_fits())
    if (one.fit == fit) return &one;
  return nullptr;
}

}  // namespace noonmark
