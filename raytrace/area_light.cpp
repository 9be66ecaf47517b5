#include "raytrace/area_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "raytrace/shadow_start.h"
#include "scenes/camera_frame.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// Point n of the additive recurrence of the plastic number (Roberts 2018, "R2"), shifted: the first n points are spread
// uniformly for every n.
glm::dvec2 sequence_point(uint32_t n, glm::dvec2 shift) {
  constexpr double plastic = 1.32471795724474602596;
  const glm::dvec2 p = shift + static_cast<double>(n) * glm::dvec2(1 / plastic, 1 / (plastic * plastic));
  return p - glm::floor(p);
}

// Places on the light as a receiver sees it.
class LightSampler {
 public:
  LightSampler(const LightFrame& frame, const Light& light) : frame_(frame), light_(light) {
    if (frame.parallel()) radius_ = std::tan(light.angular_diameter_deg * std::numbers::pi / 360);
  }

  // The way to the place that u (in the unit square) stands for.
  WayToLight way(glm::dvec3 p, glm::dvec2 u) const {
    const double phi = 2 * std::numbers::pi * u.y;
    if (frame_.parallel()) {
      const double r = radius_ * std::sqrt(u.x);
      return {glm::vec3(frame_.direction_to_light() + r * (std::cos(phi) * frame_.right + std::sin(phi) * frame_.up)),
              std::numeric_limits<float>::infinity(),
              {}};
    }
    const glm::dvec3 centre = frame_.origin_m - p;
    const double distance = glm::length(centre);
    const glm::dvec3 axis = centre / distance;
    glm::dvec3 right = frame_.right, up = frame_.up;
    if (!(light_.shape == LightShape::disc && light_.kind == LightKind::spot)) upright_axes(axis, {0, 1, 0}, right, up);
    const glm::dvec3 around = std::cos(phi) * right + std::sin(phi) * up;
    if (light_.shape == LightShape::disc) {
      const glm::dvec3 way = centre + light_.radius_m * std::sqrt(u.x) * around;
      return {glm::vec3(glm::normalize(way)), static_cast<float>(glm::length(way)), p + way};
    }
    // The sphere's cone, uniformly in solid angle, which is uniformly in the cosine. 1 - cos is computed without
    // cancellation, for small lights.
    const double sine = light_.radius_m / distance;
    const double rest = u.x * (sine * sine / (1 + std::sqrt(1 - sine * sine)));  // 1 - cosine
    const double off = std::sqrt(rest * (2 - rest)), along = distance * (1 - rest);
    const double to_surface =
        along - std::sqrt(std::max(0.0, light_.radius_m * light_.radius_m - distance * off * distance * off));
    const glm::dvec3 direction = (1 - rest) * axis + off * around;
    return {glm::vec3(direction), static_cast<float>(to_surface), p + to_surface * direction};
  }

  bool surrounds(glm::dvec3 p) const {
    return !frame_.parallel() && light_.shape == LightShape::sphere &&
           glm::length(frame_.origin_m - p) <= light_.radius_m;
  }

 private:
  const LightFrame& frame_;
  const Light& light_;
  double radius_ = 0;
};

}  // namespace

bool has_size(const Light& light) {
  return (light.kind == LightKind::directional ? light.angular_diameter_deg : light.radius_m) > 0;
}

Image<float> sample_light(const Scene& scene, const EmbreeScene& embree, const ReceiverImage& receivers,
                          const std::vector<uint32_t>& facing, const LightFrame& frame, const Light& light,
                          double standard_error) {
  const LightSampler sampler(frame, light);
  const ShadowStart start(scene, receivers, frame);
  Image<float> seen(receivers.width(), receivers.height(), 0);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, facing.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t index = range.begin(); index != range.end(); ++index) {
      const uint32_t pixel = facing[index];
      const glm::dvec2 shift(hash_pixel(pixel) * 0x1p-32, hash_pixel(pixel ^ 0x9e3779b9u) * 0x1p-32);
      const glm::dvec3 normal = receivers.normal[pixel], position = receivers.position[pixel];
      if (sampler.surrounds(position)) {
        seen[pixel] = 1;
        continue;
      }
      uint32_t n = 0, lit = 0;
      for (;;) {
        ShadowRay packet[packet_size];
        int above = 0;
        for (int i = 0; i < packet_size; ++i) {
          const glm::dvec2 u = sequence_point(n + static_cast<uint32_t>(i), shift);
          const WayToLight way = sampler.way(position, u);
          if (glm::dot(glm::dvec3(way.direction), normal) > 0) packet[above++] = start.towards(pixel, way);
        }
        if (above > 0) lit += static_cast<uint32_t>(above - std::popcount(embree.occluded(above, packet)));
        n += packet_size;
        const double p = (lit + 1.0) / (n + 2.0);
        if (p * (1 - p) <= standard_error * standard_error * n) break;
      }
      seen[pixel] = static_cast<float>(static_cast<double>(lit) / n);
    }
  });
  return seen;
}

}  // namespace noonmark
