#include "raytrace/tracer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <optional>
#include <string>

#include "raytrace/adjacency.h"
#include "raytrace/area_light.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/packets.h"
#include "raytrace/polygon_offset.h"
#include "raytrace/shadow_start.h"
#include "raytrace/texel_rays.h"
#include "scenes/error.h"

namespace noonmark::raytrace {
namespace {

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The exact map skips what the rasteriser culls. Front: counter-clockwise as the light sees it.
std::vector<uint32_t> kept_triangles(const Scene& scene, const Adjacency& adjacency, const LightFrame& frame,
                                     CulledFaces cull) {
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (adjacency.is_copy(t)) continue;
    const glm::uvec3 v = scene.triangles[t];
    const glm::dvec3 a = scene.positions[v.x], b = scene.positions[v.y], c = scene.positions[v.z];
    const bool front = glm::dot(glm::cross(b - a, c - a), frame.direction_to_light((a + b + c) / 3.0)) > 0;
    if (front != (cull == CulledFaces::front)) kept.push_back(t);
  }
  return kept;
}

// Depth of the first surface at x from the near plane on. The rays start a little before it, for they start and end in
// float; what is before it in double is passed.
std::optional<double> first_from_near(const EmbreeScene& seen, const LightView& view, glm::dvec3 x, uint64_t& rays) {
  const double near = view.near_depth(x);
  for (double from = near - 2 * view.ray_error_m();;) {
    ++rays;
    const uint32_t hit = seen.first_hit(view.ray_from(x, from));
    if (hit == no_primitive) return std::nullopt;
    const double depth = view.hit_depth(hit, x);
    if (depth >= near) return depth;
    from = std::max(from, std::min(depth, near)) + 2 * view.ray_error_m();
  }
}

}  // namespace

struct Tracer::Impl {
  explicit Impl(const Scene& s) : scene(s), adjacency(s), embree(device, s, adjacency.without_copies()) {}

  Image<float> exact_map(const LightView& view, const TexelRays& texels, const MapSettings& map,
                         const std::optional<PolygonOffset>& offset, uint64_t& rays) const;

  // The receivers on the first of coincident triangles, the one that the rays know; `made` holds them where they
  // differ.
  const ReceiverImage& on_first(const ReceiverImage& receivers, std::optional<ReceiverImage>& made) const;

  const Scene& scene;
  EmbreeDevice device;
  Adjacency adjacency;
  EmbreeScene embree;
};

const ReceiverImage& Tracer::Impl::on_first(const ReceiverImage& receivers, std::optional<ReceiverImage>& made) const {
  if (!adjacency.any_copies()) return receivers;
  made = receivers;
  for (uint32_t& primitive : made->primitive.pixels)
    if (primitive != no_primitive) primitive = adjacency.first(primitive);
  return *made;
}

Tracer::Tracer(const Scene& scene) try : impl_(std::make_unique<Impl>(scene)) {
} catch (const std::bad_alloc&) {
  throw Error(ErrorKind::device,
              "the ray tracer's tables for " + std::to_string(scene.triangles.size()) +
                  " triangles do not fit into memory; simplify the scene, or allow more memory (ulimit -v)");
}
Tracer::~Tracer() = default;

uint64_t Tracer::open_edges() const {
  uint64_t open = 0;
  for (uint32_t t = 0; t < impl_->adjacency.triangles(); ++t)
    for (int e = 0; e < 3; ++e) open += !impl_->adjacency.is_copy(t) && impl_->adjacency.across(t, e).empty();
  return open;
}

TracerInfo tracer_info() {
  const EmbreeDevice device;
  return {device.version(), device.isa()};
}

ReceiverTruth Tracer::receiver_truth(const ReceiverImage& given, const LightFrame& frame, const SoftTruth& soft,
                                     StageTime* hard_stage, StageTime* soft_stage) const {
  const Stopwatch hard_watch;
  std::optional<ReceiverImage> made;
  const ReceiverImage& receivers = impl_->on_first(given, made);
  const int width = receivers.width(), height = receivers.height();
  const LightView view(impl_->scene, frame);
  const ShadowStart start(impl_->scene, receivers, frame);
  ReceiverTruth truth{Image<uint8_t>(width, height), Image<uint8_t>(width, height), Image<uint8_t>(width, height), {}};

  std::vector<uint32_t> facing;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) continue;
    const glm::dvec3 p = receivers.position[i];
    truth.facing[i] = frame.in_cone(p) && glm::dot(glm::dvec3(receivers.normal[i]), frame.direction_to_light(p)) > 0;
    if (truth.facing[i]) facing.push_back(static_cast<uint32_t>(i));
  }

  // Each receiver's verdict at P, and at four places beside it, as far away as the float error reaches.
  const double error = view.ray_error_m();
  const glm::dvec2 places[5] = {{0, 0}, {error, 0}, {-error, 0}, {0, error}, {0, -error}};
  std::atomic<uint64_t> hard_rays = 0;
  for_each_packet(facing.size(), [&](size_t first, int n) {
    uint32_t dark[5];
    for (int place = 0; place < 5; ++place) {
      hard_rays += static_cast<uint64_t>(n);
      ShadowRay rays[packet_size];
      for (int i = 0; i < n; ++i)
        rays[i] = place == 0 ? start.whole(facing[first + i]) : start.beside(facing[first + i], places[place]);
      dark[place] = impl_->embree.occluded(n, rays);
    }
    const uint32_t any = dark[0] | dark[1] | dark[2] | dark[3] | dark[4],
                   all = dark[0] & dark[1] & dark[2] & dark[3] & dark[4];
    for (int i = 0; i < n; ++i) {
      truth.lit[facing[first + i]] = !(dark[0] >> i & 1);
      truth.ambiguous[facing[first + i]] = (any ^ all) >> i & 1;
    }
  });
  if (hard_stage) *hard_stage = {hard_watch.milliseconds(), hard_rays};

  const Stopwatch soft_watch;
  uint64_t soft_rays = 0;
  if (has_size(soft.light)) {
    truth.soft =
        sample_light(impl_->scene, impl_->embree, receivers, facing, frame, soft.light, soft.standard_error, soft_rays);
  } else {
    truth.soft = Image<float>(width, height, 0);
    for (uint32_t i : facing) truth.soft[i] = truth.lit[i];
  }
  if (soft_stage) *soft_stage = {soft_watch.milliseconds(), soft_rays};
  return truth;
}

Image<float> Tracer::Impl::exact_map(const LightView& view, const TexelRays& texels, const MapSettings& settings,
                                     const std::optional<PolygonOffset>& offset, uint64_t& rays) const {
  const LightFrame& frame = view.frame();
  std::optional<EmbreeScene> uncut;  // only the faces that the rasteriser keeps
  bool nothing_kept = false;
  if (settings.cull != CulledFaces::none) {
    std::vector<uint32_t> kept = kept_triangles(scene, adjacency, frame, settings.cull);
    nothing_kept = kept.empty();
    if (!nothing_kept) uncut.emplace(device, scene, std::move(kept));
  }
  const EmbreeScene& seen = uncut ? *uncut : embree;
  const glm::ivec2 size = frame.map_size();
  Image<float> map(size.x, size.y, 1.0f);
  if (nothing_kept) return map;

  const std::vector<glm::ivec2>& list = texels.inside_texels();
  std::atomic<uint64_t> extra = 0;
  for_each_packet(list.size(), [&](size_t first, int n) {
    uint64_t extra_here = 0;
    uint32_t hits[packet_size];
    glm::dvec3 places[packet_size];
    if (uncut) {
      for (int i = 0; i < n; ++i) places[i] = view.texel_place(list[first + i]);
      view.first_hits(seen, n, places, hits);
      extra_here += static_cast<uint64_t>(n);
    } else {
      for (int i = 0; i < n; ++i) hits[i] = texels.hit(list[first + i]);
    }
    for (int i = 0; i < n; ++i) {
      if (hits[i] == no_primitive) continue;
      const glm::dvec3 centre = view.texel_place(list[first + i]);
      float& texel = map.at(list[first + i].x, list[first + i].y);
      if (offset) {
        texel = static_cast<float>(least_offset_depth(seen, view, *offset, centre, settings.depth_clamp));
        ++extra_here;
        continue;
      }
      double depth = view.hit_depth(hits[i], centre);
      if (depth < view.near_depth(centre) && !settings.depth_clamp) {
        // The rasteriser clips it: what lies behind it, from the near plane on?
        const std::optional<double> behind = first_from_near(seen, view, centre, extra_here);
        if (!behind) continue;
        depth = *behind;
      }
      texel = static_cast<float>(std::clamp(frame.window_depth(depth), 0.0, 1.0));
    }
    extra += extra_here;
  });
  rays += extra;
  return map;
}

LookupTruth Tracer::lookup_truth(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
                                 const LightFrame& frame, const MapSettings& map, const DepthBias& bias,
                                 double offset_unit) const {
  const Stopwatch texel_watch;
  const LightView view(impl_->scene, frame);
  const TexelRays texels(impl_->embree, view, truth.facing, probe, map.wrap);
  std::optional<PolygonOffset> offset;  // a fragment shader that writes its own depth, a point light's, has none
  if (bias.form == BiasForm::polygon_offset && frame.kind != LightKind::point)
    offset.emplace(PolygonOffset{bias.factor, bias.units, map.format == DepthFormat::d32f ? 0 : offset_unit});
  LookupTruth result;
  uint64_t texel_rays = texels.rays();
  result.exact_map = impl_->exact_map(view, texels, map, offset, texel_rays);
  result.texel_stage = {texel_watch.milliseconds(), texel_rays};

  const Stopwatch tap_watch;
  const OwnSurface surface(impl_->embree, impl_->adjacency, view);
  const int taps = probe.taps();
  const bool one_for_all = probe.pattern.variants == 1 && !probe.pattern.scaled_by_view;  // every receiver's offsets
  result.taps.taps_per_receiver = taps;
  result.taps.taps.assign(receivers.primitive.size() * static_cast<size_t>(taps), 0);
  result.edge_distance_texels = Image<float>(receivers.width(), receivers.height(), 0);
  std::atomic<uint64_t> all_rays = 0;

  for_each_packet(receivers.primitive.size(), [&](size_t first, int n) {
    uint64_t rays = 0;
    SurfacePoint points[packet_size];
    glm::dvec3 at[packet_size];          // P in the light's frame
    glm::dvec3 looked_up[packet_size];   // P' there; P but for forms that move the lookup
    int lanes[packet_size], active = 0;  // the facing ones among the packet's pixels
    for (int i = 0; i < n; ++i) {
      if (!truth.facing[first + i]) continue;
      const glm::dvec3 p = receivers.position[first + i], normal = receivers.normal[first + i];
      at[active] = frame.to_light(p);
      points[active] =
          surface.point(at[active], impl_->adjacency.first(receivers.primitive[first + i]), truth.lit[first + i] != 0);
      looked_up[active] = frame.to_light(bias.looked_up(frame, p, normal));
      lanes[active++] = i;
    }
    if (active == 0) return;
    for (int tap = 0; tap < taps; ++tap) {
      glm::dvec3 offsets[packet_size];
      if (one_for_all)
        std::fill_n(offsets, active, glm::dvec3(probe.pattern.offset(0, tap)));
      else
        for (int k = 0; k < active; ++k) offsets[k] = probe.offset(first + static_cast<size_t>(lanes[k]), tap);
      OwnSurface::Verdict exact[packet_size], moved[packet_size];  // F and D
      const auto at_offset = [&](const glm::dvec3* from, OwnSurface::Verdict* verdicts) {
        glm::dvec3 x[packet_size];
        uint32_t hits[packet_size];
        for (int k = 0; k < active; ++k) x[k] = view.normal_place(frame.tap_place(from[k], offsets[k]));
        view.first_hits(impl_->embree, active, x, hits);
        rays += static_cast<uint64_t>(active);
        for (int k = 0; k < active; ++k) verdicts[k] = surface.lit_at(points[k], x[k], hits[k], rays);
      };
      if (std::all_of(offsets, offsets + active, [](glm::dvec3 o) { return o == glm::dvec3(0); }))
        for (int k = 0; k < active; ++k) exact[k] = {points[k].lit, true};  // V(P, P) is R1
      else
        at_offset(at, exact);
      if (bias.moves_lookup())
        at_offset(looked_up, moved);
      else
        std::copy_n(exact, active, moved);
      for (int k = 0; k < active; ++k) {
        const size_t pixel = first + static_cast<size_t>(lanes[k]);
        const glm::ivec2 texel = probe.texel(pixel, tap);
        const uint32_t hit = texels.hit(texel);
        const glm::dvec3 centre = view.texel_place(texel);
        const OwnSurface::Verdict at_texel = surface.lit_at(points[k], centre, hit, rays);
        const bool exact_lit = exact[k].lit, moved_lit = moved[k].lit, texel_lit = at_texel.lit;
        const bool clipped = !map.depth_clamp && surface.clipped(hit, centre);
        result.taps.taps[pixel * static_cast<size_t>(taps) + static_cast<size_t>(tap)] =
            static_cast<uint8_t>((exact_lit ? tap_exact_lit : 0) | (moved_lit != exact_lit ? tap_displaced : 0) |
                                 (texel_lit ? tap_texel_lit : 0) | (clipped ? tap_near_clipped : 0) |
                                 (exact[k].sure ? 0 : tap_exact_unsure) | (moved[k].sure ? 0 : tap_moved_unsure) |
                                 (at_texel.sure ? 0 : tap_texel_unsure));
        if (moved_lit != texel_lit) {
          const glm::dvec3 from = view.normal_place(frame.tap_place(looked_up[k], offsets[k]));
          const double distance = surface.edge_distance_texels(points[k], from, centre, moved_lit, rays);
          result.edge_distance_texels[pixel] =
              std::max(result.edge_distance_texels[pixel], static_cast<float>(distance));
        }
      }
    }
    all_rays += rays;
  });
  result.tap_stage = {tap_watch.milliseconds(), all_rays};
  return result;
}

Image<float> Tracer::occluder_distance(const ReceiverImage& given, const LightFrame& frame,
                                       const Image<uint8_t>& mask) const {
  std::optional<ReceiverImage> made;
  const ReceiverImage& receivers = impl_->on_first(given, made);
  const ShadowStart start(impl_->scene, receivers, frame);
  Image<float> distance(receivers.width(), receivers.height(), 0);
  tbb::parallel_for(size_t{0}, mask.size(), [&](size_t i) {
    if (!mask[i]) return;
    const ShadowRay ray = start.at(i);
    distance[i] = static_cast<float>(impl_->embree.occluder_distance(ray) * glm::length(glm::dvec3(ray.direction)));
  });
  return distance;
}

}  // namespace noonmark::raytrace
