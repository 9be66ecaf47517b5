// The truth of one lookup: the exact map, and the truth at every tap. Tracer::lookup() makes a LookupTracer.
#pragma once
#include <memory>

#include "scenes/receivers.h"
#include "technique/bias.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/map_depths.h"
#include "technique/settings.h"

namespace noonmark::raytrace {

class TapTracing;
class TracedScene;

// Traces the truth of one lookup strip by strip, so that only the taps of one strip need memory.
//
//   LookupTracer rays = tracer.lookup(receivers, truth, frame, settings.map, bias);
//   rays.ask(probe, strip);                                        // for every strip of the picture
//   MapDepths exact_map = rays.trace_map();
//   TapTruth taps = rays.trace_taps(probe, strip, edge_distance);  // for every strip, in any order
//
// The probe is the same one in all calls; it must hold the taps of the strip that is given. If a stage is given, the
// time and the number of rays are added to it.
class LookupTracer {
 public:
  // What Tracer::lookup() is given.
  LookupTracer(TracedScene& traced, const ReceiverImage& receivers, const ReceiverTruth& truth, const LightFrame& frame,
               const MapSettings& map, const Bias& bias, double offset_unit, TruthMethod method);
  ~LookupTracer();
  LookupTracer(LookupTracer&&) noexcept;
  LookupTracer& operator=(LookupTracer&&) noexcept;

  // The map will hold the texels of these pixels' taps. of: those of the facing receivers that are not 0 in it.
  void ask(const LookupProbe& probe, PixelRange strip, StageTime* stage = nullptr) {
    ask(facing(), probe, strip, stage);
  }
  void ask(const Image<uint8_t>& of, const LookupProbe& probe, PixelRange strip, StageTime* stage = nullptr);
  size_t asked_texels() const;  // how many the map will hold; before trace_map()

  // Window depth at the centres of the texels that were asked for, 1 elsewhere.
  MapDepths trace_map(StageTime* stage = nullptr);

  // After trace_map(): how the first hits at the texels were found.
  TruthAnswers texel_answers() const;

  // edge_distance_texels has the picture's size. It gets, for each receiver of the strip, the largest distance from the
  // exact place of a tap (moved, if the lookup is moved) to the shadow edge on the way to the texel centre that the tap
  // reads. Measured across the light's rays, in texels there. 0 where D = V at every tap.
  TapTruth trace_taps(const LookupProbe& probe, PixelRange strip, Image<float>& edge_distance_texels,
                      StageTime* stage = nullptr);

  // Only F and D: the truth at the exact places, without that of texels. Neither ask() nor trace_map() is needed.
  TapTruth trace_places(const LookupProbe& probe, PixelRange strip, StageTime* stage = nullptr);

 private:
  const Image<uint8_t>& facing() const;
  TapTruth trace(const LookupProbe& probe, PixelRange strip, Image<float>* edge_distance_texels, StageTime* stage);
  friend class TapTracing;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Of the whole picture at once: every tap of every facing receiver, and the exact map that those taps read.
struct LookupTruth {
  TapTruth taps;
  MapDepths exact_map;                // LookupTracer::trace_map()
  Image<float> edge_distance_texels;  // LookupTracer::trace_taps()
  StageTime texel_stage;              // light-side rays through texel centres
  StageTime tap_stage;                // V at every tap
};

}  // namespace noonmark::raytrace
