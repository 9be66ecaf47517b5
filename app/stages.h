// The stages of a measurement, each a function from named inputs to a small type:
//
//   scene → view → truth → map → lookup → shown → ladder
//
//   SceneStage scene = load_scene(settings, renderer);
//   PointSetup point{settings, frame, Bias(settings.bias)};
//   ViewStage view = take_view(renderer, *scene.scene, settings.view);
//   TruthStage truth = trace_truth(*scene.tracer, view, frame, light, settings.truth);
//   MapStage map = draw_map(renderer, *scene.scene, point);
//   LookupStage lookup = prepare_lookup(renderer, renderer, *scene.tracer, view, truth, point, strip_bytes);
//   ShownStage shown = show(renderer, map.map, lookup, truth, point, settings, settings.map);
//   Climbed climbed = climb_strips(renderer, lookup, view, truth, map.depth, shown, point, varied);
//
// app/workbench.h joins these stages and keeps the results that consecutive points share. The settings' rows name the
// stages that read them (technique/settings.h). tests/acceptance/planted_support.h joins the same functions around a
// renderer with a defect.
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

// The inputs of one point of a sweep.
struct PointSetup {
  const Settings& settings;
  const LightFrame& frame;  // make_light_frame()
  Bias bias;                // made from settings.bias; in tests of planted defects, the bias that the ladder assumes
};

struct SceneStage {
  std::unique_ptr<Scene> scene;  // the tracer refers to it
  std::string identity;          // scene_digest
  std::unique_ptr<raytrace::Tracer> tracer;
  uint64_t open_edges = 0;
};
// Also uploads the scene to the renderer. Throws Error.
SceneStage load_scene(const Settings& settings, gl::Renderer& renderer);

struct ViewStage {
  Camera camera;
  ReceiverImage receivers;
  std::map<std::string, double> metrics;  // numbers of pixels that see nothing, by reason
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

// The lookup's inputs and their truth. The truth of the taps covers one strip of the picture at a time. If all taps fit
// into one strip, the truth is kept and the rays are freed.
struct LookupStage {
  LookupProbe probe;  // for a cube with the texels of the present strip
  gl::ShadowMap exact_map;
  Image<float> exact_depth;
  std::vector<PixelRange> strips;
  std::optional<raytrace::LookupTracer> rays;
  TapTruth taps;  // of the present strip
  Image<float> edge_distance_texels;
  StageTime texel_stage, tap_stage;
};
// strip_bytes: the most memory for the truth of a strip's taps. sound: the renderer whose unit of polygon offset the
// exact map uses; it is the renderer itself except in tests of planted defects. view and truth must outlive the result.
LookupStage prepare_lookup(gl::Renderer& renderer, gl::Renderer& sound, const raytrace::Tracer& tracer,
                           const ViewStage& view, const TruthStage& truth, const PointSetup& point, size_t strip_bytes);

// What OpenGL shows: the technique on its own map, on the exact map and on the tie map.
struct ShownStage {
  Image<float> r5, r4, ties, tie_lookup;
  double time_ms = 0;  // the lookup in its own map, median of three
};
// asked: the settings of the lookup. uploaded: the settings of the maps that are uploaded. Both are the point's
// settings except in tests of planted defects.
ShownStage show(gl::Renderer& renderer, const gl::ShadowMap& map, const LookupStage& lookup, const TruthStage& truth,
                const PointSetup& point, const Settings& asked, const MapSettings& uploaded);

struct Climbed {
  Ladder ladder;
  std::map<std::string, double> soundness;  // compare/judge/soundness.h
  std::optional<BiasCounts> counts;         // if a part is varied
};
// Traces the taps strip by strip and books them. varied: the part of the bias that a curve varies, or null.
Climbed climb_strips(gl::Renderer& renderer, LookupStage& lookup, const ViewStage& view, const TruthStage& truth,
                     const Image<float>& stored_map, const ShownStage& shown, const PointSetup& point,
                     const BiasPart* varied);

}  // namespace noonmark
