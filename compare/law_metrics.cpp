#include "compare/law_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "scenes/camera_frame.h"

namespace noonmark {
namespace {

// std::max that keeps a NaN, whichever of the two it is.
void raise(double& value, double candidate) {
  if (!(candidate <= value) && !std::isnan(value)) value = candidate;
}

class Footprints {
 public:
  Footprints(const Camera& camera, const LightFrame& light, const ReceiverImage& receivers)
      : view_(make_camera_frame(camera, receivers.width(), receivers.height())),
        light_(light),
        receivers_(receivers),
        pixel_(4 * view_.half_width * view_.half_height /
               (receivers.width() * static_cast<double>(receivers.height()))) {}

  double area(int x, int y) const {
    const glm::dvec3 normal(receivers_.normal.at(x, y));
    const double to_light = glm::dot(normal, light_.direction_to_light());
    const glm::dvec3 way = view_.pixel_ray(x, y, receivers_.width(), receivers_.height()).direction;
    const double turned = std::abs(glm::dot(normal, way));
    if (view_.camera.projection == Projection::orthographic) return pixel_ / turned * to_light;
    // On the plane at distance 1 the pixel is an area A seen along a ray of length |way|: a solid angle of A / |way|^3.
    // At depth z the ray has come z |way|, and meets the surface at the cosine |N.way| / |way|.
    const double depth = glm::dot(glm::dvec3(receivers_.position.at(x, y)) - view_.eye_m, view_.forward);
    return pixel_ * depth * depth / turned * to_light;
  }

 private:
  CameraFrame view_;
  const LightFrame& light_;
  const ReceiverImage& receivers_;
  double pixel_;  // area of a pixel: perspective, on the plane at distance 1; orthographic, in m2
};

}  // namespace

double depth_quantum_m(DepthFormat format, double range_m) {
  switch (format) {
    case DepthFormat::d16:
      return range_m / 0xffff;
    case DepthFormat::d24:
      return range_m / 0xffffff;
    case DepthFormat::d32f:
      return range_m * 0x1p-24;
  }
  throw std::logic_error("a depth format without a quantum");
}

double gradient_1(const LightFrame& frame, glm::dvec3 normal) {
  // N.x is constant on the plane: dz/du = -N.u / N.forward.
  return (std::abs(glm::dot(normal, frame.right)) + std::abs(glm::dot(normal, frame.up))) /
         std::abs(glm::dot(normal, frame.forward));
}

double light_plane_area(const Camera& camera, const LightFrame& frame, const ReceiverImage& receivers, int x, int y) {
  return Footprints(camera, frame, receivers).area(x, y);
}

std::map<std::string, double> measure_laws(const LawInput& in) {
  const Ladder& ladder = in.ladder;
  const Footprints footprints(in.camera, in.frame, in.receivers);
  const double range_m = in.frame.far_m - in.frame.near_m;
  const double quantum_m = depth_quantum_m(in.format, range_m);
  const auto step = [&](Cause cause, size_t i) {
    return std::abs(static_cast<double>(ladder.step[static_cast<size_t>(cause)][i]));
  };
  double steepest = 0, counted = 0, filter = 0, displacement = 0, aliasing = 0, acne = 0, panning = 0;
  bool any = false;
  for (int y = 0; y < ladder.flags.height; ++y) {
    for (int x = 0; x < ladder.flags.width; ++x) {
      const size_t i = ladder.flags.index(x, y);
      if (!(ladder.flags[i] & flag_facing) || (ladder.flags[i] & flag_ambiguous)) continue;
      any = true;
      if (ladder.rung[1][i] != 0) raise(steepest, gradient_1(in.frame, glm::dvec3(in.receivers.normal[i])));
      const double area = footprints.area(x, y);
      counted += area;
      filter += area * step(Cause::filter, i);
      displacement += area * step(Cause::displacement, i);
      aliasing += area * (step(Cause::aliasing_dark, i) + step(Cause::aliasing_light, i));
      acne += area * step(Cause::acne, i);
      panning += area * step(Cause::peter_panning, i);
    }
  }
  const auto measured = [&](double value) { return any ? value : std::numeric_limits<double>::quiet_NaN(); };
  // Law 1 (kernel reach after Isidoro 2006): the outermost of a box's taps is half its side from the receiver along
  // each axis, its own texel's half included.
  const double law = in.kernel / 2.0 * in.frame.texel_m() * steepest + quantum_m / 2;
  return {{"texel_m", in.frame.texel_m()},
          {"map_range_m", range_m},
          {"depth_quantum_m", quantum_m},
          {"acne_free_bias_law_m", measured(law)},
          {"counted_area_m2", measured(counted)},
          {"filter_area_m2", measured(filter)},
          {"displacement_area_m2", measured(displacement)},
          {"aliasing_area_m2", measured(aliasing)},
          {"acne_area_m2", measured(acne)},
          {"peter_panning_area_m2", measured(panning)}};
}

}  // namespace noonmark
