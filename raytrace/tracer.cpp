#include "raytrace/tracer.h"

#include <algorithm>
#include <new>
#include <optional>
#include <string>

#include "base/error.h"
#include "raytrace/area_light.h"
#include "raytrace/lattice_raster.h"
#include "raytrace/light_view.h"
#include "raytrace/packets.h"
#include "raytrace/shadow_start.h"
#include "raytrace/stage_watch.h"
#include "raytrace/traced_scene.h"
#include "technique/casters.h"

namespace noonmark::raytrace {
namespace {

// Pixels, in the picture's order.
struct Facing {
  std::vector<uint32_t> facing;   // that face the light
  std::vector<uint32_t> unknown;  // those of them that the cells do not answer
  uint64_t known = 0;             // how many of them the cells answer
};

// Receivers in blocks, so that the arithmetic that is the same for all of them stands in loops without a branch.
class FindFacing {
 public:
  FindFacing(const ReceiverImage& receivers, const LightFrame& frame, LightCells* cells, bool list_facing,
             ReceiverTruth& truth)
      : receivers_(receivers), frame_(frame), cells_(cells), list_facing_(list_facing), truth_(truth) {}

  void operator()(PixelRange pixels, Facing& found) const {
    std::optional<LightCells::Reader> reader;
    if (cells_) reader.emplace(*cells_);
    for (size_t first = pixels.first; first < pixels.end; first += block)
      judge(first, std::min(block, pixels.end - first), reader ? &*reader : nullptr, found);
  }

 private:
  static constexpr size_t block = 64;

  void judge(size_t first, size_t count, LightCells::Reader* reader, Facing& found) const {
    const uint32_t* const primitives = &receivers_.primitive[first];
    if (std::all_of(primitives, primitives + count, [](uint32_t p) { return p == no_primitive; })) return;
    const glm::vec3 *const positions = &receivers_.position[first], *const normals = &receivers_.normal[first];
    double cosine[block];  // 0 or less where the light does not reach; of the background, any number
    if (frame_.light().rays().have_one_direction()) {
      const glm::dvec3 to_light = frame_.direction_to_light();
      for (size_t k = 0; k < count; ++k) cosine[k] = glm::dot(glm::dvec3(normals[k]), to_light);
    } else {
      for (size_t k = 0; k < count; ++k) {
        const glm::dvec3 p = positions[k];
        cosine[k] = primitives[k] != no_primitive && frame_.reaches(p)
                        ? glm::dot(glm::dvec3(normals[k]), frame_.direction_to_light(p))
                        : 0;
      }
    }
    double u[block], v[block], z[block];  // LightFrame::to_light()
    if (reader) {
      const glm::dvec3 origin = frame_.origin_m, right = frame_.right, up = frame_.up, forward = frame_.forward;
      for (size_t k = 0; k < count; ++k) {
        const glm::dvec3 way = glm::dvec3(positions[k]) - origin;
        u[k] = glm::dot(way, right);
        v[k] = glm::dot(way, up);
        z[k] = glm::dot(way, forward);
      }
    }
    uint8_t *const facing = &truth_.facing[first], *const lit = &truth_.lit[first];
    for (size_t k = 0; k < count; ++k) {
      if (primitives[k] == no_primitive || !(cosine[k] > 0)) continue;
      facing[k] = 1;
      if (list_facing_) found.facing.push_back(static_cast<uint32_t>(first + k));
      const LightCells::Answer answer = reader && cosine[k] >= LightCells::least_cosine
                                            ? reader->at({u[k], v[k], z[k]}, primitives[k])
                                            : LightCells::Answer::unknown;
      if (answer == LightCells::Answer::unknown) {
        found.unknown.push_back(static_cast<uint32_t>(first + k));
      } else {
        lit[k] = answer == LightCells::Answer::lit;
        ++found.known;
      }
    }
  }

  const ReceiverImage& receivers_;
  const LightFrame& frame_;
  LightCells* cells_;
  bool list_facing_;
  ReceiverTruth& truth_;
};

// Sets truth.facing; and truth.lit where the cells answer. cells: may be null. list_facing: false leaves `facing` empty.
Facing find_facing(const ReceiverImage& receivers, const LightFrame& frame, LightCells* cells, bool list_facing,
                   ReceiverTruth& truth) {
  constexpr size_t pixels_per_part = 8192;
  const size_t pixels = receivers.primitive.size();
  std::vector<Facing> parts((pixels + pixels_per_part - 1) / pixels_per_part);
  const FindFacing find(receivers, frame, cells, list_facing, truth);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    find({part * pixels_per_part, std::min(pixels, (part + 1) * pixels_per_part)}, parts[part]);
  });
  Facing all;
  for (const Facing& part : parts) {
    all.facing.insert(all.facing.end(), part.facing.begin(), part.facing.end());
    all.known += part.known;
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

Tracer::Tracer(const Scene& scene, TruthMethod method) try
    : traced_(std::make_unique<TracedScene>(scene)), method_(method) {
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
  LightCells* const cells = uses_cells() ? light->cells(receivers) : nullptr;
  const Facing found = find_facing(receivers, frame, cells, has_size(soft.light), truth);

  truth.answers = {.cells = found.known, .rays = found.unknown.size()};

  // The verdict of each receiver at P and at four places beside it, at the distance of the error.
  const double error = light->view().start_error_m();
  const glm::dvec2 places[5] = {{0, 0}, {error, 0}, {-error, 0}, {0, error}, {0, -error}};
  for_each_packet(found.unknown.size(), [&](size_t first, int n) {
    uint32_t dark[5];
    ShadowStart::Across axes[packet_size];
    for (int i = 0; i < n; ++i) axes[i] = start.across(found.unknown[first + static_cast<size_t>(i)]);
    for (int place = 0; place < 5; ++place) {
      ShadowRay rays[packet_size];
      for (int i = 0; i < n; ++i) {
        const uint32_t pixel = found.unknown[first + static_cast<size_t>(i)];
        rays[i] = place == 0 ? start.whole(pixel)
                             : start.beside(pixel, places[place].x * axes[i].right + places[place].y * axes[i].up);
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
  return LookupTracer(*traced_, receivers, truth, frame, map, bias, offset_unit, method_);
}

PlacementTracer Tracer::placements(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                                   const Placements& placements, const MapSettings& map, const Bias& bias,
                                   double offset_unit) const {
  return PlacementTracer(*traced_, receivers, truth, frame, placements, map, bias, offset_unit, method_);
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

Image<uint32_t> Tracer::first_on_the_way(const ReceiverImage& receivers, const LightFrame& frame,
                                         const Image<uint8_t>& mask) const {
  const LightView view(traced_->scene, frame);
  Image<uint32_t> first(receivers.width(), receivers.height(), no_primitive);
  tbb::parallel_for(size_t{0}, mask.size(), [&](size_t i) {
    if (!mask[i]) return;
    const glm::dvec3 place = view.place_of(frame.to_light(glm::dvec3(receivers.position[i])));
    view.first_hits(traced_->embree, 1, &place, &first[i]);
  });
  return first;
}

double truth_bytes(const Settings& settings, LightKind light, const SceneSize& scene, uint64_t open_edges) {
  constexpr double per_tree_triangle = 150;  // a second tree for the rays, without the culled faces
  const KindOfLight& kind = kind_of_light(light);
  const double triangles = static_cast<double>(scene.triangles), edges = 3 * triangles;
  const double pixels = static_cast<double>(settings.view.width_px) * settings.view.height_px;
  double bytes = scene_bytes(scene) +
                 silhouette_bytes(edges, std::min(edges, static_cast<double>(open_edges)), kind.tiles(settings.map));
  if (settings.map.cull != CulledFaces::none) bytes += per_tree_triangle * triangles;
  // The scene once more with moved vertices: its triangles, its places in the light's frame, and a tree of its own.
  if (moves_casters(settings.map, Bias(settings.bias))) bytes += scene_bytes(scene) + per_tree_triangle * triangles;
  if (kind.map_shape() == MapShape::flat) bytes += raster_bytes(triangles);
  const bool two_lights = scene.triangles <= most_triangles_of_two_lights;
  if (kind.rays().have_one_direction()) bytes += (two_lights ? 2 : 1) * light_cell_bytes(pixels);
  return bytes + (two_lights ? second_light_bytes(triangles) : 0);
}

}  // namespace noonmark::raytrace
