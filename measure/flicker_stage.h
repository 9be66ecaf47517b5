// The stage of a measurement that compares a frame of a motion ([motion]) with the next one.
//
//   if (settings.view.motion.any()) Flicker flicker = trace_flicker({stages, renderer, loaded, view, truth, techniques, choice, r5});
#pragma once
#include <span>

#include "compare/ladder/flicker.h"
#include "measure/stages.h"

namespace noonmark {

// All of it must outlive the call. r5: what the frame itself shows. The renderer has the frame's receivers, and has them
// again afterwards.
struct FlickerInput {
  Pipeline& stages;
  gl::Renderer& renderer;
  const SceneStage& loaded;
  const ViewStage& view;
  const TruthStage& truth;                // of all receivers
  std::span<const Technique> techniques;  // of each map
  const MapChoice& choice;                // of this frame
  const Image<float>& r5;
};

// The settings of the next frame.
Settings next_frame(const Settings& settings);

// A receiver counts if the next frame's camera sees it as it sees its receivers (raytrace::Tracer::seen_by), within the
// picture, if it faces the light in both frames, if R1 is the same in both, and if none of these is ambiguous. Throws Error(usage) if the scene's triangles move
// between the frames: then there is no point of the world that is the same in both.
Flicker trace_flicker(const FlickerInput& input);

}  // namespace noonmark
