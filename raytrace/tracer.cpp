#include "raytrace/tracer.h"

#include <algorithm>
#include <new>
#include <optional>
#include <string>

#include "raytrace/area_light.h"
#include "raytrace/light_view.h"
#include "raytrace/packets.h"
#include "raytrace/shadow_start.h"
#include "raytrace/stage_watch.h"
#include "raytrace/traced_scene.h"
#include "scenes/error.h"

namespace noonmark::raytrace {
const ReceiverImage& Tracer::on_first(const ReceiverImage& receivers, std::optional<ReceiverImage>& made) const {
  const Adjacency& adjacency = traced_->adjacency;
  if (!adjacency.any_copies()) return receivers;
  made = receivers;
  for (uint32_t& primitive : made->primitive.pixels)
    if (primitive != no_primitive) primitive = adjacency.first(primitive);
  return *made;
}

Tracer::Tracer(const Scene& scene) try : traced_(std::make_unique<TracedScene>(scene)) {
} catch (const std::bad_alloc&) {
  throw Error(ErrorKind::device,
              "the ray tracer's tables for " + std::to_string(scene.triangles.size()) +
                  " triangles do not fit into memory; simplify the scene, or allow more memory (ulimit -v)");
}
Tracer::~Tracer() = default;

uint64_t Tracer::open_edges() const {
  uint64_t open = 0;
  for (uint32_t t = 0; t < traced_->adjacency.triangles(); ++t)
    for (int e = 0; e < 3; ++e) open += !traced_->adjacency.is_copy(t) && traced_->adjacency.across(t, e).empty();
  return open;
}

TracerInfo tracer_info() {
  const EmbreeDevice device;
  return {device.version(), device.isa()};
}

ReceiverTruth Tracer::receiver_truth(const ReceiverImage& given, const LightFrame& frame, const SoftTruth& soft,
                                     StageTime* hard_stage, StageTime* soft_stage) const {
  std::optional<StageWatch> watch(std::in_place, hard_stage, traced_->device);
  std::optional<ReceiverImage> made;
  const ReceiverImage& receivers = on_first(given, made);
  const int width = receivers.width(), height = receivers.height();
  const ShadowStart start(traced_->scene, receivers, frame);
  ReceiverTruth truth{Image<uint8_t>(width, height), Image<uint8_t>(width, height), Image<uint8_t>(width, height), {}};

  std::vector<uint32_t> facing;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) continue;
    const glm::dvec3 p = receivers.position[i];
    truth.facing[i] = frame.reaches(p) && glm::dot(glm::dvec3(receivers.normal[i]), frame.direction_to_light(p)) > 0;
    if (truth.facing[i]) facing.push_back(static_cast<uint32_t>(i));
  }

  // The verdict of each receiver at P and at four places beside it, at the distance of the float error.
  const double error = traced_->lit_by(frame)->view().ray_error_m();
  const glm::dvec2 places[5] = {{0, 0}, {error, 0}, {-error, 0}, {0, error}, {0, -error}};
  for_each_packet(facing.size(), [&](size_t first, int n) {
    uint32_t dark[5];
    for (int place = 0; place < 5; ++place) {
      ShadowRay rays[packet_size];
      for (int i = 0; i < n; ++i)
        rays[i] = place == 0 ? start.whole(facing[first + i]) : start.beside(facing[first + i], places[place]);
      dark[place] = traced_->embree.occluded(n, rays);
    }
    const uint32_t any = dark[0] | dark[1] | dark[2] | dark[3] | dark[4],
                   all = dark[0] & dark[1] & dark[2] & dark[3] & dark[4];
    for (int i = 0; i < n; ++i) {
      truth.lit[facing[first + i]] = !(dark[0] >> i & 1);
      truth.ambiguous[facing[first + i]] = (any ^ all) >> i & 1;
    }
  });

  watch.emplace(soft_stage, traced_->device);
  if (has_size(soft.light)) {
    truth.soft =
        sample_light(traced_->scene, traced_->embree, receivers, facing, frame, soft.light, soft.standard_error);
  } else {
    truth.soft = Image<float>(width, height, 0);
    for (uint32_t i : facing) truth.soft[i] = truth.lit[i];
  }
  return truth;
}

LookupTracer Tracer::lookup(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                            const MapSettings& map, const Bias& bias, double offset_unit) const {
  return LookupTracer(*traced_, receivers, truth, frame, map, bias, offset_unit);
}

PlacementTracer Tracer::placements(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                                   const Placements& placements, const MapSettings& map, const Bias& bias,
                                   double offset_unit) const {
  return PlacementTracer(*traced_, receivers, truth, frame, placements, map, bias, offset_unit);
}

LookupTruth Tracer::lookup_truth(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
                                 const LightFrame& frame, const MapSettings& map, const Bias& bias,
                                 double offset_unit) const {
  LookupTracer rays = lookup(receivers, truth, frame, map, bias, offset_unit);
  const PixelRange all{0, receivers.primitive.size()};
  LookupTruth result;
  rays.ask(probe, all, &result.texel_stage);
  result.exact_map = rays.trace_map(&result.texel_stage);
  result.edge_distance_texels = Image<float>(receivers.width(), receivers.height(), 0);
  result.taps = rays.trace_taps(probe, all, result.edge_distance_texels, &result.tap_stage);
  return result;
}

Image<float> Tracer::occluder_distance(const ReceiverImage& given, const LightFrame& frame,
                                       const Image<uint8_t>& mask) const {
  std::optional<ReceiverImage> made;
  const ReceiverImage& receivers = on_first(given, made);
  const ShadowStart start(traced_->scene, receivers, frame);
  Image<float> distance(receivers.width(), receivers.height(), 0);
  tbb::parallel_for(size_t{0}, mask.size(), [&](size_t i) {
    if (!mask[i]) return;
    const ShadowRay ray = start.at(i);
    distance[i] = static_cast<float>(traced_->embree.occluder_distance(ray) * glm::length(glm::dvec3(ray.direction)));
  });
  return distance;
}

}  // namespace noonmark::raytrace
