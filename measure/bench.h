// The inside of the workbench, for its own files alone: workbench.cpp (what a bench is asked besides measuring),
// workbench_measure.cpp (one point: its maps, joined), point_record.cpp (the numbers of its ladder), extra.h (what else it was
// asked for) and workbench_pictures.cpp (small pictures for a page).
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "measure/stage_keys.h"
#include "measure/stages.h"
#include "measure/workbench.h"
#include "technique/point_maps.h"
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

// Of one map of a point.
struct MapStages {
  Remembered<TruthStage> truth;  // of several maps: that of its receivers alone, which the lookup's rays refer to
  Remembered<LookupStage> lookup;
};

// Of the maps of a point.
struct KeptMaps {
  std::deque<MapStages> each;  // whose addresses the stages refer to
  Remembered<MapStage> drawn;
  Remembered<std::optional<gl::ShadowMap>> exact;  // on the device, of the lookups' exact depths, once it was looked up
};

// The truth of the receivers that one of several maps has a part in, and of the seam before it; the others do not face the light.
TruthStage truth_of_map(const TruthStage& all, const MapChoice& choice, int map);

// In which map each receiver is looked up, as the lookup chooses it, and how far that is off; 0 of one map.
struct ChoiceStage {
  MapChoice chosen;
  double excess = 0;
};

// The maps of a point, each with the truth of its receivers.
struct PointMaps {
  std::shared_ptr<const std::vector<Technique>> all;
  const ChoiceStage& choice;
  std::vector<const TruthStage*> truths;

  const std::vector<Technique>& techniques() const { return *all; }
  size_t count() const { return all->size(); }
};

// What one of them shows to its receivers, and why.
struct ClimbedMap {
  LookupStage& lookup;
  const Technique& technique;
  const TruthStage& truth;
  MapDepths stored;  // the drawn map as the lookup's sampler returns it
  Climbed climbed;
};

// What a curve says, and of each map the least amount of the varied part from which on it has no acne.
struct CurveStage {
  BiasCurve curve;
  std::vector<double> needed;
};

struct Extras;

struct Bench {
  Bench(gl::DebugMode debug, gl::ShaderReplacements shaders, std::unique_ptr<Pipeline> all)
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

  // The drawn maps of a point.
  MapStage& drawn(KeptMaps& of, const Scene& drawn_scene, std::span<const Technique> techniques,
                  const std::string& key) {
    MapStage& stage = of.drawn.get(key, [&] { return stages->draw_maps(renderer, drawn_scene, techniques); });
    if (!stage.map) stage.map = stages->draw_maps(renderer, drawn_scene, techniques).map;
    return stage;
  }

  // The maps of the point.
  PointMaps maps_of(const Asked& asked, const Looked& looked);

  // The lookups of all maps, and what OpenGL shows in them.
  ShownMaps show_maps(const Asked& asked, const ViewStage& seen, KeptMaps& kept, const PointMaps& maps,
                      MetricSet metrics, bool keep_fetched = false, Checks checks = Checks::all);

  // Computes the ladder of each map of a point. While the taps of a map are in memory, each of the extras reads them.
  std::vector<ClimbedMap> climb(const Asked& asked, const ViewStage& seen, const PointMaps& maps, Extras& extras,
                                MetricSet metrics, Checks checks);

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
