#include "raytrace/tracer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>

#include "raytrace/adjacency.h"
#include "raytrace/area_light.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/packets.h"
#include "raytrace/shadow_start.h"
#include "raytrace/texel_rays.h"

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
std::vector<uint32_t> kept_triangles(const Scene& scene, const LightFrame& frame, CulledFaces cull) {
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::uvec3 v = scene.triangles[t];
    const glm::dvec3 a = scene.positions[v.x], b = scene.positions[v.y], c = scene.positions[v.z];
    const bool front = glm::dot(glm::cross(b - a, c - a), frame.direction_to_light()) > 0;
    if (front != (cull == CulledFaces::front)) kept.push_back(t);
  }
  return kept;
}

}  // namespace

// Depth of the first surface at x from the near plane on. The rays start a little before it, for they start and end in
// float; what is before it in double is passed.
std::optional<double> first_from_near(const EmbreeScene& seen, const LightView& view, glm::dvec2 x, uint64_t& rays) {
  const LightFrame& frame = view.frame();
  const double near = frame.near_m;
  for (double from = near - 2 * view.ray_error_m();;) {
    ++rays;
    const uint32_t hit = seen.first_hit(glm::vec3(frame.to_world({x.x, x.y, from})), frame.ray_direction);
    if (hit == no_primitive) return std::nullopt;
    const double depth = view.hit_depth(hit, x);
    if (depth >= near) return depth;
    from = std::max(from, std::min(depth, near)) + 2 * view.ray_error_m();
  }
}

struct Tracer::Impl {
  explicit Impl(const Scene& s) : scene(s), embree(device, s), adjacency(s) {}

  Image<float> exact_map(const LightView& view, const TexelRays& texels, CulledFaces cull, uint64_t& rays) const;

  const Scene& scene;
  EmbreeDevice device;
  EmbreeScene embree;
  Adjacency adjacency;
};

Tracer::Tracer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Tracer::~Tracer() = default;

TracerInfo tracer_info() {
  const EmbreeDevice device;
  return {device.version(), device.isa()};
}

ReceiverTruth Tracer::receiver_truth(const ReceiverImage& receivers, const LightFrame& frame, const SoftTruth& soft,
                                     StageTime* hard_stage, StageTime* soft_stage) const {
  const Stopwatch hard_watch;
  const int width = receivers.width(), height = receivers.height();
  const LightView view(impl_->scene, frame);
  const ShadowStart start(impl_->scene, receivers, frame.ray_direction);
  ReceiverTruth truth{Image<uint8_t>(width, height), Image<uint8_t>(width, height), Image<uint8_t>(width, height), {}};

  std::vector<uint32_t> facing;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) continue;
    truth.facing[i] = glm::dot(glm::dvec3(receivers.normal[i]), frame.direction_to_light()) > 0;
    if (truth.facing[i]) facing.push_back(static_cast<uint32_t>(i));
  }

  // Each receiver's verdict at P, at four places beside it, as far away as the float error reaches, and without the
  // faces of its own plane: whether of two faces in one plane the other lies before or behind, float's rounding says.
  const double error = view.ray_error_m();
  const glm::dvec3 places[5] = {glm::dvec3(0), error * frame.right, -error * frame.right, error * frame.up,
                                -error * frame.up};
  std::atomic<uint64_t> hard_rays = 0;
  for_each_packet(facing.size(), [&](size_t first, int n) {
    uint32_t dark[6];
    for (int place = 0; place < 6; ++place) {
      dark[place] = 0;
      if (place == 5 && dark[0] == 0) continue;  // who sees through more is no darker
      hard_rays += static_cast<uint64_t>(n);
      ShadowRay rays[packet_size];
      for (int i = 0; i < n; ++i)
        rays[i] =
            place == 0 || place == 5 ? start.whole(facing[first + i]) : start.beside(facing[first + i], places[place]);
      for (ShadowRay& ray : rays) ray.through_own_plane = place == 5;
      dark[place] = impl_->embree.occluded(n, rays);
    }
    const uint32_t any = dark[0] | dark[1] | dark[2] | dark[3] | dark[4] | dark[5],
                   all = dark[0] & dark[1] & dark[2] & dark[3] & dark[4] & dark[5];
    for (int i = 0; i < n; ++i) {
      truth.lit[facing[first + i]] = !(dark[0] >> i & 1);
      truth.ambiguous[facing[first + i]] = (any ^ all) >> i & 1;
    }
  });
  if (hard_stage) *hard_stage = {hard_watch.milliseconds(), hard_rays};

  const Stopwatch soft_watch;
  uint64_t soft_rays = 0;
  if (soft.angular_diameter_deg > 0) {
    truth.soft = sample_sun(impl_->scene, impl_->embree, receivers, facing, frame, soft.angular_diameter_deg,
                            soft.standard_error, soft_rays);
  } else {
    truth.soft = Image<float>(width, height, 0);
    for (uint32_t i : facing) truth.soft[i] = truth.lit[i];
  }
  if (soft_stage) *soft_stage = {soft_watch.milliseconds(), soft_rays};
  return truth;
}

Image<float> Tracer::Impl::exact_map(const LightView& view, const TexelRays& texels, CulledFaces cull,
                                     uint64_t& rays) const {
  const LightFrame& frame = view.frame();
  std::optional<EmbreeScene> uncut;  // only the faces that the rasteriser keeps
  bool nothing_kept = false;
  if (cull != CulledFaces::none) {
    std::vector<uint32_t> kept = kept_triangles(scene, frame, cull);
    nothing_kept = kept.empty();
    if (!nothing_kept) uncut.emplace(device, scene, std::move(kept));
  }
  const EmbreeScene& seen = uncut ? *uncut : embree;
  Image<float> map(frame.resolution, frame.resolution, 1.0f);
  if (nothing_kept) return map;

  const std::vector<glm::ivec2>& list = texels.inside_texels();
  std::atomic<uint64_t> extra = 0;
  for_each_packet(list.size(), [&](size_t first, int n) {
    uint64_t extra_here = 0;
    uint32_t hits[packet_size];
    glm::vec3 origins[packet_size];
    if (uncut) {
      for (int i = 0; i < n; ++i) origins[i] = view.ray_origin(frame.texel_centre(list[first + i]));
      seen.first_hits(n, origins, frame.ray_direction, hits);
      extra_here += static_cast<uint64_t>(n);
    } else {
      for (int i = 0; i < n; ++i) hits[i] = texels.hit(list[first + i]);
    }
    for (int i = 0; i < n; ++i) {
      if (hits[i] == no_primitive) continue;
      const glm::dvec2 centre = frame.texel_centre(list[first + i]);
      double depth = view.hit_depth(hits[i], centre);
      if (depth < frame.near_m) {  // the rasteriser clips it: what lies behind it, from the near plane on?
        const std::optional<double> behind = first_from_near(seen, view, centre, extra_here);
        if (!behind) continue;
        depth = *behind;
      }
      if (depth <= frame.far_m)
        map.at(list[first + i].x, list[first + i].y) = static_cast<float>(frame.window_depth(depth));
    }
    extra += extra_here;
  });
  rays += extra;
  return map;
}

LookupTruth Tracer::lookup_truth(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
                                 const LightFrame& frame, const MapSettings& map, int kernel,
                                 const DepthBias& bias) const {
  const Stopwatch texel_watch;
  const LightView view(impl_->scene, frame);
  const TexelRays texels(impl_->embree, view, truth.facing, probe, map.wrap, kernel);
  LookupTruth result;
  uint64_t texel_rays = texels.rays();
  result.exact_map = impl_->exact_map(view, texels, map.cull, texel_rays);
  result.texel_stage = {texel_watch.milliseconds(), texel_rays};

  const Stopwatch tap_watch;
  const OwnSurface surface(impl_->embree, impl_->adjacency, view);
  const int r = kernel / 2, taps = kernel * kernel;
  result.taps.taps_per_receiver = taps;
  result.taps.taps.assign(receivers.primitive.size() * static_cast<size_t>(taps), 0);
  result.edge_distance_m = Image<float>(receivers.width(), receivers.height(), 0);
  std::atomic<uint64_t> all_rays = 0;

  for_each_packet(receivers.primitive.size(), [&](size_t first, int n) {
    uint64_t rays = 0;
    SurfacePoint points[packet_size];
    glm::dvec2 looked_up[packet_size];   // P' in the light's plane; P but for forms that move the lookup
    int lanes[packet_size], active = 0;  // the facing ones among the packet's pixels
    for (int i = 0; i < n; ++i) {
      if (!truth.facing[first + i]) continue;
      const glm::dvec3 p = receivers.position[first + i], normal = receivers.normal[first + i];
      points[active] = {glm::dvec2(frame.to_light(p)), receivers.primitive[first + i], truth.lit[first + i] != 0};
      looked_up[active] = glm::dvec2(frame.to_light(bias.looked_up(p, normal)));
      lanes[active++] = i;
    }
    if (active == 0) return;
    for (int tap = 0; tap < taps; ++tap) {
      const glm::ivec2 offset(tap % kernel - r, tap / kernel - r);
      OwnSurface::Verdict exact[packet_size], moved[packet_size];  // F and D
      const auto at_offset = [&](const auto& place, OwnSurface::Verdict* verdicts) {
        glm::vec3 origins[packet_size];
        glm::dvec2 x[packet_size];
        uint32_t hits[packet_size];
        for (int k = 0; k < active; ++k) {
          x[k] = place(k) + glm::dvec2(offset) * frame.texel_m();
          origins[k] = view.ray_origin(x[k]);
        }
        impl_->embree.first_hits(active, origins, frame.ray_direction, hits);
        rays += static_cast<uint64_t>(active);
        for (int k = 0; k < active; ++k) verdicts[k] = surface.lit_at(points[k], x[k], hits[k], rays);
      };
      if (offset == glm::ivec2(0))  // V(P, P) is R1
        for (int k = 0; k < active; ++k) exact[k] = {points[k].lit, true};
      else
        at_offset([&](int k) { return points[k].at; }, exact);
      if (bias.moves_lookup())
        at_offset([&](int k) { return looked_up[k]; }, moved);
      else
        std::copy_n(exact, active, moved);
      for (int k = 0; k < active; ++k) {
        const size_t pixel = first + static_cast<size_t>(lanes[k]);
        const glm::ivec2 texel = probe.texel[pixel] + offset;
        const uint32_t hit = texels.hit(texel);
        const glm::dvec2 centre = frame.texel_centre(texel);
        const OwnSurface::Verdict at_texel = surface.lit_at(points[k], centre, hit, rays);
        const bool exact_lit = exact[k].lit, moved_lit = moved[k].lit, texel_lit = at_texel.lit;
        const bool clipped = surface.clipped(hit, centre);
        result.taps.taps[pixel * static_cast<size_t>(taps) + static_cast<size_t>(tap)] =
            static_cast<uint8_t>((exact_lit ? tap_exact_lit : 0) | (moved_lit != exact_lit ? tap_displaced : 0) |
                                 (texel_lit ? tap_texel_lit : 0) | (clipped ? tap_near_clipped : 0) |
                                 (exact[k].sure && moved[k].sure && at_texel.sure ? 0 : tap_ambiguous));
        if (moved_lit != texel_lit) {
          const glm::dvec2 from = looked_up[k] + glm::dvec2(offset) * frame.texel_m();
          const double distance = surface.edge_distance(points[k], from, centre, moved_lit, rays);
          result.edge_distance_m[pixel] = std::max(result.edge_distance_m[pixel], static_cast<float>(distance));
        }
      }
    }
    all_rays += rays;
  });
  result.tap_stage = {tap_watch.milliseconds(), all_rays};
  return result;
}

Image<float> Tracer::occluder_distance(const ReceiverImage& receivers, const LightFrame& frame,
                                       const Image<uint8_t>& mask) const {
  const ShadowStart start(impl_->scene, receivers, frame.ray_direction);
  const double length = glm::length(glm::dvec3(frame.ray_direction));
  Image<float> distance(receivers.width(), receivers.height(), 0);
  tbb::parallel_for(size_t{0}, mask.size(), [&](size_t i) {
    if (mask[i]) distance[i] = static_cast<float>(impl_->embree.occluder_distance(start.at(i)) * length);
  });
  return distance;
}

}  // namespace noonmark::raytrace
