// The truth of a lookup at every placement of the map's grid: V and the exact map's depth at the lattice points that a
// receiver's taps read. Tracer::placements() makes one.
//
//   PlacementTracer rays = tracer.placements(receivers, truth, frame, placements, settings.map, bias);
//   rays.trace(probe, strip);              // for every strip of the picture, in any order
//   rays.judge(pixel, taps, box);          // for each facing receiver of that strip
#pragma once
#include <memory>
#include <optional>

#include "scenes/receivers.h"
#include "technique/bias.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/placements.h"
#include "technique/settings.h"

namespace noonmark::raytrace {

class TracedScene;

// Bytes of all placements that form a lattice, `side` on a side: where each placement looks up, the points of the lattice that
// are held at a time with their tiles, and the scene seen through it.
inline double placement_bytes(double pixels, double side, double triangles) {
  return 28 * 9e6 + 8 * pixels * side + 260 * triangles;
}

class PlacementTracer {
 public:
  // frame: of placement 0; a light whose grid can shift (KindOfLight). The rest is as for LookupTracer.
  PlacementTracer(TracedScene& traced, const ReceiverImage& receivers, const ReceiverTruth& truth,
                  const LightFrame& frame, const Placements& placements, const MapSettings& map, const Bias& bias,
                  double offset_unit, TruthMethod method);
  ~PlacementTracer();
  PlacementTracer(PlacementTracer&&) noexcept;
  PlacementTracer& operator=(PlacementTracer&&) noexcept;

  // Traces the lattice points that the taps of these pixels read, at all placements or at one. They replace those of
  // another strip.
  void trace(const PlacedProbe& probe, PixelRange strip, StageTime* stage = nullptr, std::optional<int> placement = {});

  // The verdicts and depths at the points that the taps of this facing receiver read. It may be called from several
  // threads. box: its memory is used again.
  void judge(size_t pixel, const PlacedTaps& taps, LatticeBox& box) const;

  // How far the depth of an exact map of the ladder may lie beside the lattice's because rays of float found both: twice
  // LightView::ray_error_m, as window depth where a metre has most of it. It concerns points that the near plane clips,
  // and all points of maps with moved casters or culled faces (`everywhere`).
  struct RayError {
    double depth = 0;
    bool everywhere = false;
  };
  RayError ray_error() const;

  // Whether a silhouette passes through the centre of the texel of this lattice point, or of the texel that a tap there
  // reads in a repeated map. The map and the lattice compute that place around different origins, so the rounding of
  // double decides for each of them on which side of the edge it lies; where rays of float find the depths
  // (`everywhere`), their error does.
  bool on_edge(glm::ivec2 point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace noonmark::raytrace
