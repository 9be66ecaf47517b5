#include "raytrace/placement_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "raytrace/drawn_map.h"
#include "raytrace/lattice_side.h"
#include "raytrace/own_surface.h"
#include "raytrace/stage_watch.h"
#include "raytrace/texel_lattice.h"
#include "raytrace/traced_scene.h"

namespace noonmark::raytrace {
namespace {

// A polygon offset follows the slope over one texel of the map, which is S points of the lattice.
std::optional<PolygonOffset> over_texels(std::optional<PolygonOffset> offset, const Placements& placements) {
  if (offset) offset->factor *= placements.side();
  return offset;
}

}  // namespace

struct PlacementTracer::Impl {
  TracedScene& traced;
  const ReceiverImage& receivers;
  const ReceiverTruth& truth;
  Placements placements;
  MapSettings map;
  std::shared_ptr<const LatticeSide> side;
  const LightView& view;  // of the lattice
  const Silhouettes& silhouettes;
  OwnSurface surface;
  DrawnMap drawn;
  const LatticeRaster& raster;
  bool by_rays;
  std::optional<TexelLattice> lattice;
  PixelRange at_all_placements;  // the pixels whose taps the lattice holds at all placements; empty if there are none
  // Of each pixel of the strip that was traced: front_of() its taps.
  std::vector<uint32_t> fronts;
  size_t first_pixel = 0;
  // The light's own frame, whose squares are certified; empty if there are none, or if rays shall answer.
  std::shared_ptr<LightSide> light;
  LightCells* cells = nullptr;
  std::optional<OwnSurface> in_cells;
  struct Asking {
    LightCells::Reader reader;
    OwnSurface::Pair pair{};
  };
  mutable tbb::enumerable_thread_specific<Asking> asking{[this] { return Asking{LightCells::Reader(*cells)}; }};

  Impl(TracedScene& scene, const ReceiverImage& image, const ReceiverTruth& receiver_truth, const LightFrame& frame,
       const Placements& all, const MapSettings& settings, const Bias& bias, const std::optional<PolygonOffset>& offset,
       TruthMethod method)
      : traced(scene),
        receivers(image),
        truth(receiver_truth),
        placements(all),
        map(settings),
        side(scene.lattice_side(all.lattice(frame))),
        view(side->view),
        silhouettes(side->silhouettes),
        surface(scene.embree, scene.adjacency, view, silhouettes),
        drawn(scene, view, surface, silhouettes, frame, settings, bias, over_texels(offset, all)),
        raster(side->raster),
        by_rays(method == TruthMethod::rays) {
    if (by_rays) return;
    light = traced.lit_by(frame);
    cells = light->cells(receivers);
    if (cells) in_cells.emplace(traced.embree, traced.adjacency, light->view(), light->silhouettes(), cells);
  }

  // The rectangle of the light's plane that holds these taps' points. The lattice has another origin than the light's own
  // frame. The rounding from one frame to the other is much less than the margin of the squares (LightCells, reach_m).
  struct Rectangle {
    glm::dvec2 low, high;
  };
  Rectangle rectangle(const PlacedTaps& taps) const {
    const auto place = [&](glm::ivec2 point) {
      return glm::dvec2(light->view().frame().to_light(view.frame().to_world(view.texel_place(point))));
    };
    const glm::dvec2 a = place(taps.low), b = place(taps.high);
    return {glm::min(a, b), glm::max(a, b)};
  }

  // The triangle that rays meet first at all points that these taps read, by the certified squares; no_primitive if they
  // know none.
  uint32_t front_of(const PlacedTaps& taps) const {
    if (!in_cells || taps.low.x > taps.high.x) return no_primitive;
    const Rectangle box = rectangle(taps);
    return asking.local().reader.front_in(box.low, box.high).value_or(no_primitive);
  }

  // Whether the depths that these taps read follow from the plane of their front alone. Then no lattice is traced for them.
  bool by_plane(uint32_t front, const PlacedTaps& taps) const {
    return front != no_primitive && lattice->reach_of(taps) != TexelLattice::Reach::both &&
           drawn.draws_plane_of(front, taps.low, taps.high);
  }

  // V of a receiver at all points that these taps read, if it is the same for sure.
  std::optional<bool> known_in(const SurfacePoint& p, const PlacedTaps& taps) const {
    if (!in_cells) return std::nullopt;
    const Rectangle box = rectangle(taps);
    Asking& of_thread = asking.local();
    return in_cells->known_in(p, box.low, box.high, of_thread.reader, of_thread.pair);
  }

  // As TexelLattice::read_depths() gives them.
  void plane_depths(uint32_t front, const PlacedTaps& taps, std::vector<float>& depths) const {
    const bool in_map = lattice->reach_of(taps) == TexelLattice::Reach::inside;
    const glm::ivec2 size = taps.size();
    depths.assign(static_cast<size_t>(size.x) * static_cast<size_t>(size.y),
                  in_map ? std::numeric_limits<float>::infinity() : border_depth);
    if (!in_map) return;
    taps.each_square([&](glm::ivec2 low, glm::ivec2 high) {
      for (int y = low.y; y <= high.y; ++y)
        drawn.depths_on_plane(front, {low.x, y}, high.x - low.x + 1, &depths[taps.index(low.x, y)]);
    });
  }
};

std::shared_ptr<const LatticeSide> TracedScene::lattice_side(const LightFrame& lattice) {
  if (lattice_ && lattice_->view.frame() == lattice) return lattice_;
  lattice_.reset();  // before the next is made, because it is large
  auto made = std::make_shared<const LatticeSide>(*this, lattice);
  if (kept() > 1) lattice_ = made;
  return made;
}

PlacementTracer::PlacementTracer(TracedScene& traced, const ReceiverImage& receivers, const ReceiverTruth& truth,
                                 const LightFrame& frame, const Placements& placements, const MapSettings& map,
                                 const Bias& bias, double offset_unit, TruthMethod method)
    : impl_(std::make_unique<Impl>(traced, receivers, truth, frame, placements, map, bias,
                                   polygon_offset_of(frame, map, bias, offset_unit), method)) {}
PlacementTracer::PlacementTracer(PlacementTracer&&) noexcept = default;
PlacementTracer& PlacementTracer::operator=(PlacementTracer&&) noexcept = default;
PlacementTracer::~PlacementTracer() = default;

void PlacementTracer::trace(const PlacedProbe& probe, PixelRange strip, StageTime* stage,
                            std::optional<int> placement) {
  Impl& l = *impl_;
  const PixelRange held = l.at_all_placements;
  if (placement && held.first <= strip.first && strip.end <= held.end && strip.size() > 0) return;
  const StageWatch watch(stage, l.traced.device);
  l.at_all_placements = {};
  if (l.lattice)
    l.lattice->clear();
  else
    l.lattice.emplace(l.raster, l.view, l.drawn, l.placements, l.map);
  l.first_pixel = strip.first;
  l.fronts.assign(strip.size(), no_primitive);
  // Each thread asks a lattice of its own; what all of them ask for is traced.
  tbb::combinable<TexelLattice> asked([&] { return TexelLattice(l.raster, l.view, l.drawn, l.placements, l.map); });
  tbb::parallel_for(tbb::blocked_range<size_t>(strip.first, strip.end, 1024), [&](const auto& range) {
    TexelLattice& of_thread = asked.local();
    PlacedTaps taps;
    for (size_t i = range.begin(); i != range.end(); ++i) {
      if (!l.truth.facing[i]) continue;
      if (placement)
        probe.taps_of(i, *placement, taps);
      else
        probe.taps_of(i, taps);
      uint32_t& front = l.fronts[i - strip.first];
      front = l.front_of(taps);
      if (!l.by_plane(front, taps)) of_thread.want(taps);
    }
  });
  asked.combine_each([&](const TexelLattice& of_thread) { l.lattice->want(of_thread); });
  l.lattice->trace(l.by_rays ? &l.surface : nullptr);
  if (!placement) l.at_all_placements = strip;
}

PlacementTracer::RayError PlacementTracer::ray_error() const {
  const LightView& view = impl_->view;
  const double near = view.frame().near_m, range = view.frame().far_m - near;
  // Of a perspective map, depth = far (z - near) / (z (far - near)), which rises the fastest at near.
  const double depth_per_m = view.frame().uniform() ? 1 / range : view.frame().far_m / (near * range);
  return {2 * view.ray_error_m() * depth_per_m, impl_->drawn.uses_rays()};
}

bool PlacementTracer::on_edge(glm::ivec2 point) const {
  const Impl& l = *impl_;
  // The error of the same ray in double, by the same formula: double has 29 bits more than float.
  const double reach = Silhouettes::reach_of(l.view) * (l.drawn.uses_rays() ? 1 : 0x1p-29);
  const auto near = [&](glm::ivec2 k) { return l.silhouettes.near(l.view.texel_place(k), reach); };
  const std::optional<glm::ivec2> read = l.lattice->read_at(point);
  return near(point) || (read && near(*read));
}

void PlacementTracer::judge(size_t pixel, const PlacedTaps& taps, LatticeBox& box) const {
  const Impl& l = *impl_;
  box.alike = false;
  if (taps.low.x > taps.high.x) return;
  const size_t side = static_cast<size_t>(taps.side);
  const size_t points = static_cast<size_t>(taps.size().x) * static_cast<size_t>(taps.size().y);
  const glm::dvec3 light = l.view.frame().to_light(l.receivers.position[pixel]);
  const SurfacePoint p =
      l.surface.point(light, l.traced.adjacency.first(l.receivers.primitive[pixel]), l.truth.lit[pixel] != 0);
  thread_local Silhouettes::Nearby nearby;
  const glm::dvec3 places[5] = {p.at, l.view.texel_place(taps.low), l.view.texel_place(taps.high),
                                l.view.texel_place({taps.low.x, taps.high.y}),
                                l.view.texel_place({taps.high.x, taps.low.y})};
  l.silhouettes.list_nearby(places, nearby);
  // Without a silhouette in the box, a lit receiver's surface is lit all over it (the rule of OwnSurface).
  const bool none_near = p.lit && !l.by_rays && nearby.none();
  const uint32_t front = l.fronts[pixel - l.first_pixel];
  const std::optional<bool> known = none_near ? true : l.known_in(p, taps);

  const OwnSurface::Verdict everywhere{known.value_or(false), !p.on_silhouette};
  const auto bits_of = [](OwnSurface::Verdict v, bool clipped) {
    return static_cast<uint8_t>((v.lit ? tap_texel_lit : 0) | (clipped ? tap_near_clipped : 0) |
                                (v.sure ? 0 : tap_texel_unsure));
  };
  const bool by_plane = l.by_plane(front, taps);
  if (by_plane) l.plane_depths(front, taps, box.depth);
  box.alike = known && (by_plane || l.lattice->read_depths(taps, box.depth));
  if (box.alike) {
    box.bits.assign(points, bits_of(everywhere, false));
    return;
  }
  thread_local std::vector<TexelLattice::Point> found;
  if (!by_plane) l.lattice->read(taps, found);
  box.bits.assign(points, lattice_unknown);
  box.depth.resize(points);
  for (size_t tap = 0; tap < taps.column.size(); tap += side)
    for (size_t j = 0; j < side; ++j)
      for (size_t i = 0; i < side; ++i) {
        const glm::ivec2 k(taps.column[tap + i], taps.row[tap + j]);
        const size_t n = taps.index(k.x, k.y);
        if (box.bits[n] != lattice_unknown) continue;
        const TexelLattice::Point at = by_plane ? TexelLattice::Point{front, false, box.depth[n]} : found[n];
        box.bits[n] =
            bits_of(known ? everywhere : l.surface.lit_at(p, l.view.texel_place(k), at.hit, nearby), at.clipped);
        box.depth[n] = at.depth;
      }
}

}  // namespace noonmark::raytrace
