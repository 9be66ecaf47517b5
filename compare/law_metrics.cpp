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

Image<double> light_plane_areas(const Camera& camera, const LightFrame& frame, const ReceiverImage& receivers) {
  const int width = receivers.width(), height = receivers.height();
  const CameraFrame view = make_camera_frame(camera, width, height);
  // Perspective: on the plane at distance 1; orthographic: in m2.
  const double pixel = 4 * view.half_width * view.half_height / (static_cast<double>(width) * height);
  Image<double> areas(width, height, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (receivers.primitive.at(x, y) == no_primitive) continue;
      const glm::dvec3 normal(receivers.normal.at(x, y));
      const double to_light = glm::dot(normal, frame.direction_to_light());
      const glm::dvec3 way = view.pixel_ray(x, y, width, height).direction;
      double area = pixel / std::abs(glm::dot(normal, way)) * to_light;
      // A pixel of area A on the plane at distance 1, seen along a ray of length |way|, is a solid angle of A /
      // |way|^3. At depth z the ray has come z |way|, and meets the surface at the cosine |N.way| / |way|.
      if (camera.projection == Projection::perspective) {
        const double z = glm::dot(glm::dvec3(receivers.position.at(x, y)) - view.eye_m, view.forward);
        area *= z * z;
      }
      areas.at(x, y) = area;
    }
  }
  return areas;
}

std::map<std::string, double> measure_laws(const LawInput& in) {
  const Ladder& ladder = in.ladder;
  const Image<double> areas = light_plane_areas(in.camera, in.frame, in.receivers);
  const double range_m = in.frame.far_m - in.frame.near_m;
  const double quantum_m = depth_quantum_m(in.format, range_m);
  const auto step = [&](Cause cause, size_t i) {
    return std::abs(static_cast<double>(ladder.step[static_cast<size_t>(cause)][i]));
  };
  double steepest = 0, counted = 0, filter = 0, displacement = 0, aliasing = 0, acne = 0, panning = 0;
  bool any = false;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!(ladder.flags[i] & flag_facing) || (ladder.flags[i] & flag_ambiguous)) continue;
    any = true;
    if (ladder.rung[1][i] != 0) raise(steepest, gradient_1(in.frame, glm::dvec3(in.receivers.normal[i])));
    counted += areas[i];
    filter += areas[i] * step(Cause::filter, i);
    displacement += areas[i] * step(Cause::displacement, i);
    aliasing += areas[i] * (step(Cause::aliasing_dark, i) + step(Cause::aliasing_light, i));
    acne += areas[i] * step(Cause::acne, i);
    panning += areas[i] * step(Cause::peter_panning, i);
  }
  // Also what the camera does not see: the way from a receiver to its texel's centre may lead over it.
  double steepest_face = 0;
  for (const glm::uvec3& t : in.scene.triangles) {
    const glm::dvec3 a(in.scene.positions[t.x]), b(in.scene.positions[t.y]), c(in.scene.positions[t.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    // Edge-on faces have no depth of their own in the light's plane; below 1e-9 of a face's size, the double's rounding
    // of float coordinates decides which way it turns.
    if (glm::dot(normal, in.frame.direction_to_light()) > 1e-9 * glm::length(normal))
      raise(steepest_face, gradient_1(in.frame, normal));
  }
  const auto measured = [&](double value) { return any ? value : std::numeric_limits<double>::quiet_NaN(); };
  // Law 1 (kernel reach after Isidoro 2006): the outermost of a box's taps is half its side from the receiver along
  // each axis, its own texel's half included.
  const auto law = [&](double gradient) { return in.kernel / 2.0 * in.frame.texel_m() * gradient + quantum_m / 2; };
  return {{"texel_m", in.frame.texel_m()},
          {"map_range_m", range_m},
          {"depth_quantum_m", quantum_m},
          {"acne_free_bias_law_m", measured(law(steepest))},
          {"acne_free_bias_scene_law_m", law(steepest_face)},
          {"counted_area_m2", measured(counted)},
          {"filter_area_m2", measured(filter)},
          {"displacement_area_m2", measured(displacement)},
          {"aliasing_area_m2", measured(aliasing)},
          {"acne_area_m2", measured(acne)},
          {"peter_panning_area_m2", measured(panning)}};
}

}  // namespace noonmark
