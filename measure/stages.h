// measure/: one point, measured: gl, raytrace and compare joined, what consecutive points share, placements, flicker, phase
// diagrams, times, and how much memory a point takes. Knows no experiment file, no store, no report. Begin here, then
// measure/workbench.h.
//
// The stages of a measurement, each from named inputs to a small type:
//
// scene → view → truth → map → lookup → shown → ladder
//
// Workbench::measure() alone joins them, and it keeps the results that consecutive points share. The settings' rows name
// the stages that read them (technique/settings.h). A test replaces a stage by deriving from Pipeline, and measures
// through the same Workbench:
//
//   struct AllDark : Pipeline {
//     MapResults look_up(gl::Renderer& renderer, const gl::ShadowMap& map, std::span<const Technique> techniques) override {
//       MapResults results = Pipeline::look_up(renderer, map, techniques);
//       std::fill(results.own.pixels.begin(), results.own.pixels.end(), 0.0f);
//       return results;
//     }
//   };
//   Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<AllDark>());
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/judge/moment_contract.h"
#include "compare/judge/soundness.h"
#include "compare/ladder/bias_curves.h"
#include "compare/ladder/ladder.h"
#include "compare/ladder/moment_climb.h"
#include "compare/ladder/reduction_window.h"
#include "gl/renderer.h"
#include "measure/memory_estimate.h"
#include "raytrace/tracer.h"
#include "technique/point_maps.h"
#include "technique/technique.h"

namespace noonmark {

struct SceneStage {
  std::unique_ptr<Scene> scene;  // the tracer refers to it
  std::string identity;          // scene_digest
  std::unique_ptr<raytrace::Tracer> tracer;
  uint64_t open_edges = 0;
  std::vector<uint32_t> surfaces;  // surfaces_of()
};

struct ViewStage {
  Camera camera;
  ReceiverImage receivers;
  std::map<std::string, double> metrics;  // numbers of pixels that see nothing, by reason
};

struct TruthStage {
  ReceiverTruth receivers;  // R1 and R0
  StageTime hard, soft;
};

struct MapStage {
  std::optional<gl::ShadowMap> map;  // all maps of the point; none after show(), if one is too large to be kept
  std::optional<int64_t> used;       // gl::Renderer::used_texels, once they have been counted
};

// Frees the maps if one of them is larger than what is kept (most_kept_map_bytes).
void keep_small(gl::Renderer& renderer, std::optional<gl::ShadowMap>& map);

// The lookup's inputs and their truth. The truth of the taps covers one strip of the picture at a time. If all taps fit
// into one strip, the truth is kept and the rays are freed.
struct LookupStage {
  LookupProbe probe;      // for a cube with the texels of the present strip
  MapDepths exact_depth;  // at the texels that the taps of facing receivers read
  std::vector<PixelRange> strips;
  std::optional<raytrace::LookupTracer> rays;
  TapTruth taps;  // of the present strip
  Image<float> edge_distance_texels;
  StageTime texel_stage, tap_stage;
  TruthAnswers texel_answers{};
  size_t seen_texels = 0;  // those of exact_depth that receivers read whose result the map has a part in
  // What climb_strips() found when it checked the probe, and whether the bias read tan(theta) then. The amounts of a bias of
  // the compared depth change nothing else that ProbeCheck compares, so the probe is compared once for all of them. A part of
  // the bias that reads another number of the probe must be told apart here too.
  std::optional<std::pair<ProbeErrors, bool>> checked_probe{};
  // Of a lookup in a map of moments that is climbed several times with no other change than its reduction: if it is there and
  // empty, climb_strips() writes what it finds of each pixel, and afterwards climbs from that, without taps.
  std::optional<std::vector<MomentSteps>> kept_steps{};
};

// Whether a measurement checks its renderer too (compare/judge/soundness.h). With none OpenGL draws the maps and looks them
// up (R5) as always. But R4 of a lookup that compares depths is computed from the taps, and no number of the renderer is
// compared with its definition. So measures a search, and a small picture of a page; what verifies the answer of a search is
// checked.
enum class Checks { all, none };

// What OpenGL shows in one map: the technique on its own map, on the exact map and on the tie map.
struct ShownStage {
  Checks checks = Checks::all;  // with none there is no tie map, and r4 only of a map of moments
  Image<float> r5, r4, tie_lookup;
  MapDepths stored;  // the drawn map as the lookup's sampler returns it
  MapDepths ties;
  MomentContractCounts moments{};  // of a lookup in a map of moments, which has no tie map
  Image<glm::vec4> fetched{};      // the moments that its lookups fetched; empty unless asked for
};

// The same in all maps of a point, each kind of them looked up in one pass.
struct ShownMaps {
  Checks checks = Checks::all;
  MapResults r5, r4, tie_lookup;
  std::vector<MapDepths> stored, ties;  // of each map
  std::vector<MomentContractCounts> moments;
  std::vector<Image<glm::vec4>> fetched;  // from the drawn maps of moments; empty unless asked for

  // What is shown in one of them, whose depths it takes.
  ShownStage take(const MapChoice& choice, size_t map);
};

// A map with what is asked of it. All of it outlives the call that it is given to.
struct AskedMap {
  LookupStage& lookup;
  const TruthStage& truth;
};

struct Climbed {
  Ladder ladder;
  std::map<std::string, double> soundness;  // compare/judge/soundness.h; empty with Checks::none
  std::optional<BiasCounts> counts;         // if a part is varied
  TruthAnswers tap_answers{};
  ReductionWindow reductions{};  // of a lookup in a map of moments
};

using EachStrip = std::function<void(const LookupEvidence&, PixelRange)>;
using WhileStrip = std::function<bool(const LookupEvidence&, PixelRange)>;

// The whole picture, if the truth of its taps takes at most kept_bytes. Otherwise strips of whole rows: as many as have
// room for their taps in a sixteenth of that (strips_in_kept_taps), at least one.
std::vector<PixelRange> strips_of(const Technique& technique, size_t kept_bytes);

// Traces the taps of a lookup strip by strip. The evidence has no pictures of OpenGL: its r4 and r5 are empty.
void each_strip_of(gl::Renderer& renderer, LookupStage& lookup, const TruthStage& truth, const Technique& technique,
                   const EachStrip& each_strip);
// The same until go_on() is false. Returns whether it never was.
bool each_strip_while(gl::Renderer& renderer, LookupStage& lookup, const TruthStage& truth, const Technique& technique,
                      const WhileStrip& go_on);

// The casters of the technique's maps, if the bias moves them. The scene must outlive the result.
gl::Renderer::CastersOf casters_of(const Scene& scene, const Technique& technique);

// gl::Renderer::polygon_offset_unit, or 0 if the bias has no polygon offset.
double polygon_offset_unit(gl::Renderer& renderer, const Technique& technique);

// Each virtual method is one stage as the program runs it. What a stage is given must outlive its result.
class Pipeline {
 public:
  // kept_bytes: the most memory for the truth of all taps (strips_of). It changes no result.
  explicit Pipeline(size_t kept_bytes = most_kept_tap_bytes) : kept_bytes_(kept_bytes) {}
  virtual ~Pipeline() = default;

  // Also uploads the scene to the renderer. Throws Error.
  virtual SceneStage load_scene(gl::Renderer& renderer, const Settings& settings);
  virtual ViewStage take_view(gl::Renderer& renderer, const Scene& scene, const ViewSettings& settings);
  virtual TruthStage trace_truth(const SceneStage& scene, const ViewStage& view, const Technique& technique);
  // scene: as the renderer has it.
  virtual MapStage draw_maps(gl::Renderer& renderer, const Scene& scene, std::span<const Technique> techniques);
  MapStage draw_map(gl::Renderer& renderer, const Scene& scene, const Technique& technique) {
    return draw_maps(renderer, scene, {&technique, 1});
  }
  virtual LookupStage prepare_lookup(gl::Renderer& renderer, const raytrace::Tracer& tracer, const ViewStage& view,
                                     const TruthStage& truth, const Technique& technique);
  // One lookup of all receivers, in all maps. show_maps() calls it for the drawn, the exact and the tie maps.
  virtual MapResults look_up(gl::Renderer& renderer, const gl::ShadowMap& map, std::span<const Technique> techniques);
  // map: has its maps; afterwards they and the exact maps on the device are kept only if they are small. exact_map: those of
  // an earlier call for the same lookups, or none. keep_fetched: of maps of moments. checks: what
  // only they read is left out with none, and climb_strips() leaves them out too.
  ShownMaps show_maps(gl::Renderer& renderer, MapStage& map, std::optional<gl::ShadowMap>& exact_map,
                      std::span<const AskedMap> asked, std::span<const Technique> techniques, const MapChoice& choice,
                      bool keep_fetched = false, Checks checks = Checks::all);
  // The same of one map, whose exact map is not kept.
  ShownStage show(gl::Renderer& renderer, MapStage& map, LookupStage& lookup, const TruthStage& truth,
                  const Technique& technique);
  // Traces the taps strip by strip and books them, and checks what `shown` has been checked for. varied: the part of the bias that
  // a curve varies, or null; it needs all checks.
  // each_strip: called for each strip while its taps are at hand, or empty.
  virtual Climbed climb_strips(gl::Renderer& renderer, LookupStage& lookup, const ViewStage& view,
                               const TruthStage& truth, const ShownStage& shown, const Technique& technique,
                               const BiasPart* varied, const EachStrip& each_strip = {});

 private:
  size_t kept_bytes_;
};

}  // namespace noonmark
