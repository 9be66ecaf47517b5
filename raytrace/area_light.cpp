#include "raytrace/area_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <numbers>

#include "raytrace/shadow_start.h"

namespace noonmark {
namespace {

// A 32-bit integer hash (Wellons' lowbias32 constants), to give every pixel its own shift of the sequence.
uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

// Point n of the additive recurrence of the plastic number (Roberts 2018, "R2"), shifted: even in every prefix.
glm::dvec2 sequence_point(uint32_t n, glm::dvec2 shift) {
  constexpr double plastic = 1.32471795724474602596;
  const glm::dvec2 p = shift + static_cast<double>(n) * glm::dvec2(1 / plastic, 1 / (plastic * plastic));
  return p - glm::floor(p);
}

}  // namespace

Image<float> sample_sun(const Scene& scene, const EmbreeScene& embree, const ReceiverImage& receivers,
                        const std::vector<uint32_t>& facing, const LightFrame& frame, double angular_diameter_deg,
                        double standard_error, uint64_t& rays) {
  const double radius = std::tan(angular_diameter_deg * std::numbers::pi / 360);
  const ShadowStart start(scene, receivers, frame.ray_direction);
  Image<float> seen(receivers.width(), receivers.height(), 0);
  std::atomic<uint64_t> all_rays = 0;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, facing.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    uint64_t cast = 0;
    for (size_t index = range.begin(); index != range.end(); ++index) {
      const uint32_t pixel = facing[index];
      const glm::dvec2 shift(hash(pixel) * 0x1p-32, hash(pixel ^ 0x9e3779b9u) * 0x1p-32);
      const glm::dvec3 normal = receivers.normal[pixel];
      uint32_t n = 0, lit = 0;
      for (;;) {
        ShadowRay packet[packet_size];
        int above = 0;
        for (int i = 0; i < packet_size; ++i) {
          const glm::dvec2 u = sequence_point(n + static_cast<uint32_t>(i), shift);
          const double r = radius * std::sqrt(u.x), phi = 2 * std::numbers::pi * u.y;
          const glm::dvec3 direction =
              frame.direction_to_light() + r * (std::cos(phi) * frame.right + std::sin(phi) * frame.up);
          if (glm::dot(direction, normal) > 0) packet[above++] = start.towards(pixel, glm::vec3(direction));
        }
        if (above > 0) lit += static_cast<uint32_t>(above - std::popcount(embree.occluded(above, packet)));
        cast += static_cast<uint64_t>(above);
        n += packet_size;
        const double p = (lit + 1.0) / (n + 2.0);
        if (p * (1 - p) <= standard_error * standard_error * n) break;
      }
      seen[pixel] = static_cast<float>(static_cast<double>(lit) / n);
    }
    all_rays += cast;
  });
  rays = all_rays;
  return seen;
}

}  // namespace noonmark
