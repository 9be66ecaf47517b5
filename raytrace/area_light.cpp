#include "raytrace/area_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <optional>

#include "raytrace/shadow_start.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// Point n of Roberts' R2 sequence (2018), moved by `shift` within the unit square. The sequence adds the same step,
// made of the plastic number, each time. Its first n points are spread evenly, whatever n is.
glm::dvec2 sequence_point(uint32_t n, glm::dvec2 shift) {
  constexpr double plastic = 1.32471795724474602596;
  const glm::dvec2 p = shift + static_cast<double>(n) * glm::dvec2(1 / plastic, 1 / (plastic * plastic));
  return p - glm::floor(p);
}

}  // namespace

bool has_size(const Light& light) { return kind_of_light(light.kind).disc_radius(light) > 0; }

Image<float> sample_light(const Scene& scene, const EmbreeScene& embree, const ReceiverImage& receivers,
                          const std::vector<uint32_t>& facing, const LightFrame& frame, const Light& light,
                          double standard_error, LightCells* cells) {
  const KindOfLight& kind = frame.light();
  const LightDisc disc{light.shape, kind.disc_radius(light)};
  const ShadowStart start(scene, receivers, frame);
  Image<float> seen(receivers.width(), receivers.height(), 0);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, facing.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    std::optional<LightCells::Reader> reader;
    if (cells) reader.emplace(*cells);
    for (size_t index = range.begin(); index != range.end(); ++index) {
      const uint32_t pixel = facing[index];
      const glm::dvec2 shift(hash_pixel(pixel) * 0x1p-32, hash_pixel(pixel ^ 0x9e3779b9u) * 0x1p-32);
      const glm::dvec3 normal = receivers.normal[pixel], position = receivers.position[pixel];
      if (kind.surrounds(frame, disc, position)) {
        seen[pixel] = 1;
        continue;
      }
      if (reader && glm::dot(normal, frame.direction_to_light(position)) >= LightCells::least_cosine + disc.radius) {
        const LightCells::Answer answer =
            reader->disc_at(frame.to_light(position), receivers.primitive[pixel], disc.radius);
        if (answer != LightCells::Answer::unknown) {
          seen[pixel] = answer == LightCells::Answer::lit;
          continue;
        }
      }
      uint32_t n = 0, lit = 0;
      for (;;) {
        ShadowRay packet[packet_size];
        int above = 0;
        for (int i = 0; i < packet_size; ++i) {
          const glm::dvec2 u = sequence_point(n + static_cast<uint32_t>(i), shift);
          const WayToLight way = kind.way_to_disc(frame, disc, position, u);
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
