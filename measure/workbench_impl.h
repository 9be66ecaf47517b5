// The inside of the workbench, for its own files alone: workbench.cpp (what a bench is asked besides measuring),
// workbench_measure.cpp (one point) and workbench_pictures.cpp (small pictures for a page).
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "measure/placement_stage.h"
#include "measure/stage_keys.h"
#include "measure/workbench.h"
#include "technique/cascades.h"
#include "technique/setting_rules.h"

namespace noonmark {

// One value and the settings from which it was computed. The points of a sweep come in an order in which neighbours
// share most settings, so it is enough to remember the last value.
template <class T>
class Remembered {
 public:
  bool has(const std::string& key) const { return value_ && key == key_; }

  void forget() { value_.reset(); }
  T* value() { return value_ ? &*value_ : nullptr; }

  template <class Make>
  T& get(const std::string& key, const Make& make) {
    if (!value_ || key != key_) {
      value_.reset();  // freed before the next is made, because these are large
      value_.emplace(make());
      key_ = key;
    }
    return *value_;
  }

 private:
  std::string key_;
  std::optional<T> value_;
};

// Of one map: the only one, or that of a cascade.
struct MapStages {
  Remembered<TruthStage> truth;  // of a cascade: that of its receivers alone, which the lookup's rays refer to
  Remembered<LookupStage> lookup;
};

// Of the maps of a point.
struct KeptMaps {
  std::deque<MapStages> each;  // whose addresses the stages refer to
  Remembered<MapStage> drawn;
  Remembered<std::optional<gl::ShadowMap>> exact;  // on the device, of the lookups' exact depths, once it was looked up
};

// The truth of the receivers that a cascade has a part in, and of the seam before it; the others do not face the light.
TruthStage truth_of_cascade(const TruthStage& all, const ChosenCascades& choice, int cascade);

// One map of a point: what it shows to its receivers, and why. truth: of these receivers.
struct OneMap {
  LookupStage& lookup;
  const Technique& technique;
  const TruthStage& truth;
  MapDepths stored;  // the drawn map as the lookup's sampler returns it
  Climbed climbed;
};

// The cascades of the receivers as the lookup chooses them, how far that is off (compare/results/metrics.cpp:
// cascade_choice_excess).
struct ChoiceStage {
  ChosenCascades chosen;
  double excess = 0;
};

// What a curve says, and of each cascade the least amount of the varied part from which on it has no acne.
struct CurveStage {
  BiasCurve curve;
  std::vector<double> needed_by_cascade;
};

struct Workbench::Impl {
  Impl(gl::DebugMode debug, gl::ShaderReplacements shaders, std::unique_ptr<Pipeline> all)
      : renderer(debug, std::move(shaders)), stages(std::move(all)) {}

  const SceneStage& load(const Settings& settings) { return load(settings, scene_key_of(settings)); }
  const SceneStage& load(const Settings& settings, const std::string& key) {
    if (!scene.has(key)) forget_scene();
    return scene.get(key, [&] { return stages->load_scene(renderer, settings); });
  }

  // The other stages depend on the scene; the rays of a lookup in strips even refer to its tracer.
  void forget_scene() {
    forget_maps();
    chosen.forget();
    truth.forget();
    view.forget();
    curve.forget();
    footprint.forget();
    receivers_on_device.clear();
  }

  struct Asked {
    const SceneStage& loaded;
    Technique technique;
    StageKeys keys;
  };
  // The settings' scene, loaded, and what the settings mean there. Throws before the scene is loaded where it can.
  Asked begin(const Settings& settings) {
    validate(settings);
    StageKeys keys(settings);
    const SceneStage& loaded = load(settings, keys.scene);
    return {loaded, Technique(*loaded.scene, settings), std::move(keys)};
  }

  MemoryEstimate memory(const Settings& settings, bool curve, bool pictures);
  AvailableMemory memory_of_program(bool pictures) const;

  struct Looked {
    const ViewStage& view;
    const TruthStage& truth;
  };
  // The receivers, which are then on the device.
  const ViewStage& see(const Asked& asked) {
    const ViewStage& seen = view.get(asked.keys.view, [&] {
      return stages->take_view(renderer, *asked.loaded.scene, asked.technique.settings.view);
    });
    if (receivers_on_device != asked.keys.view) {
      renderer.load_receivers(seen.receivers, seen.camera.eye_m);
      receivers_on_device = asked.keys.view;
    }
    return seen;
  }
  // The receivers and their truth.
  Looked look(const Asked& asked) {
    const ViewStage& seen = see(asked);
    return {seen,
            truth.get(asked.keys.truth, [&] { return stages->trace_truth(asked.loaded, seen, asked.technique); })};
  }

  // What is remembered of `count` maps.
  KeptMaps& of_maps(size_t count) {
    maps.each.resize(count);
    return maps;
  }
  void forget_maps() {
    maps.each.clear();
    maps.drawn.forget();
    maps.exact.forget();
  }

  // The map of a point, or those of its cascades.
  MapStage& drawn(KeptMaps& of, const Scene& drawn_scene, std::span<const Technique> techniques,
                  const std::string& key) {
    MapStage& stage = of.drawn.get(key, [&] { return stages->draw_maps(renderer, drawn_scene, techniques); });
    if (!stage.map) stage.map = stages->draw_maps(renderer, drawn_scene, techniques).map;
    return stage;
  }

  // The cascades of the receivers.
  const ChoiceStage& choose(const Asked& asked, const ViewStage& seen, const Technique& of_any_cascade);

  // The truth of the receivers of this map: of a cascade those that it has a part in, and those of the seam before it.
  const TruthStage& truth_of(const Asked& asked, const Looked& looked, MapStages& kept, const Technique& technique);

  // The lookups of all maps, and what OpenGL shows in them. truths: of each map. of_receivers: null with one map.
  ShownMaps show_maps(const Asked& asked, const ViewStage& seen, KeptMaps& kept,
                      std::span<const TruthStage* const> truths, std::span<const Technique> techniques,
                      const ChosenCascades* of_receivers, MetricSet metrics, bool keep_fetched = false,
                      Checks checks = Checks::all);

  // Frees the receivers of a large picture on the device; see() brings them back.
  void free_large_picture(const ReceiverImage& receivers) {
    if (receivers.primitive.size() <= most_kept_pixels) return;
    renderer.release_receivers();
    receivers_on_device.clear();
  }

  // Frees maps that were drawn again for pictures, and that have no room beside what a probe needs.
  void free_large_maps(KeptMaps& of) {
    if (MapStage* const kept = of.drawn.value()) keep_small(renderer, kept->map);
  }

  struct WorstPlacement {
    double error_shown = 0;  // mean |R5 - R1| over the map's receivers
    std::map<std::string, double> soundness;
  };
  WorstPlacement render_worst(const Asked& asked, const ViewStage& seen, const OneMap& map, PlacementStage& placements,
                              Checks checks);
  void add_placements(PointRecord& record, std::span<const OneMap> maps,
                      std::span<const std::unique_ptr<PlacementStage>> placements,
                      std::map<std::string, double> of_maps, const ViewStage& seen, const Asked& asked, Checks checks);

  struct SmallPicture;
  LivePicture draw_live(const SceneStage& loaded, const Settings& settings);
  PictureStack draw_stack(const SceneStage& loaded, const Settings& settings, const std::vector<double>& marks);
  // Draws the settings' view with few pixels, for a page: draw(settings) with the number of pixels that the report's live
  // picture may have, and with fewer until its file, write(drawn), is small enough.
  template <class Draw, class Write>
  auto draw_small(const Settings& settings, const Draw& draw, const Write& write);

  gl::Renderer renderer;
  std::unique_ptr<Pipeline> stages;
  AvailableMemory space_at_start;
  Remembered<SceneStage> scene;
  Remembered<ViewStage> view;
  Remembered<TruthStage> truth;
  KeptMaps maps;
  Remembered<ChoiceStage> chosen;
  Remembered<CurveStage> curve;
  Remembered<std::map<std::string, double>> footprint;  // metrics of the texels' size in the picture
  std::string receivers_on_device;
};

}  // namespace noonmark
