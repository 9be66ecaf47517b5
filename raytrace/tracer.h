// raytrace/: the truth, by Embree's rays and by scan conversion in double. May include base, scenes and technique, and not
// gl. Embree's types stay inside this folder. Begin here; raytrace/lookup_tracer.h and placement_tracer.h are the
// truth of the taps.
//
// The truth by rays: what is lit, how certain that is, and the exact shadow map.
//
//   raytrace::Tracer tracer(scene);
//   ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {light});
//   raytrace::LookupTracer rays = tracer.lookup(receivers, truth, frame, s.map, bias);  // raytrace/lookup_tracer.h
//
// Conventions: scenes/scene.h. All calls use every core; results do not depend on how many there are. The scene must
// outlive the tracer. Throws Error(device) when Embree fails.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "raytrace/lookup_tracer.h"
#include "raytrace/placement_tracer.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/bias.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark::raytrace {

struct TracerInfo {
  std::string version;
  std::string isa;  // pinned: verdicts at silhouettes differ between instruction sets
};

// Throws Error(device) when Embree cannot start.
TracerInfo tracer_info();

struct SoftTruth {
  Light light;                   // its size; without one R0 = R1
  double standard_error = 0.01;  // of R0 at each receiver
};

// Of each receiver.
struct SeenReceivers {
  Image<uint8_t> seen;
  Image<uint8_t> ambiguous;  // 1: `seen` changes when the start of the ray moves by the float error
};

class Tracer {
 public:
  // use_cells: false asks rays for everything that cells could answer (raytrace/light_cells.h). The answers are the same.
  explicit Tracer(const Scene& scene, bool use_cells = true);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  // Of each receiver: R1 by one exact shadow ray; whether R1 is ambiguous, which means that it changes when the start
  // of the ray moves by the float error in the light's plane, or the border of a cut mask by its error; and R0. Only the frame's light is used, not its map.
  ReceiverTruth receiver_truth(const ReceiverImage& receivers, const LightFrame& frame, const SoftTruth& soft,
                               StageTime* hard_stage = nullptr, StageTime* soft_stage = nullptr) const;

  // Which receivers a camera sees as its pictures show them (scenes/receivers.h): the side that the receiver's normal
  // points to, with no surface between the camera's near plane and it. Of single-sided triangles the camera sees the
  // front only, so their backs hide nothing. Whether the receiver lies within the picture is not asked. The camera has
  // a near plane.
  SeenReceivers seen_by(const ReceiverImage& receivers, const Camera& camera) const;

  // map: format, wrap, cull and depth_clamp are read; the resolution is the frame's. bias: the one that the probe was
  // taken with. A part that moves the lookup costs one more ray for each tap; a polygon offset is in the exact map.
  // offset_unit: gl::Renderer::polygon_offset_unit. The tracer, receivers and truth must outlive the returned object.
  LookupTracer lookup(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                      const MapSettings& map, const Bias& bias = {}, double offset_unit = 0) const;
  // The same at all placements of the grid. frame: of placement 0.
  PlacementTracer placements(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                             const Placements& placements, const MapSettings& map, const Bias& bias = {},
                             double offset_unit = 0) const;
  // The whole picture's at once, for tests and benchmarks. The program traces it in strips, because the taps of a wide
  // filter need more memory than there is.
  LookupTruth lookup_truth(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
                           const LightFrame& frame, const MapSettings& map, const Bias& bias = {},
                           double offset_unit = 0) const;

  // The number of edges with one triangle only. Each of them is a silhouette under every light.
  uint64_t open_edges() const;

  // For the pixels where mask is not 0: distance in metres from P to its nearest occluder towards the light; infinity
  // without one. Other pixels: 0.
  Image<float> occluder_distance(const ReceiverImage& receivers, const LightFrame& frame,
                                 const Image<uint8_t>& mask) const;

 private:
  // The receivers on the first of coincident triangles, the one that the rays know; `made` holds them where they
  // differ.
  const ReceiverImage& on_first(const ReceiverImage& receivers, std::optional<ReceiverImage>& made) const;
  std::unique_ptr<TracedScene> traced_;
  bool use_cells_;
};

}  // namespace noonmark::raytrace
