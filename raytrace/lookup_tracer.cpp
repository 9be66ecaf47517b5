#include "raytrace/lookup_tracer.h"

#include <algorithm>
#include <optional>

#include "raytrace/drawn_map.h"
#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/packets.h"
#include "raytrace/stage_watch.h"
#include "raytrace/texel_rays.h"
#include "raytrace/traced_scene.h"

namespace noonmark::raytrace {
namespace {

// The silhouettes among the taps of a receiver. A receiver that is lit and has none is lit at all of these places, for
// sure (OwnSurface::lit_at() without a crossing), so no ray is needed at a tap's exact place. For the others they are
// listed once, not searched for at each tap. Only where one table of offsets serves all receivers of parallel rays; then
// the corners of the table are those of the rectangle around the taps.
class AmongTaps {
 public:
  AmongTaps(const LightView& view, const Silhouettes& silhouettes, const LookupProbe& probe, const Bias& bias)
      : silhouettes_(silhouettes), probe_(probe) {
    const LightFrame& frame = view.frame();
    applies_ = view.rays().have_one_direction() && probe.pattern.variants == 1 && !probe.pattern.scaled_by_view &&
               probe.cube_resolution == 0 && !bias.moves_lookup();
    if (!applies_) return;
    for (int tap = 0; tap < probe.taps(); ++tap) {
      low_ = glm::min(low_, glm::vec2(probe.pattern.offset(0, tap)));
      high_ = glm::max(high_, glm::vec2(probe.pattern.offset(0, tap)));
    }
    origin_m_ = frame.origin_m, right_ = frame.right, up_ = frame.up;
    first_texel_ = glm::dvec2(view.texel_place({0, 0}));
    texel_m_ = frame.texel_m({0, 0, 0});
  }

  bool applies() const { return applies_; }

  // The taps read texels between these two.
  std::pair<glm::ivec2, glm::ivec2> texels(size_t pixel) const {
    const glm::vec2 at = probe_.map_texels[pixel];
    if (probe_.pattern.bilinear())
      return {probe_.texel_at(at, pixel, 0), probe_.texel_at(at, pixel, probe_.taps() - 1)};
    // As LookupProbe::texel_at() rounds, which keeps the order of the offsets.
    return {LookupProbe::floored(at + low_), LookupProbe::floored(at + high_)};
  }

  // p: the receiver, in the world. nearby: its memory is used again.
  bool none(size_t pixel, glm::dvec3 p, Silhouettes::Nearby& nearby) const {
    const Silhouettes::Rectangle rectangle = around(pixel, p);
    if (silhouettes_.none_in(rectangle)) return true;
    silhouettes_.list_in(rectangle, nearby);
    return nearby.none();
  }
  void list(size_t pixel, glm::dvec3 p, Silhouettes::Nearby& nearby) const {
    silhouettes_.list_in(around(pixel, p), nearby);
  }

 private:
  // Holds the receiver's place, those of its taps, and the centres of their texels, as LightFrame computes them except
  // for double's rounding, which is far less than the reach of the silhouettes' lists. LightFrame's own functions serve
  // every kind of light, and took half of the time of a lookup without a filter.
  Silhouettes::Rectangle around(size_t pixel, glm::dvec3 p) const {
    const auto [low, high] = texels(pixel);
    const glm::dvec2 place(glm::dot(p - origin_m_, right_), glm::dot(p - origin_m_, up_));
    return {0, glm::min(place + texel_m_ * glm::dvec2(low_), first_texel_ + texel_m_ * glm::dvec2(low)),
            glm::max(place + texel_m_ * glm::dvec2(high_), first_texel_ + texel_m_ * glm::dvec2(high))};
  }

  const Silhouettes& silhouettes_;
  const LookupProbe& probe_;
  bool applies_;
  glm::vec2 low_{0}, high_{0};  // the least and the largest offset of a tap in each axis; 0 is between them
  glm::dvec3 origin_m_{0}, right_{0}, up_{0};
  glm::dvec2 first_texel_{0};  // the centre of texel (0, 0)
  double texel_m_ = 0;
};

}  // namespace

struct LookupTracer::Impl {
  TracedScene& traced;
  const ReceiverImage& receivers;
  const ReceiverTruth& truth;
  MapSettings map;
  Bias bias;
  std::optional<PolygonOffset> offset;
  std::shared_ptr<LightSide> light;
  LightView view;
  bool use_cells;
  TexelRays texels{traced, view, map.wrap};
};

LookupTracer::LookupTracer(TracedScene& traced, const ReceiverImage& receivers, const ReceiverTruth& truth,
                           const LightFrame& frame, const MapSettings& map, const Bias& bias, double offset_unit,
                           bool use_cells) {
  const std::shared_ptr<LightSide> light = traced.lit_by(frame);
  impl_.reset(new Impl{traced, receivers, truth, map, bias, polygon_offset_of(frame, map, bias, offset_unit), light,
                       light->view().with_map_of(frame), use_cells});
}
LookupTracer::LookupTracer(LookupTracer&&) noexcept = default;
LookupTracer& LookupTracer::operator=(LookupTracer&&) noexcept = default;
LookupTracer::~LookupTracer() = default;

void LookupTracer::ask(const LookupProbe& probe, PixelRange strip, StageTime* stage) {
  const StageWatch watch(stage, impl_->traced.device);
  impl_->texels.ask(impl_->truth.facing, probe, strip);
}

MapDepths LookupTracer::trace_map(StageTime* stage) {
  const StageWatch watch(stage, impl_->traced.device);
  impl_->texels.trace();
  const Impl& l = *impl_;
  const OwnSurface surface(l.traced.embree, l.traced.adjacency, l.view, l.light->silhouettes());
  const DrawnMap drawn(l.traced, l.view, surface, l.light->silhouettes(), l.view.frame(), l.map, l.bias, l.offset);
  MapDepths map(l.texels.texels(), 1);
  l.texels.each_inside([&](int count, size_t first, const glm::dvec3* places, const uint32_t* hits) {
    drawn.depths(count, places, hits, &map.depth[first]);
  });
  return map;
}

TapTruth LookupTracer::trace_taps(const LookupProbe& probe, PixelRange strip, Image<float>& edge_distance_texels,
                                  StageTime* stage) {
  return trace(probe, strip, &edge_distance_texels, stage);
}

TapTruth LookupTracer::trace_places(const LookupProbe& probe, PixelRange strip, StageTime* stage) {
  return trace(probe, strip, nullptr, stage);
}

TapTruth LookupTracer::trace(const LookupProbe& probe, PixelRange strip, Image<float>* edge_distance_texels,
                             StageTime* stage) {
  Impl& l = *impl_;
  const StageWatch watch(stage, l.traced.device);
  LightCells* const cells = l.use_cells ? l.light->cells(l.receivers) : nullptr;
  const OwnSurface surface(l.traced.embree, l.traced.adjacency, l.view, l.light->silhouettes(), cells);
  const LightView& view = l.view;
  const LightFrame& frame = view.frame();
  const int taps = probe.taps();
  const bool one_for_all = probe.pattern.variants == 1 && !probe.pattern.scaled_by_view;  // every receiver's offsets
  TapTruth result{taps, {}, strip.first};
  result.taps.assign(strip.size() * static_cast<size_t>(taps), 0);

  const AmongTaps among_taps(view, l.light->silhouettes(), probe, l.bias);
  const bool listed = l.use_cells && among_taps.applies();
  const auto certain = static_cast<uint8_t>(tap_exact_lit | (edge_distance_texels ? tap_texel_lit : 0));
  const bool may_clip = edge_distance_texels && !l.map.keeps_clipped();
  const auto answer = [&](size_t pixel) {
    uint8_t* bits = &result.taps[(pixel - strip.first) * static_cast<size_t>(taps)];
    std::fill_n(bits, taps, certain);
    if (!may_clip) return;
    const auto [low, high] = among_taps.texels(pixel);
    if (!l.texels.may_be_clipped(low, high)) return;
    for (int tap = 0; tap < taps; ++tap) {
      const glm::ivec2 texel = probe.texel(pixel, tap);
      if (l.texels.clipped(texel)) bits[tap] |= tap_near_clipped;
    }
  };
  const bool parallel = view.rays().have_one_direction();
  const double texel_m = parallel ? frame.texel_m({}) : 0;
  const auto tap_place = [&](glm::dvec3 from, glm::dvec3 offset) {
    // Of parallel rays the same numbers, without the calls.
    return parallel ? glm::dvec3(from.x + offset.x * texel_m, from.y + offset.y * texel_m, 1)
                    : view.normal_place(frame.tap_place(from, offset));
  };
  constexpr size_t pixels_per_part = 4096;
  std::vector<std::vector<size_t>> parts((strip.size() + pixels_per_part - 1) / pixels_per_part);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    const size_t from = strip.first + part * pixels_per_part, to = std::min(strip.end, from + pixels_per_part);
    Silhouettes::Nearby nearby;
    for (size_t pixel = from; pixel < to; ++pixel) {
      if (!l.truth.facing[pixel]) continue;
      if (edge_distance_texels) (*edge_distance_texels)[pixel] = 0;
      if (l.truth.lit[pixel] && listed && among_taps.none(pixel, l.receivers.position[pixel], nearby))
        answer(pixel);
      else
        parts[part].push_back(pixel);
    }
  });
  std::vector<size_t> asked;
  for (const std::vector<size_t>& part : parts) asked.insert(asked.end(), part.begin(), part.end());

  for_each_packet(asked.size(), [&](size_t begin, int active) {
    SurfacePoint points[packet_size];
    glm::dvec3 at[packet_size];         // P in the light's frame
    glm::dvec3 looked_up[packet_size];  // P' there; P unless a part moves the lookup
    thread_local Silhouettes::Nearby nearby[packet_size];
    const size_t* const pixels = &asked[begin];
    for (int k = 0; k < active; ++k) {
      const glm::dvec3 p = l.receivers.position[pixels[k]], normal = l.receivers.normal[pixels[k]];
      at[k] = frame.to_light(p);
      points[k] =
          surface.point(at[k], l.traced.adjacency.first(l.receivers.primitive[pixels[k]]), l.truth.lit[pixels[k]] != 0);
      looked_up[k] = frame.to_light(l.bias.looked_up(frame, p, normal));
      if (listed) among_taps.list(pixels[k], p, nearby[k]);
    }
    std::optional<LightCells::Reader> reader;
    if (cells) reader.emplace(*cells);
    const auto first_hits = [&](int count, const glm::dvec3* x, uint32_t* hits) {
      int unknown[packet_size], rays = 0;
      glm::dvec3 places[packet_size];
      for (int k = 0; k < count; ++k) {
        if (const auto hit = reader ? reader->first_hit(x[k]) : std::nullopt) {
          hits[k] = *hit;
        } else {
          places[rays] = x[k];
          unknown[rays++] = k;
        }
      }
      if (rays == 0) return;
      uint32_t found[packet_size];
      view.first_hits(l.traced.embree, rays, places, found);
      for (int i = 0; i < rays; ++i) hits[unknown[i]] = found[i];
    };
    const auto lit_at = [&](int k, glm::dvec3 x, uint32_t hit) {
      return listed ? surface.lit_at(points[k], x, hit, nearby[k]) : surface.lit_at(points[k], x, hit);
    };
    for (int tap = 0; tap < taps; ++tap) {
      glm::dvec3 offsets[packet_size];
      if (one_for_all)
        std::fill_n(offsets, active, glm::dvec3(probe.pattern.offset(0, tap)));
      else
        for (int k = 0; k < active; ++k) offsets[k] = probe.offset(pixels[k], tap);
      OwnSurface::Verdict exact[packet_size], moved[packet_size];  // F and D
      const auto at_offset = [&](const glm::dvec3* from, OwnSurface::Verdict* verdicts) {
        glm::dvec3 x[packet_size];
        uint32_t hits[packet_size];
        for (int k = 0; k < active; ++k) x[k] = tap_place(from[k], offsets[k]);
        first_hits(active, x, hits);
        for (int k = 0; k < active; ++k) verdicts[k] = lit_at(k, x[k], hits[k]);
      };
      if (std::all_of(offsets, offsets + active, [](glm::dvec3 o) { return o == glm::dvec3(0); }))
        for (int k = 0; k < active; ++k) exact[k] = {points[k].lit, true};  // V(P, P) is R1
      else
        at_offset(at, exact);
      if (l.bias.moves_lookup())
        at_offset(looked_up, moved);
      else
        std::copy_n(exact, active, moved);
      // A lookup that was moved behind a spot light has no place in the map: D is F.
      bool behind[packet_size];
      for (int k = 0; k < active; ++k) {
        behind[k] = !frame.light().has_place(looked_up[k]);
        if (behind[k]) moved[k] = exact[k];
      }
      for (int k = 0; k < active; ++k) {
        const size_t pixel = pixels[k];
        const bool exact_lit = exact[k].lit, moved_lit = moved[k].lit;
        uint8_t& bits = result.taps[(pixel - strip.first) * static_cast<size_t>(taps) + static_cast<size_t>(tap)];
        bits = static_cast<uint8_t>((exact_lit ? tap_exact_lit : 0) | (moved_lit != exact_lit ? tap_displaced : 0) |
                                    (exact[k].sure ? 0 : tap_exact_unsure) | (moved[k].sure ? 0 : tap_moved_unsure));
        if (!edge_distance_texels) continue;
        const glm::ivec2 texel = probe.texel(pixel, tap);
        const uint32_t hit = l.texels.hit(texel);
        const glm::dvec3 centre = view.texel_place(texel);
        const OwnSurface::Verdict at_texel = lit_at(k, centre, hit);
        const bool texel_lit = at_texel.lit,
                   clipped = may_clip && l.texels.may_be_clipped(texel, texel) && l.texels.clipped(texel);
        bits = static_cast<uint8_t>(bits | (texel_lit ? tap_texel_lit : 0) | (clipped ? tap_near_clipped : 0) |
                                    (at_texel.sure ? 0 : tap_texel_unsure));
        if (moved_lit != texel_lit && !behind[k]) {
          const glm::dvec3 from = tap_place(looked_up[k], offsets[k]);
          const double distance = surface.edge_distance_texels(points[k], from, centre, moved_lit);
          float& farthest = (*edge_distance_texels)[pixel];
          farthest = std::max(farthest, static_cast<float>(distance));
        }
      }
    }
  });
  return result;
}

}  // namespace noonmark::raytrace
