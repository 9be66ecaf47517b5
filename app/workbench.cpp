#include "app/workbench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <thread>

#include "app/experiment.h"
#include "app/view_shading.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/soundness.h"
#include "compare/ladder/law_metrics.h"
#include "compare/ladder/measure.h"
#include "compare/store/quantities.h"
#include "scenes/address_space.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/error.h"
#include "scenes/library.h"
#include "scenes/scene_digest.h"
#include "technique/setting_rules.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// One value and the settings that it was computed from. Points of a sweep come in an order in which neighbours share
// most settings, so remembering the last one is enough.
template <class T>
class Remembered {
 public:
  bool has(const std::string& key) const { return value_ && key == key_; }

  template <class Make>
  T& get(const std::string& key, const Make& make) {
    if (!value_ || key != key_) {
      value_.reset();  // before making the next: these are large
      value_.emplace(make());
      key_ = key;
    }
    return *value_;
  }

 private:
  std::string key_;
  std::optional<T> value_;
};

// What a pass costs: the median of three, so that one interruption does not show.
template <class Pass>
double median_time(const Pass& pass) {
  std::array<double, 3> times;
  for (double& time : times) pass(&time);
  std::sort(times.begin(), times.end());
  return times[1];
}

struct LoadedScene {
  std::unique_ptr<Scene> scene;  // the tracer refers to it
  std::string identity;
  std::unique_ptr<raytrace::Tracer> tracer;
  uint64_t open_edges;
};

struct View {
  Camera camera;
  ReceiverImage receivers;
  std::map<std::string, double> metrics;  // why pixels see nothing
};

double scene_behind(const Scene& scene, const Camera& camera) {
  const glm::dvec3 way = camera.target_m - camera.eye_m;
  const auto behind = std::count_if(scene.positions.begin(), scene.positions.end(), [&](const glm::vec3& p) {
    return glm::dot(glm::dvec3(p) - camera.eye_m, way) <= 0;
  });
  return static_cast<double>(behind) / static_cast<double>(scene.positions.size());
}

// Drawn again without what may have hidden surfaces, and only where something may have.
View take_view(gl::Renderer& renderer, const Scene& scene, const ViewSettings& settings) {
  const Camera camera = effective_camera(scene, settings);
  const int width = settings.width_px, height = settings.height_px;
  const std::vector<uint32_t> unseen = unseen_backs(scene, camera);
  const Image<uint32_t> seen = renderer.render_primitives(camera, width, height, unseen);
  const auto pixels_more = [&](const Image<uint32_t>& more) {
    double count = 0;
    for (size_t i = 0; i < seen.size(); ++i) count += seen[i] == no_primitive && more[i] != no_primitive;
    return count;
  };
  double clipped = 0, culled = 0;
  if (std::find(seen.pixels.begin(), seen.pixels.end(), no_primitive) != seen.pixels.end()) {
    if (!unseen.empty()) culled = pixels_more(renderer.render_primitives(camera, width, height));
    const Camera fitted = with_fitted_depths(scene, camera, width, height);
    if (*camera.near_m > *fitted.near_m || *camera.far_m < *fitted.far_m)
      clipped = pixels_more(renderer.render_primitives(fitted, width, height, unseen));
  }
  return {camera,
          resolve_receivers(scene, camera, seen),
          {{"clipped", clipped}, {"culled", culled}, {"scene_behind", scene_behind(scene, camera)}}};
}

struct Truth {
  ReceiverTruth receivers;
  StageTime hard, soft;
};

struct RenderedMap {
  gl::ShadowMap map;
  Image<float> depth;  // as the lookup's sampler returns it
  double time_ms;
};

// Where all taps fit into one strip, their truth is kept for the points that share it, and the rays are not.
struct Lookup {
  LookupProbe probe;  // of a cube, with the texels of the strip at hand
  gl::ShadowMap exact_map;
  Image<float> exact_depth;
  std::optional<raytrace::LookupTracer> rays;
  std::optional<TapTruth> taps;
  Image<float> edge_distance_texels;
  StageTime texel_stage, tap_stage;
};

// What the probe and the truth of the taps depend on. A polygon offset is in units of the map's format.
std::string lookup_key_of(const Settings& settings) {
  const std::string key = settings_key(settings, {Stage::scene, Stage::view, Stage::lookup});
  return Bias(settings.bias).polygon_offset() ? key + find_setting("map.format").get(settings) : key;
}

std::string curve_key_of(const Settings& settings, const BiasPart& varied, const CurveOptions& options) {
  // All but the part's amount, which runs.
  return settings_key(settings, {Stage::scene, Stage::view, Stage::truth, Stage::map, Stage::lookup, Stage::ladder},
                      "bias." + std::string(varied.name)) +
         fmt::format("{} {} {} {}", varied.name, options.acne_bound, options.peter_panning_bound,
                     fmt::join(options.bias_depth, " "));
}

// Whole rows of the picture, as many as have their taps in so many bytes; one at least.
std::vector<PixelRange> strips_of(const Settings& settings, LightKind light, size_t strip_bytes) {
  const auto width = static_cast<size_t>(settings.view.width_px), height = static_cast<size_t>(settings.view.height_px);
  const size_t row_bytes = width * static_cast<size_t>(tap_pattern(settings.filter).taps) * bytes_per_tap(light);
  const size_t rows = std::clamp<size_t>(strip_bytes / row_bytes, 1, height);
  std::vector<PixelRange> strips;
  for (size_t row = 0; row < height; row += rows) strips.push_back({row * width, std::min(row + rows, height) * width});
  return strips;
}

Settings of_scene(const SceneSettings& scene) {
  Settings settings;
  settings.scene = scene;
  return settings;
}

}  // namespace

struct Workbench::Impl {
  Impl(gl::DebugMode debug, gl::ShaderReplacements shaders, size_t bytes)
      : renderer(debug, std::move(shaders)), strip_bytes(bytes) {}

  LoadedScene& load(const Settings& settings) {
    return scene.get(settings_key(settings, {Stage::scene}), [&] {
      auto loaded = std::make_unique<Scene>(make_scene(settings.scene));
      auto tracer = std::make_unique<raytrace::Tracer>(*loaded);
      renderer.load_scene(*loaded);
      std::string identity = scene_digest(*loaded);
      const uint64_t open_edges = tracer->open_edges();
      return LoadedScene{std::move(loaded), std::move(identity), std::move(tracer), open_edges};
    });
  }

  gl::Renderer renderer;
  size_t strip_bytes;
  AvailableMemory space_at_start;
  Remembered<LoadedScene> scene;
  Remembered<View> view;
  Remembered<Truth> truth;
  Remembered<RenderedMap> map;
  Remembered<Lookup> lookup;
  Remembered<BiasCurve> curve;
  std::string receivers_on_device;
};

namespace {

size_t ray_threads() { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); }

// Bytes of address space. Held against the peaks (VmPeak) of runs by 2, 4 and 16 threads on Debian 12, of which what
// was there before and the points' own share are taken off.
uint64_t room_to_start(bool pictures) {
  constexpr uint64_t base = uint64_t{384} << 20;  // libraries, shaders; with 2 threads it is 973 MB in all [880e6]
  // OpenImageIO: 402 MB on 2 cores [386e6]. It starts a thread for each core and some more, of which each has a stack
  // and 64 MB for its allocations.
  const uint64_t images = (uint64_t{240} << 20) + std::thread::hardware_concurrency() * (uint64_t{72} << 20);
  return base + (pictures ? images : 0) + 2 * ray_threads() * address_space_of_a_thread;
}

}  // namespace

void require_room_to_start(bool pictures) {
  require_address_space(room_to_start(pictures), fmt::format("a measurement by {} threads", ray_threads()));
}

Workbench::Workbench(gl::DebugMode debug, gl::ShaderReplacements shaders, size_t strip_bytes) {
  require_room_to_start(false);
  const AvailableMemory space = free_address_space();  // before anything is taken of it
  impl_ = std::make_unique<Impl>(debug, std::move(shaders), strip_bytes);
  impl_->space_at_start = space;
}
Workbench::~Workbench() = default;

const gl::DeviceInfo& Workbench::device() const { return impl_->renderer.info(); }

const Scene& Workbench::scene(const SceneSettings& settings) { return *impl_->load(of_scene(settings)).scene; }

const std::string& Workbench::scene_identity(const SceneSettings& settings) {
  return impl_->load(of_scene(settings)).identity;
}

MemoryEstimate Workbench::memory(const Settings& settings, bool curve, bool pictures) {
  validate(settings);
  const LoadedScene& loaded = impl_->load(settings);
  const Scene& scene = *loaded.scene;
  const LightFrame frame = make_light_frame(scene, settings);
  return estimate_memory({settings, frame.kind, scene_size(scene), loaded.open_edges,
                          outside_texels(scene, frame, settings.filter), curve, pictures});
}

AvailableMemory Workbench::memory_of_program(bool pictures) const {
  return noonmark::memory_of_program(impl_->space_at_start, room_to_start(pictures));
}

Measurement Workbench::measure(const Settings& settings, const std::optional<CurveOptions>& curve_options) {
  validate(settings);
  Impl& b = *impl_;
  const LoadedScene& loaded = b.load(settings);
  const Scene& scene = *loaded.scene;
  const LightFrame frame = make_light_frame(scene, settings);
  const Light light = effective_light(scene, settings);

  const View& view = b.view.get(settings_key(settings, {Stage::scene, Stage::view}),
                                [&] { return take_view(b.renderer, scene, settings.view); });
  const Truth& truth = b.truth.get(settings_key(settings, {Stage::scene, Stage::view, Stage::truth}), [&] {
    Truth made;
    made.receivers = loaded.tracer->receiver_truth(view.receivers, frame, {light, settings.truth.standard_error},
                                                   &made.hard, &made.soft);
    return made;
  });
  const std::string on_device = settings_key(settings, {Stage::scene, Stage::view});
  if (b.receivers_on_device != on_device) {
    b.renderer.load_receivers(view.receivers, view.camera.eye_m);
    b.receivers_on_device = on_device;
  }

  const RenderedMap& map = b.map.get(settings_key(settings, {Stage::scene, Stage::map}), [&] {
    std::optional<gl::ShadowMap> rendered;
    const double time = median_time([&](double* ms) { rendered.emplace(b.renderer.render_map(frame, settings, ms)); });
    Image<float> depth = b.renderer.read_map(*rendered);
    return RenderedMap{std::move(*rendered), std::move(depth), time};
  });
  const Bias bias(settings.bias);
  const std::vector<PixelRange> strips = strips_of(settings, frame.kind, b.strip_bytes);
  Lookup& lookup = b.lookup.get(lookup_key_of(settings), [&] {
    LookupProbe probe = b.renderer.probe(frame, settings, gl::ProbeTaps::none);
    const double offset_unit = bias.polygon_offset() ? b.renderer.polygon_offset_unit(settings.map.format) : 0;
    raytrace::LookupTracer rays =
        loaded.tracer->lookup(view.receivers, truth.receivers, frame, settings.map, bias, offset_unit);
    StageTime texel_stage;
    for (const PixelRange& strip : strips) {
      b.renderer.probe_strip(probe, frame, settings, strip);
      rays.ask(probe, strip, &texel_stage);
    }
    Image<float> depth = rays.trace_map(&texel_stage);
    gl::ShadowMap exact = b.renderer.upload_map(depth, settings.map);
    return Lookup{std::move(probe), std::move(exact),
                  std::move(depth), std::move(rays),
                  std::nullopt,     Image<float>(view.receivers.width(), view.receivers.height(), 0),
                  texel_stage,      {}};
  });

  Image<float> r5;
  const double lookup_ms = median_time([&](double* ms) { r5 = b.renderer.lookup(map.map, frame, settings, ms); });
  const Image<float> r4 = b.renderer.lookup(lookup.exact_map, frame, settings);

  if (strips.size() == 1 && !lookup.taps) {
    lookup.taps = lookup.rays->trace_taps(lookup.probe, strips[0], lookup.edge_distance_texels, &lookup.tap_stage);
    lookup.rays.reset();
  }
  TapTruth of_strip;  // where there are several
  const LookupEvidence evidence{truth.receivers,
                                lookup.probe,
                                lookup.taps ? *lookup.taps : of_strip,
                                lookup.exact_depth,
                                settings.map,
                                bias,
                                r4,
                                r5};
  const Image<float> ties = tie_map(evidence);
  const Image<float> tie_lookup = b.renderer.lookup(b.renderer.upload_map(ties, settings.map), frame, settings);
  SoundnessCheck soundness({evidence, map.depth, ties, tie_lookup, view.receivers, frame, view.camera.eye_m});
  Measurement m{{},
                settings,
                empty_ladder(view.receivers.width(), view.receivers.height()),
                frame,
                view.camera,
                scene,
                view.receivers,
                lookup.probe,
                map.depth,
                lookup.exact_depth};
  const BiasPart* const varied = curve_options ? curve_part(settings.bias) : nullptr;
  const std::string curve_key = varied ? curve_key_of(settings, *varied, *curve_options) : "";
  std::optional<BiasCounts> counts;
  if (varied && !b.curve.has(curve_key)) counts.emplace(lookup.probe, *varied);
  if (!lookup.taps) lookup.tap_stage = {};
  for (const PixelRange& strip : strips) {
    if (!lookup.taps) {
      of_strip = {};  // before the next: it is large
      b.renderer.probe_strip(lookup.probe, frame, settings, strip);
      of_strip = lookup.rays->trace_taps(lookup.probe, strip, lookup.edge_distance_texels, &lookup.tap_stage);
    }
    climb(evidence, strip, m.ladder);
    soundness.add(strip);
    if (counts) counts->add(evidence, map.depth, strip);
  }

  const Image<float> occluders = loaded.tracer->occluder_distance(view.receivers, frame, peter_panning_mask(m.ladder));
  m.record.metrics =
      measure_ladder({m.ladder, view.receivers, frame, lookup.probe, bias, lookup.edge_distance_texels, occluders});
  m.record.metrics.merge(
      measure_laws({m.ladder, scene, view.receivers, view.camera, frame, settings.map.format, lookup.probe}));
  m.record.metrics.merge(soundness.metrics());
  m.record.metrics.insert(view.metrics.begin(), view.metrics.end());
  m.record.metrics["shaded_rmse"] = shaded_rmse(
      view.receivers, frame, make_camera_frame(view.camera, view.receivers.width(), view.receivers.height()),
      m.ladder.truth(), m.ladder.shown());
  m.record.metrics["map_ms"] = map.time_ms;
  m.record.metrics["lookup_ms"] = lookup_ms;
  m.record.metrics["shadow_ms"] = map.time_ms + lookup_ms;
  m.record.worst = worst_pixel(m.ladder);
  m.record.settings = settings_map(settings);
  m.record.times = {
      {"hard_truth_ms", truth.hard.milliseconds},    {"hard_truth_rays", static_cast<double>(truth.hard.rays)},
      {"soft_truth_ms", truth.soft.milliseconds},    {"soft_truth_rays", static_cast<double>(truth.soft.rays)},
      {"texel_ms", lookup.texel_stage.milliseconds}, {"texel_rays", static_cast<double>(lookup.texel_stage.rays)},
      {"tap_ms", lookup.tap_stage.milliseconds},     {"tap_rays", static_cast<double>(lookup.tap_stage.rays)}};

  if (varied && !nothing_judged(m.record))
    m.record.curve = b.curve.get(curve_key, [&] {
      const BiasScale scale = bias_scale(frame, view.receivers, truth.receivers, settings.bias.unit);
      return summarise(*counts, scale, *curve_options);
    });
  return m;
}

}  // namespace noonmark
