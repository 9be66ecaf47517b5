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
#include "scenes/scene_size.h"
#include "scenes/view_matrix.h"
#include "technique/bias.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/light_kind.h"
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

// Receivers on the surfaces nearest to given points.
struct OnSurface {
  ReceiverImage receivers;  // no_primitive where no point was given, and in an empty scene
  Image<float> moved_m;     // distance from the given point to its receiver
};

// Tracer::edge_within looks at `edge_spokes` places on rings of fixed radii: 1/4, 3/8, 1/2, 3/4, 1, 3/2 ... units. So what is
// near within one distance is near within any larger one.
inline constexpr int edge_spokes = 16;
double edge_ring(int ring);  // the radius in units; ring: from 0 on

// Of a scene with at most so many triangles a tracer keeps what two lights see of it, otherwise what one sees. A light takes up
// to 400 bytes for each triangle.
inline constexpr size_t most_triangles_of_two_lights = size_t{1} << 18;

// Bytes of what a tracer keeps of a scene and of its lights (two, where most_triangles_of_two_lights allows) for points with these
// settings. open_edges: Tracer::open_edges().
double truth_bytes(const Settings& settings, LightKind light, const SceneSize& scene, uint64_t open_edges);

// Of each texel that a tap reads: its first hit, its depth in three maps and the error of one [24]. Of each texel beside the map:
// two lists of 16 bytes while they are made.
inline constexpr double bytes_per_asked_texel = 26, bytes_per_outside_texel = 32;

class Tracer {
 public:
  // method: rays asks no cells (raytrace/light_cells.h) and converts no map (raytrace/lattice_raster.h). The answers are
  // the same.
  explicit Tracer(const Scene& scene, TruthMethod method = TruthMethod::automatic);
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

  // What a camera sees at each pixel's centre, by one ray: the first triangle between near and far, without the backs of
  // single-sided triangles. An index into Scene::triangles, or no_primitive.
  Image<uint32_t> seen_primitives(const ViewMatrix& view, int width, int height) const;

  // Puts points that another renderer gives onto the scene: each receiver is the nearest point of all triangles, and of
  // those that are equally near within the rounding of a float position, on one that shows the camera a side. present:
  // 1 where there is a point. view: the camera, whose rays say which side of a triangle is seen.
  OnSurface on_surface(const Image<glm::dvec3>& points, const Image<uint8_t>& present, const ViewMatrix& view) const;

  // Whether a true shadow edge lies within radius_m of each receiver in the mask, measured across the light's rays: V(P, x)
  // (raytrace/own_surface.h) differs from R1 at one of the places x on the rings within the radius; or it does on the first ring
  // beyond, and the change that halving finds between P and x lies within the radius. unit_m: the unit of the rings at each
  // receiver, as small as what is told apart there, and independent of the radius. Other pixels, and those whose radius or
  // unit is not above 0: 0.
  Image<uint8_t> edge_within(const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
                             const Image<uint8_t>& mask, const Image<float>& radius_m,
                             const Image<float>& unit_m) const;

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

  // For the pixels where mask is not 0: the triangle that the light meets first on its way to the receiver. An index into
  // Scene::triangles; no_primitive at other pixels.
  Image<uint32_t> first_on_the_way(const ReceiverImage& receivers, const LightFrame& frame,
                                   const Image<uint8_t>& mask) const;

 private:
  bool uses_cells() const { return method_ == TruthMethod::automatic; }
  // The receivers on the first of coincident triangles, the one that the rays know; `made` holds them where they
  // differ.
  const ReceiverImage& on_first(const ReceiverImage& receivers, std::optional<ReceiverImage>& made) const;
  std::unique_ptr<TracedScene> traced_;
  TruthMethod method_;
};

}  // namespace noonmark::raytrace
