#include "app/workbench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "app/experiment.h"
#include "app/view_shading.h"
#include "compare/law_metrics.h"
#include "compare/measure.h"
#include "compare/soundness.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/error.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

// One value and the settings that it was computed from. Points of a sweep come in an order in which neighbours share
// most settings, so remembering the last one is enough.
template <class T>
class Remembered {
 public:
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

// Every setting whose name begins with one of the prefixes, but for those excepted.
std::string key_of(const Settings& settings, std::initializer_list<std::string_view> prefixes,
                   std::initializer_list<std::string_view> except = {}) {
  std::string key;
  for (const Setting& row : settings_table()) {
    const auto begins = [&](std::string_view prefix) { return row.name.starts_with(prefix); };
    if (std::any_of(prefixes.begin(), prefixes.end(), begins) &&
        std::find(except.begin(), except.end(), row.name) == except.end())
      key += fmt::format("{}={}\n", row.name, row.get(settings));
  }
  return key;
}

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
  std::unique_ptr<raytrace::Tracer> tracer;
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

struct Lookup {
  LookupProbe probe;
  raytrace::LookupTruth truth;
  gl::ShadowMap exact_map;
};

// The settings that change what the probe and the truth of the taps are, beside scene, view, light and map: a form
// that only subtracts another number shares them with the others. A polygon offset is in the map, exact and drawn.
std::string offset_key(const Settings& settings) {
  return settings.bias.form == BiasForm::polygon_offset
             ? key_of(settings, {"bias.form", "bias.factor", "bias.units", "map.format"})
             : "";
}
std::string lookup_key_of(const Settings& settings, const DepthBias& bias) {
  std::string key = key_of(settings, {"scene.", "view.", "light.", "map.", "filter.", "bias.unit"},
                           {"map.lit_beyond_far", "map.format", "map.cube_pass"}) +
                    offset_key(settings);
  // What the probe has for these forms alone.
  if (bias.moves_lookup() || bias.form == BiasForm::tan || bias.tap_reference() != TapReference::own_depth)
    key += key_of(settings, {"bias.form"});
  return key + fmt::format("{}", bias.normal_offset_texels);
}

}  // namespace

struct Workbench::Impl {
  Impl(gl::DebugMode debug, gl::ShaderReplacements shaders) : renderer(debug, std::move(shaders)) {}

  LoadedScene& load(const Settings& settings) {
    return scene.get(key_of(settings, {"scene."}), [&] {
      auto loaded = std::make_unique<Scene>(make_scene(settings.scene));
      auto tracer = std::make_unique<raytrace::Tracer>(*loaded);
      renderer.load_scene(*loaded);
      return LoadedScene{std::move(loaded), std::move(tracer)};
    });
  }

  gl::Renderer renderer;
  Remembered<LoadedScene> scene;
  Remembered<View> view;
  Remembered<Truth> truth;
  Remembered<RenderedMap> map;
  Remembered<Lookup> lookup;
  Remembered<std::optional<BiasCurve>> curve;
  std::string receivers_on_device;
};

Workbench::Workbench(gl::DebugMode debug, gl::ShaderReplacements shaders)
    : impl_(std::make_unique<Impl>(debug, std::move(shaders))) {}
Workbench::~Workbench() = default;

const gl::DeviceInfo& Workbench::device() const { return impl_->renderer.info(); }

const Scene& Workbench::scene(const SceneSettings& settings) {
  Settings only_scene;
  only_scene.scene = settings;
  return *impl_->load(only_scene).scene;
}

Measurement Workbench::measure(const Settings& settings, const std::optional<CurveOptions>& curve_options) {
  validate(settings);
  Impl& b = *impl_;
  const LoadedScene& loaded = b.load(settings);
  const Scene& scene = *loaded.scene;
  const LightFrame frame = make_light_frame(scene, settings);
  const Light light = effective_light(scene, settings);

  const View& view =
      b.view.get(key_of(settings, {"scene.", "view."}), [&] { return take_view(b.renderer, scene, settings.view); });
  const Truth& truth = b.truth.get(key_of(settings, {"scene.", "view.", "light.", "truth."}), [&] {
    Truth made;
    made.receivers = loaded.tracer->receiver_truth(view.receivers, frame, {light, settings.truth.standard_error},
                                                   &made.hard, &made.soft);
    return made;
  });
  const std::string on_device = key_of(settings, {"scene.", "view."});
  if (b.receivers_on_device != on_device) {
    b.renderer.load_receivers(view.receivers, view.camera.eye_m);
    b.receivers_on_device = on_device;
  }

  const std::string map_key =
      key_of(settings, {"scene.", "light.", "map."}, {"map.lit_beyond_far"}) + offset_key(settings);
  const RenderedMap& map = b.map.get(map_key, [&] {
    std::optional<gl::ShadowMap> rendered;
    const double time = median_time([&](double* ms) { rendered.emplace(b.renderer.render_map(frame, settings, ms)); });
    Image<float> depth = b.renderer.read_map(*rendered);
    return RenderedMap{std::move(*rendered), std::move(depth), time};
  });
  const DepthBias bias = depth_bias(settings.bias);
  const std::string lookup_key = lookup_key_of(settings, bias);
  Lookup& lookup = b.lookup.get(lookup_key, [&] {
    LookupProbe probe = b.renderer.probe(frame, settings);
    const double offset_unit =
        bias.form == BiasForm::polygon_offset ? b.renderer.polygon_offset_unit(settings.map.format) : 0;
    raytrace::LookupTruth taps =
        loaded.tracer->lookup_truth(view.receivers, truth.receivers, probe, frame, settings.map, bias, offset_unit);
    gl::ShadowMap exact = b.renderer.upload_map(taps.exact_map, settings.map);
    return Lookup{std::move(probe), std::move(taps), std::move(exact)};
  });

  Image<float> r5;
  const double lookup_ms = median_time([&](double* ms) { r5 = b.renderer.lookup(map.map, frame, settings, ms); });
  const Image<float> r4 = b.renderer.lookup(lookup.exact_map, frame, settings);

  const LookupEvidence evidence{
      truth.receivers, lookup.probe, lookup.truth.taps, lookup.truth.exact_map, settings.map, bias, r4, r5};
  Measurement m{{},    settings,       climb(evidence), frame,     view.camera,
                scene, view.receivers, lookup.probe,    map.depth, lookup.truth.exact_map};

  const Image<float> occluders = loaded.tracer->occluder_distance(view.receivers, frame, peter_panning_mask(m.ladder));
  m.record.metrics = measure_ladder(
      {m.ladder, view.receivers, frame, lookup.probe, bias, lookup.truth.edge_distance_texels, occluders});
  m.record.metrics.merge(
      measure_laws({m.ladder, scene, view.receivers, view.camera, frame, settings.map.format, lookup.probe}));
  const Image<float> ties = tie_map(evidence);
  const Image<float> tie_lookup = b.renderer.lookup(b.renderer.upload_map(ties, settings.map), frame, settings);
  m.record.metrics.merge(
      measure_soundness({evidence, map.depth, ties, tie_lookup, view.receivers, frame, view.camera.eye_m}));
  m.record.metrics.insert(view.metrics.begin(), view.metrics.end());
  m.record.metrics["shaded_rmse"] = shaded_rmse(
      view.receivers, frame, make_camera_frame(view.camera, view.receivers.width(), view.receivers.height()),
      m.ladder.rung[1], m.ladder.rung[5]);
  m.record.metrics["map_ms"] = map.time_ms;
  m.record.metrics["lookup_ms"] = lookup_ms;
  m.record.metrics["shadow_ms"] = map.time_ms + lookup_ms;
  m.record.worst = worst_pixel(m.ladder);
  m.record.settings = settings_map(settings);
  m.record.times = {{"hard_truth_ms", truth.hard.milliseconds},
                    {"hard_truth_rays", static_cast<double>(truth.hard.rays)},
                    {"soft_truth_ms", truth.soft.milliseconds},
                    {"soft_truth_rays", static_cast<double>(truth.soft.rays)},
                    {"texel_ms", lookup.truth.texel_stage.milliseconds},
                    {"texel_rays", static_cast<double>(lookup.truth.texel_stage.rays)},
                    {"tap_ms", lookup.truth.tap_stage.milliseconds},
                    {"tap_rays", static_cast<double>(lookup.truth.tap_stage.rays)}};

  // A form that moves the lookup or draws another map has no threshold for each tap.
  if (const std::optional<CurveParameter> parameter = curve_parameter(settings.bias.form); curve_options && parameter) {
    // What the form holds while its parameter runs stays in the key.
    std::string key = lookup_key + key_of(settings, {"map.", "truth.", "bias.form"}) +
                      fmt::format("{} {} {}", curve_options->acne_bound, curve_options->peter_panning_bound,
                                  fmt::join(curve_options->bias_depth, " "));
    if (*parameter != CurveParameter::constant) key += key_of(settings, {"bias.floor"});
    if (*parameter == CurveParameter::tan_scale) key += key_of(settings, {"bias.cap"});
    m.record.curve = b.curve.get(key, [&] {
      return std::optional(summarise(BiasCounts(evidence, map.depth, *parameter),
                                     bias_scale(frame, view.receivers, truth.receivers, settings.bias.unit),
                                     *curve_options));
    });
  }
  return m;
}

}  // namespace noonmark
