// Lookups at the receivers of another renderer's frame. If its shadow map was handed over: the rungs below the frame, because
// its map is looked up by OpenGL as the frame declares, and an exact map too, so that every cause of the ladder is known.
// With a map of our own: what a technique shows there.
//
//   GivenLookup lookup(scene, tracer);
//   GivenClimb climb = lookup.climb({receivers, eye, truth, technique, depth, {.name = "frame", .picture = visibility}});
//   climb.metrics.at("acne");
//   Image<float> ours = lookup.visibility(receivers, eye, techniques_of(scene, settings));
#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/image.h"
#include "compare/ladder/ladder.h"
#include "compare/results/records.h"
#include "raytrace/tracer.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/map_depths.h"
#include "technique/settings.h"
#include "technique/technique.h"

namespace noonmark {

// The offset that lies in the depths of a handed map: how its texels differ from an exact map's, as a polygon offset does. A polygon
// offset moves a triangle's window depth by factor * m + units * r. m is the steepest slope of its plane in depth per texel, and r a
// step of the map's format. So the differences of a map from an exact one are a line over m: the factor is its slope, the units are
// its height at m = 0. A bias along the light that the casters' shader adds is such a height too.
struct MapOffset {
  double factor = 0;                      // beside what the exact map has already
  double constant = 0;                    // window depth
  DepthFormat format = DepthFormat::d24;  // whose units the constant is in
  size_t texels = 0;                      // that the line was fitted to
  double unsure = 0;                      // window depth: how far what moves each surface by itself can move `constant`
  // Whether the offset is more than what rounding and a rasteriser's grid do to a map without one.
  bool in_map() const;
};

// Of the texels of `exact` where the given map has the slope of one plane. The line of the least sum of absolute differences,
// each as a share of what rounding and a rasteriser's grid can move that texel, so that silhouettes and other surfaces do not
// bend it. Without enough of such texels: no offset.
MapOffset map_offset(const Image<float>& given, const MapDepths& exact, DepthFormat format);

struct GivenPoint {
  ReceiverImage receivers;
  glm::dvec3 eye_m;     // the camera's position, for filters that grow with the distance
  ReceiverTruth truth;  // of the receivers
  Technique technique;  // with the frame of the map; its settings name the size of the picture
  Image<float> depth;   // the map: window depth in [0,1], row 0 with the lowest v
  RungOnTop frame;      // its picture is finite where receivers face the light
  // 1: what keeps the receiver's light away is not in the map. Its step from the exact map to this one has a cause of its own,
  // frame_missing, and is no precision. Empty: none.
  Image<uint8_t> missing = {};
  // How far from its place each receiver may lie, beside the rounding of its numbers, in metres. Empty: nowhere.
  Image<float> moved_m = {};
  double step = 0;  // how far a value of the picture may lie from what was drawn, by its steps
};

struct GivenClimb {
  Ladder ladder;
  // By compare/results/metrics.h: what measure_ladder() says of the frame and its causes, and of the map.
  std::map<std::string, double> metrics;
  // Over the texels that taps read, along the light: the median distance of the map's depths from the scene's, and
  // how far apart nine tenths of the scene's are. NaN if none is read.
  double map_off_m = 0, depth_spread_m = 0;
  // By compare/judge/map_distance.h. If it is not, R5 - R4 is the ladder's cause frame_map, and its precision is 0.
  bool is_scenes_map = true;
  // Of the bias over the declared lookup of this map; empty where it has no bias to vary. One unit of its parameter in window depth.
  std::optional<BiasCurve> curve;
  double depth_per_unit = 1;
  double maps_differ = 0;  // the mean |R5 - R4| over the counted receivers
  // The share of the counted receivers whose picture on top is none that the lookup of the map gives within the rounding of
  // the receivers, of both renderers' arithmetic and of the map's format. Where the bias reads a normal, receivers on
  // smooth surfaces, whose vertices have normals of their own, are left out: `interpolated` is their share. 0 if too few
  // are left.
  double beyond_rounding = 0, interpolated = 0;
  // What the map holds beside the offset that the technique declares, and the mean |R5 - R4| over the counted receivers if
  // the exact map had it too. Without one with which the map is the scene's the latter is maps_differ.
  MapOffset offset;
  double precision_with_offset = 0;
  double offset_unit = 0;  // window depth of one unit of a polygon offset; 0 where no offset is in the map
};

class GivenLookup {
 public:
  // Both must outlive this. Throws Error(device) where there is no OpenGL.
  GivenLookup(const Scene& scene, const raytrace::Tracer& tracer);
  ~GivenLookup();

  // Throws Error(defect) if the measurement contradicts itself (compare/judge/soundness.h).
  GivenClimb climb(const GivenPoint& point);

  // Of each receiver, 0 dark to 1 lit, by the maps that OpenGL draws for the techniques (techniques_of()).
  // Without a meaning where there is no receiver.
  Image<float> visibility(const ReceiverImage& receivers, glm::dvec3 eye_m, std::span<const Technique> techniques);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace noonmark
