// The causes of a frame whose own shadow map was handed over. It needs OpenGL.
//
//   FrameMap with_map(scene, tracer);
//   const std::optional<Ladder> ladder = with_map.climb(frame, false, verdict);
#pragma once
#include <optional>
#include <string>

#include "frames/judge.h"
#include "measure/given_lookup.h"

namespace noonmark {

class FrameMap {
 public:
  // Throws Error(device) if there is no OpenGL, and says how to judge without it.
  FrameMap(const Scene& scene, const raytrace::Tracer& tracer);

  // frame: with a map. verdict: gets the result of the check "map", and unless that refuses the frame the metrics: the causes
  // of the ladder by their names, frame_lookup, frame_lookup_differs, frame_map. Throws Error(file) if the map is not one of the
  // frame's light. accepted: whether the check's failure is accepted. Empty if the frame is refused.
  std::optional<Ladder> climb(const GivenFrame& frame, bool accepted, FrameVerdict& verdict);

 private:
  GivenLookup lookup_;
};

}  // namespace noonmark
