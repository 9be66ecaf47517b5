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
namespace {

// Pixels, in the picture's order.
struct Facing {
  std::vector<uint32_t> facing;   // that face the light
  std::vector<uint32_t> unknown;  // those of them that the cells do not answer
};

// Sets truth.facing; and truth.lit where the cells answer. cells: may be null.
Facing find_facing(const ReceiverImage& receivers, const LightFrame& frame, LightCells* cells, ReceiverTruth& truth) {
  constexpr size_t pixels_per_part = 8192;
  const size_t pixels = receivers.primitive.size();
  std::vector<Facing> parts((pixels + pixels_per_part - 1) / pixels_per_part);
  const bool one_direction = frame.light().rays().have_one_direction();
  const glm::dvec3 only_direction = one_direction ? frame.direction_to_light() : glm::dvec3(0);
  // LightFrame::to_light(), without the cost of a call for each pixel.
  const glm::dvec3 origin = frame.origin_m, right = frame.right, up = frame.up, forward = frame.forward;
  const auto in_light = [=](glm::dvec3 p) {
    return glm::dvec3(glm::dot(p - origin, right), glm::dot(p - origin, up), glm::dot(p - origin, forward));
  };
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    std::optional<LightCells::Reader> reader;
    if (cells) reader.emplace(*cells);
    Facing& found = parts[part];
    for (size_t i = part * pixels_per_part; i < std::min(pixels, (part + 1) * pixels_per_part); ++i) {
      if (receivers.primitive[i] == no_primitive) continue;
      const glm::dvec3 p = receivers.position[i], normal = receivers.normal[i];
      if (!one_direction && !frame.reaches(p)) continue;
      const double cosine = glm::dot(normal, one_direction ? only_direction : frame.direction_to_light(p));
      if (!(cosine > 0)) continue;
      truth.facing[i] = 1;
      found.facing.push_back(static_cast<uint32_t>(i));
      const LightCells::Answer answer = reader && cosine >= LightCells::least_cosine
                                            ? reader->at(in_light(p), receivers.primitive[i])
                                            : LightCells::Answer::unknown;
      if (answer == LightCells::Answer::unknown)
        found.unknown.push_back(static_cast<uint32_t>(i));
      else
        truth.lit[i] = answer == LightCells::Answer::lit;
    }
  });
  Facing all;
  for (const Facing& part : parts) {
    all.facing.insert(all.facing.end(), part.facing.begin(), part.facing.end());
    all.unknown.insert(all.unknown.end(), part.unknown.begin(), part.unknown.end());
  }
  return all;
}

}  // namespace

const ReceiverImage& Tracer::on_first(const ReceiverImage& receivers, std::optional<ReceiverImage>& made) const {
  const Adjacency& adjacency = traced_->adjacency;
  if (!adjacency.any_copies()) return receivers;
  made = receivers;
  for (uint32_t& primitive : made->primitive.pixels)
    if (primitive != no_primitive) primitive = adjacency.first(primitive);
  return *made;
}

Tracer::Tracer(const Scene& scene, bool use_cells) try
    : traced_(std::make_unique<TracedScene>(scene)), use_cells_(use_cells) {
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

  const std::shared_ptr<LightSide> light = traced_->lit_by(frame);
  LightCells* const cells = use_cells_ ? light->cells(receivers) : nullptr;
  const Facing found = find_facing(receivers, frame, cells, truth);

  // The verdict of each receiver at P and at four places beside it, at the distance of the float error.
  const double error = light->view().ray_error_m();
  const glm::dvec2 places[5] = {{0, 0}, {error, 0}, {-error, 0}, {0, error}, {0, -error}};
  for_each_packet(found.unknown.size(), [&](size_t first, int n) {
    uint32_t dark[5];
    for (int place = 0; place < 5; ++place) {
      ShadowRay rays[packet_size];
      for (int i = 0; i < n; ++i) {
        const uint32_t pixel = found.unknown[first + static_cast<size_t>(i)];
        rays[i] = place == 0 ? start.whole(pixel) : start.beside(pixel, places[place]);
      }
      dark[place] = traced_->embree.occluded(n, rays);
    }
    const uint32_t any = dark[0] | dark[1] | dark[2] | dark[3] | dark[4],
                   all = dark[0] & dark[1] & dark[2] & dark[3] & dark[4];
    for (int i = 0; i < n; ++i) {
      const uint32_t pixel = found.unknown[first + static_cast<size_t>(i)];
      truth.lit[pixel] = !(dark[0] >> i & 1);
      truth.ambiguous[pixel] = (any ^ all) >> i & 1;
    }
  });

  watch.emplace(soft_stage, traced_->device);
  if (has_size(soft.light)) {
    truth.soft = sample_light(traced_->scene, traced_->embree, receivers, found.facing, frame, soft.light,
                              soft.standard_error, cells);
  } else {
    truth.soft = Image<float>(width, height);
    std::copy(truth.lit.pixels.begin(), truth.lit.pixels.end(), truth.soft.pixels.begin());
  }
  return truth;
}

LookupTracer Tracer::lookup(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                            const MapSettings& map, const Bias& bias, double offset_unit) const {
  return LookupTracer(*traced_, receivers, truth, frame, map, bias, offset_unit, use_cells_);
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
