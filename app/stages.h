// The stages of a measurement, each a function from named inputs to a small type:
//
//   scene → view → truth → map → lookup → shown → ladder
//
//   SceneStage scene = load_scene(settings, renderer);
//   ViewStage view = take_view(renderer, *scene.scene, settings.view);
//   TruthStage truth = trace_truth(*scene.tracer, view, frame, light, settings.truth);
//   MapStage map = draw_map(renderer, frame, settings);
//   LookupStage lookup = prepare_lookup(renderer, *scene.tracer, view, truth, frame, settings, strip_bytes);
//   ShownStage shown = show(renderer, map, lookup, evidence_of(...));
//   Climbed climbed = climb_strips(...);
//
// app/workbench.h joins them and keeps what consecutive points share; which settings a stage reads, their rows say
// (technique/settings.h). tests/planted_support.h joins the same functions around a renderer with a defect.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/judge/soundness.h"
#include "compare/ladder/bias_curves.h"
#include "compare/ladder/ladder.h"
#include "gl/renderer.h"
#include "raytrace/tracer.h"

namespace noonmark {

// What is asked at one point of a sweep.
struct PointSetup {
  const Settings& settings;
  const LightFrame& frame;  // make_light_frame()
  Bias bias;                // of settings.bias; in tests of planted defects, what the ladder takes it for
};

struct SceneStage {
  std::unique_ptr<Scene> scene;  // the tracer refers to it
  std::string identity;          // scene_digest
  std::unique_ptr<raytrace::Tracer> tracer;
  uint64_t open_edges = 0;
};
// Uploads the scene to the renderer, too. Throws Error.
SceneStage load_scene(const Settings& settings, gl::Renderer& renderer);

struct ViewStage {
  Camera camera;
  ReceiverImage receivers;
  std::map<std::string, double> metrics;  // why pixels see nothing
};
ViewStage take_view(gl::Renderer& renderer, const Scene& scene, const ViewSettings& settings);

struct TruthStage {
  ReceiverTruth receivers;  // R1 and R0
  StageTime hard, soft;
};
TruthStage trace_truth(const raytrace::Tracer& tracer, const ViewStage& view, const LightFrame& frame,
                       const Light& light, const TruthSettings& settings);

struct MapStage {
  gl::ShadowMap map;
  Image<float> depth;  // as the lookup's sampler returns it
  double time_ms = 0;  // the median of three
};
// scene: as the renderer has it.
MapStage draw_map(gl::Renderer& renderer, const Scene& scene, const PointSetup& point);

// What the lookup asks, and what is true there. The truth of the taps is of one strip of the picture at a time; where
// all of them fit into one strip it is kept, and the rays are not.
struct LookupStage {
  LookupProbe probe;  // of a cube, with the texels of the strip at hand
  gl::ShadowMap exact_map;
  Image<float> exact_depth;
  std::vector<PixelRange> strips;
  std::optional<raytrace::LookupTracer> rays;
  TapTruth taps;  // of the strip at hand
  Image<float> edge_distance_texels;
  StageTime texel_stage, tap_stage;
};
// strip_bytes: what the truth of a strip's taps may take. sound: whose unit of polygon offset the exact map has; the
// renderer itself but in tests of planted defects. view and truth must outlive what it returns.
LookupStage prepare_lookup(gl::Renderer& renderer, gl::Renderer& sound, const raytrace::Tracer& tracer,
                           const ViewStage& view, const TruthStage& truth, const PointSetup& point, size_t strip_bytes);

// What OpenGL shows: the technique on its own map, on the exact map, and on a map of ties.
struct ShownStage {
  Image<float> r5, r4, ties, tie_lookup;
  double time_ms = 0;  // of the lookup in its own map, the median of three
};
// asked: the settings that the lookup runs with; uploaded: those of the maps that are uploaded. Both are the point's but
// in tests of planted defects.
ShownStage show(gl::Renderer& renderer, const gl::ShadowMap& map, const LookupStage& lookup, const TruthStage& truth,
                const PointSetup& point, const Settings& asked, const MapSettings& uploaded);

struct Climbed {
  Ladder ladder;
  std::map<std::string, double> soundness;  // compare/judge/soundness.h
  std::optional<BiasCounts> counts;         // where a part is varied
};
// Brings the taps of strip after strip, and books them. varied: the part that a curve runs through, or null.
Climbed climb_strips(gl::Renderer& renderer, LookupStage& lookup, const ViewStage& view, const TruthStage& truth,
                     const Image<float>& stored_map, const ShownStage& shown, const PointSetup& point,
                     const BiasPart* varied);

}  // namespace noonmark
