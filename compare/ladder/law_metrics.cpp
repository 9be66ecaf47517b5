#include "compare/ladder/law_metrics.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "compare/ladder/law_bias.h"
#include "compare/ladder/numbers.h"
#include "compare/ladder/step_blocks.h"
#include "scenes/camera_frame.h"

namespace noonmark {
namespace {

// A step of window depth in metres, at the near or the far plane of the tile where it is the largest.
double quantum_m(const LightFrame& frame, double quantum, double MapTile::*plane) {
  double largest = 0;
  for (int index = 0; index < frame.tiles; ++index) {
    const MapTile tile = frame.tile(index);
    raise(largest, quantum / tile.window_depth_slope(tile.*plane));
  }
  return largest;
}

struct Over {
  uint64_t counted = 0;
  double law_depth = 0, law_m = 0, quantum_m = 0;
  double whole_area = 0;
  std::array<double, compared_cause_count> area{};
};

// The maxima of law 1 are computed on all cores, apart from the sums: under a point light each receiver evaluates the
// law for every tap.
Over over_receivers(const LawInput& in, const AcneLaw& law, const Image<double>& areas, double quantum) {
  Over over = tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, in.ladder.flags.size(), 8192), Over{},
      [&](const tbb::blocked_range<size_t>& range, Over so_far) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
          if (!is_counted(in.ladder, i)) continue;
          ++so_far.counted;
          const glm::dvec3 p(in.receivers.position[i]);
          const double slope = in.frame.window_depth_slope(in.frame.to_light(p));
          raise(so_far.quantum_m, quantum / slope);
          if (in.ladder.truth()[i] == 0) continue;
          const double bias = law.at(i, p, in.receivers.normal[i]) + quantum / 2;
          raise(so_far.law_depth, bias);
          raise(so_far.law_m, bias / slope);
        }
        return so_far;
      },
      [](Over a, const Over& b) {
        a.counted += b.counted;
        raise(a.law_depth, b.law_depth);
        raise(a.law_m, b.law_m);
        raise(a.quantum_m, b.quantum_m);
        return a;
      });
  // A law requires at least half a quantum, even if nothing is lit.
  raise(over.law_depth, quantum / 2);
  raise(over.law_m, quantum_m(in.frame, quantum / 2, &MapTile::near_m));
  for (size_t i = 0; i < in.ladder.flags.size(); ++i) {  // in the picture's order: the sums are the same on any machine
    if (is_counted(in.ladder, i)) over.whole_area += areas[i];
  }
  const auto add = [&](size_t c, size_t i) {
    if (is_counted(in.ladder, i)) over.area[c] += areas[i] * std::abs(static_cast<double>(in.ladder.causes[c].step[i]));
  };
  const StepBlocks steps(in.ladder);
  for (size_t c = 0; c < over.area.size(); ++c)
    if (std::isfinite(over.whole_area))
      steps.each(c, [&](size_t i) { add(c, i); });
    else  // an area that is not finite is not lost in a step of 0
      for (size_t i = 0; i < in.ladder.flags.size(); ++i) add(c, i);
  return over;
}

// Includes triangles that the camera does not see, because they can lie between a receiver and its texel's centre.
Over over_faces(const LawInput& in, const AcneLaw& law, double quantum) {
  Over over;
  over.law_depth = quantum / 2;
  over.law_m = quantum_m(in.frame, quantum / 2, &MapTile::near_m);
  for (const glm::uvec3& t : in.scene.triangles) {
    const glm::dvec3 corners[3] = {in.scene.positions[t.x], in.scene.positions[t.y], in.scene.positions[t.z]};
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    // Edge-on faces have no depth of their own in the light's plane. Below 1e-9 of a face's size, double's rounding of
    // the float coordinates decides which way the face turns.
    if (!(glm::dot(normal, in.frame.direction_to_light(corners[0])) > 1e-9 * glm::length(normal)) ||
        in.frame.light().misses(in.frame, corners))
      continue;
    // The least of the slopes is at the corner farthest from the light.
    double slope = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& corner : corners)
      slope = std::min(slope, in.frame.window_depth_slope(in.frame.to_light(corner)));
    const double bias = law.of_face(corners, normal) + quantum / 2;
    raise(over.law_depth, bias);
    raise(over.law_m, bias / slope);
  }
  return over;
}

// The median over the counted receivers. NaN if there are none.
double median_texel_m(const LawInput& in) {
  std::vector<double> sizes;
  for (size_t i = 0; i < in.ladder.flags.size(); ++i)
    if (is_counted(in.ladder, i)) sizes.push_back(in.frame.texel_m(in.frame.to_light(in.receivers.position[i])));
  if (sizes.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace

double depth_quantum(DepthFormat format) {
  switch (format) {
    case DepthFormat::d16:
      return 1.0 / 0xffff;
    case DepthFormat::d24:
      return 1.0 / 0xffffff;
    case DepthFormat::d32f:
      return 0x1p-24;
  }
  throw std::logic_error("a depth format without a quantum");
}

Image<double> light_plane_areas(const Camera& camera, const LightFrame& frame, const ReceiverImage& receivers) {
  const int width = receivers.width(), height = receivers.height();
  const CameraFrame view = make_camera_frame(camera, width, height);
  // Perspective: the area on the plane at distance 1. Orthographic: the area in m2.
  const double pixel = 4 * view.half_width * view.half_height / (static_cast<double>(width) * height);
  const PixelRays rays(view, width, height);
  Image<double> areas(width, height, 0);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      if (receivers.primitive.at(x, y) == no_primitive) continue;
      const glm::dvec3 normal(receivers.normal.at(x, y));
      const double to_light = glm::dot(normal, frame.direction_to_light(receivers.position.at(x, y)));
      const glm::dvec3 way = rays.at(x, y).direction;
      double area = pixel / std::abs(glm::dot(normal, way)) * to_light;
      // A pixel of area A on the plane at distance 1, seen along a ray of length |way|, has the solid angle A /
      // |way|^3. At depth z the ray has the length z |way|, and it meets the surface at the cosine |N.way| / |way|.
      if (camera.projection == Projection::perspective) {
        const double z = glm::dot(glm::dvec3(receivers.position.at(x, y)) - view.eye_m, view.forward);
        area *= z * z;
      }
      areas.at(x, y) = area;
    }
  });
  return areas;
}

std::map<std::string, double> measure_laws(const LawInput& in) {
  const Image<double> areas = light_plane_areas(in.camera, in.frame, in.receivers);
  const double quantum = depth_quantum(in.format);
  const AcneLaw law(in.frame, in.probe);
  const Over receivers = over_receivers(in, law, areas, quantum);
  const Over faces = over_faces(in, law, quantum);
  const auto measured = [&](double value) {
    return receivers.counted == 0 ? std::numeric_limits<double>::quiet_NaN() : value;
  };
  const auto area = [&](Cause cause) { return measured(receivers.area[static_cast<size_t>(cause)]); };
  const double range_m = in.frame.far_m - in.frame.near_m;
  const double quantum_there = in.frame.has_depth(TileDepth::perspective)
                                   ? measured(receivers.quantum_m)
                                   : quantum_m(in.frame, quantum, &MapTile::far_m);
  std::map<std::string, double> metrics = {
      {"texel_m", in.frame.uniform() ? in.frame.texel_m(glm::dvec3(0)) : median_texel_m(in)},
      {"map_range_m", range_m},
      {"depth_quantum_m", quantum_there},
      {"counted_area_m2", measured(receivers.whole_area)},
      {"filter_area_m2", area(Cause::filter)},
      {"displacement_area_m2", area(Cause::displacement)},
      {"aliasing_area_m2", area(Cause::aliasing_dark) + area(Cause::aliasing_light)},
      {"acne_area_m2", area(Cause::acne)},
      {"peter_panning_area_m2", area(Cause::peter_panning)}};
  if (in.ladder.of_comparisons())
    metrics.merge(std::map<std::string, double>{{"acne_free_bias_law_depth", measured(receivers.law_depth)},
                                                {"acne_free_bias_law_m", measured(receivers.law_m)},
                                                {"acne_free_bias_scene_law_depth", faces.law_depth},
                                                {"acne_free_bias_scene_law_m", faces.law_m}});
  return metrics;
}

}  // namespace noonmark
