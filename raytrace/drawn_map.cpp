#include "raytrace/drawn_map.h"

#include <algorithm>
#include <array>
#include <vector>

#include "technique/casters.h"

namespace noonmark::raytrace {
namespace {

// The map skips what the rasteriser culls. Front: counter-clockwise as the light sees it. Of coincident triangles the
// first is enough; moved casters may part them, and adjacency is null.
std::vector<uint32_t> kept_triangles(const Scene& scene, const Adjacency* adjacency, const LightFrame& frame,
                                     CulledFaces cull) {
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (adjacency && adjacency->is_copy(t)) continue;
    const glm::uvec3 v = scene.triangles[t];
    const glm::dvec3 a = scene.positions[v.x], b = scene.positions[v.y], c = scene.positions[v.z];
    const bool front = glm::dot(glm::cross(b - a, c - a), frame.direction_to_light((a + b + c) / 3.0)) > 0;
    if (front != (cull == CulledFaces::front)) kept.push_back(t);
  }
  return kept;
}

// Depth of the first surface at x that is not before the near plane. Rays start and end in float, so they start a
// little before that plane, and surfaces that are before it in double are skipped.
std::optional<double> first_from_near(const EmbreeScene& seen, const LightView& view, glm::dvec3 x) {
  const double near = view.near_depth(x);
  for (double from = near - 2 * view.ray_error_m();;) {
    const uint32_t hit = seen.first_hit(view.ray_from(x, from));
    if (hit == no_primitive) return std::nullopt;
    const double depth = view.hit_depth(hit, x);
    if (depth >= near) return depth;
    from = std::max(from, std::min(depth, near)) + 2 * view.ray_error_m();
  }
}

std::optional<Scene> moved_scene(const TracedScene& traced, const LightFrame& frame, const MapSettings& map,
                                 const Bias& bias) {
  if (!moves_casters(map, bias)) return std::nullopt;
  Scene moved = traced.scene;
  moved.positions = caster_positions(traced.scene, frame, map, bias);
  return moved;
}

}  // namespace

DrawnMap::DrawnMap(const TracedScene& traced, const LightView& view, const OwnSurface& surface,
                   const Silhouettes& silhouettes, const LightFrame& map, const MapSettings& settings, const Bias& bias,
                   const std::optional<PolygonOffset>& offset)
    : moved_(moved_scene(traced, map, settings, bias)),
      view_(moved_ ? LightView(*moved_, view.frame()) : view),
      surface_(surface),
      silhouettes_(silhouettes),
      depth_clamp_(settings.keeps_clipped()),
      offset_(offset),
      scenes_tree_(traced.embree) {
  const Scene& drawn = moved_ ? *moved_ : traced.scene;
  if (settings.cull != CulledFaces::none) {
    std::vector<uint32_t> kept =
        kept_triangles(drawn, moved_ ? nullptr : &traced.adjacency, view.frame(), settings.cull);
    nothing_kept_ = kept.empty();
    if (!nothing_kept_) own_tree_.emplace(traced.device, drawn, std::move(kept));
  } else if (moved_) {
    own_tree_.emplace(traced.device, drawn);
  }
}

void DrawnMap::depths(int count, const glm::dvec3* places, const uint32_t* hits, float* depths,
                      bool no_silhouettes) const {
  std::fill_n(depths, count, 1.0f);
  if (nothing_kept_) return;
  uint32_t own_hits[packet_size];
  if (own_tree_) {
    view_.first_hits(*own_tree_, count, places, own_hits);
    hits = own_hits;
  }
  for (int i = 0; i < count; ++i) {
    const uint32_t hit =
        !own_tree_ && !no_silhouettes && silhouettes_.near(places[i]) ? surface_.exact_first(places[i]) : hits[i];
    if (hit != no_primitive) depths[i] = depth_of(hit, places[i]);
  }
}

float DrawnMap::depth_of(uint32_t hit, glm::dvec3 place) const {
  const EmbreeScene& seen = own_tree_ ? *own_tree_ : scenes_tree_;
  if (offset_) return static_cast<float>(least_offset_depth(seen, view_, *offset_, place, depth_clamp_));
  double depth = view_.hit_depth(hit, place);
  if (depth < view_.near_depth(place) && !depth_clamp_) {
    // The rasteriser clips this surface. The map holds the first surface behind the near plane instead.
    const std::optional<double> behind = first_from_near(seen, view_, place);
    if (!behind) return 1;
    depth = *behind;
  }
  return LightView::stored(view_.window_depth(depth, place));
}

bool DrawnMap::draws_plane_of(uint32_t hit, glm::ivec2 low, glm::ivec2 high) const {
  if (own_tree_ || nothing_kept_ || offset_) return false;
  const LightFrame& frame = view_.frame();
  if (frame.kind != LightKind::directional) return false;
  if (depth_clamp_ || view_.nearest_m(hit) >= frame.near_m) return true;
  // A plane is nearest at a corner of the rectangle. The float error of a ray is far more than double's rounding.
  const double after_near = frame.near_m + view_.ray_error_m();
  return std::ranges::all_of(
      std::array{low, high, glm::ivec2(low.x, high.y), glm::ivec2(high.x, low.y)},
      [&](glm::ivec2 texel) { return view_.hit_depth(hit, view_.texel_place(texel)) >= after_near; });
}

}  // namespace noonmark::raytrace
