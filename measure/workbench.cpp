#include "measure/workbench.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "base/address_space.h"
#include "base/error.h"
#include "base/threads.h"
#include "compare/judge/poor_view.h"
#include "compare/ladder/law_metrics.h"
#include "compare/ladder/measure.h"
#include "compare/results/quantities.h"
#include "measure/flicker_stage.h"
#include "measure/placement_stage.h"
#include "measure/stage_keys.h"
#include "measure/texel_footprint.h"
#include "measure/view_shading.h"
#include "scenes/camera_frame.h"
#include "scenes/scene_size.h"
#include "technique/cost.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// Of the file of a live picture or of a stack of pictures. The page holds it as base64, with a third more bytes, and shall stay below 4 MB.
constexpr size_t most_live_bytes = 2'000'000;

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

void add_cost(PointRecord& record, const FrameCost& cost) {
  record.metrics.insert({{"texel_work", static_cast<double>(cost.texel_work)},
                         {"traffic_bytes", static_cast<double>(cost.traffic_bytes)},
                         {"map_bytes", static_cast<double>(cost.map_bytes)},
                         {"map_texels", static_cast<double>(cost.map_texels)},
                         {"map_triangles", static_cast<double>(cost.map_triangles)},
                         {"lookup_fetches", static_cast<double>(cost.lookup.fetches)},
                         {"lookup_texels", static_cast<double>(cost.lookup.texels)},
                         {"lookup_operations", static_cast<double>(cost.lookup.operations)}});
}

void add_time(PointRecord& record, const std::string& stage, const StageTime& time) {
  record.times[stage + "_ms"] = time.milliseconds;
  record.times[stage + "_rays"] = static_cast<double>(time.rays);
}

// What share of the truth was found how. Without a receiver that faces the light nothing was asked.
void add_answers(PointRecord& record, const TruthAnswers& receivers, const TruthAnswers& texels,
                 const TruthAnswers& taps) {
  TruthAnswers answers = receivers;
  answers += texels;
  answers += taps;
  const auto share = [&](uint64_t some) {
    return answers.all() == 0 ? 0 : static_cast<double>(some) / static_cast<double>(answers.all());
  };
  record.metrics["truth_by_cells"] = share(answers.cells);
  record.metrics["truth_by_rays"] = share(answers.rays);
  record.metrics["truth_by_scan"] = share(answers.scan);
}

// The point's numbers and times, without its curve.
PointRecord record_of(const Measurement& m, const SceneStage& loaded, const ViewStage& view, const TruthStage& truth,
                      const LookupStage& lookup, const std::map<std::string, double>& soundness, MetricSet metrics) {
  const Technique& t = m.technique;
  const Image<float> occluders = loaded.tracer->occluder_distance(m.receivers, t.frame, peter_panning_mask(m.ladder));
  PointRecord record;
  record.settings = settings_map(t.settings);
  const MeasureInput input{m.ladder,  m.receivers,       t.frame,        m.probe, t.bias, lookup.edge_distance_texels,
                           occluders, t.moves_casters(), loaded.surfaces};
  record.metrics = measure_ladder(input);
  record.metrics.merge(
      measure_laws({m.ladder, m.scene, m.receivers, m.camera, t.frame, t.settings.map.format, m.probe}));
  record.metrics.insert(soundness.begin(), soundness.end());
  record.metrics.insert(view.metrics.begin(), view.metrics.end());
  if (metrics == MetricSet::all) {
    const CameraFrame camera = make_camera_frame(m.camera, m.receivers.width(), m.receivers.height());
    record.metrics["shaded_rmse"] = shaded_rmse(m.receivers, t.frame, camera, m.ladder.truth(), m.ladder.shown());
    record.metrics["flip"] = shaded_flip(m.receivers, t.frame, camera, m.ladder.truth(), m.ladder.shown());
    record.metrics.merge(footprint_metrics(texel_footprint(m.receivers, camera, t.frame, truth.receivers.facing)));
  }
  add_cost(record,
           frame_cost(t.settings, t.frame.tiles, t.frame.texels(), static_cast<int64_t>(record.metrics["facing"]),
                      static_cast<int64_t>(m.scene.triangles.size())));
  add_time(record, "hard_truth", truth.hard);
  add_time(record, "soft_truth", truth.soft);
  add_time(record, "texel", lookup.texel_stage);
  add_time(record, "tap", lookup.tap_stage);
  record.causes = m.ladder.brought;
  record.worst = worst_pixel(m.ladder);
  record.worst_of = worst_pixels(input);
  return record;
}

Settings of_scene(const SceneSettings& scene) {
  Settings settings;
  settings.scene = scene;
  return settings;
}

}  // namespace

MetricSet metric_set_for(std::string_view metric) {
  constexpr std::string_view not_searched[] = {
      "shaded_rmse", "flip", "map_used", "undersampled", "perspective_aliasing", "perspective_aliasing_p95"};
  const bool searched = std::find(std::begin(not_searched), std::end(not_searched), metric) == std::end(not_searched);
  return searched ? MetricSet::searched : MetricSet::all;
}

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
    lookup.forget();
    map.forget();
    truth.forget();
    view.forget();
    curve.forget();
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

  // The map of a point.
  MapStage& drawn(const Scene& drawn_scene, const Technique& technique, const std::string& key) {
    MapStage& stage = map.get(key, [&] { return stages->draw_map(renderer, drawn_scene, technique); });
    if (!stage.map) stage.map = stages->draw_map(renderer, drawn_scene, technique).map;
    return stage;
  }

  // Frees the receivers of a large picture on the device; see() brings them back.
  void free_large_picture(const ReceiverImage& receivers) {
    if (receivers.primitive.size() <= most_kept_pixels) return;
    renderer.release_receivers();
    receivers_on_device.clear();
  }

  // Frees a map that was drawn again for pictures, and that has no room beside what a probe needs.
  void free_large_map() {
    if (MapStage* const kept = map.value()) keep_small(renderer, kept->map);
  }

  void add_placements(PointRecord& record, PlacementStage& placements, const Looked& looked, const Asked& asked);

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
  Remembered<MapStage> map;
  Remembered<LookupStage> lookup;
  Remembered<BiasCurve> curve;
  std::string receivers_on_device;
};

namespace {

size_t ray_threads() { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); }

// Bytes of address space. Compared with the peaks (VmPeak) of runs with 2, 4 and 16 threads on Debian 12, minus the
// space that was used before and the points' own share.
uint64_t room_to_start(bool pictures) {
  constexpr uint64_t base = uint64_t{384} << 20;  // libraries, shaders; with 2 threads it is 973 MB in all [880e6]
  // Those of OpenEXR have a stack each, and 64 MB for allocations.
  const uint64_t images = std::min<uint64_t>(ray_threads(), most_image_threads) * (uint64_t{72} << 20);
  return base + (pictures ? images : 0) + 2 * ray_threads() * address_space_of_a_thread;
}

}  // namespace

void require_room_to_start(bool pictures) {
  require_address_space(room_to_start(pictures), fmt::format("a measurement by {} threads", ray_threads()));
}

Workbench::Workbench(gl::DebugMode debug, gl::ShaderReplacements shaders, std::unique_ptr<Pipeline> stages) {
  require_room_to_start(false);
  const AvailableMemory space = free_address_space();  // read before any of it is used
  impl_ = std::make_unique<Impl>(debug, std::move(shaders), std::move(stages));
  impl_->space_at_start = space;
}
Workbench::~Workbench() = default;

const gl::DeviceInfo& Workbench::device() const { return impl_->renderer.info(); }

const Scene& Workbench::scene(const SceneSettings& settings) { return *impl_->load(of_scene(settings)).scene; }

const std::string& Workbench::scene_identity(const SceneSettings& settings) {
  return impl_->load(of_scene(settings)).identity;
}

MemoryEstimate Workbench::memory(const Settings& settings, bool curve, bool pictures) {
  const Impl::Asked asked = impl_->begin(settings);
  const Scene& scene = *asked.loaded.scene;
  return estimate_memory({settings, asked.technique.frame.kind, scene_size(scene), asked.loaded.open_edges,
                          outside_texels(scene, asked.technique), curve, pictures});
}

AvailableMemory Workbench::memory_of_program(bool pictures) const {
  return noonmark::memory_of_program(impl_->space_at_start, room_to_start(pictures));
}

// Adds the metrics over all placements. OpenGL renders the worst placement too: the counts are compared with it, and what
// it shows there is a metric of its own.
void Workbench::Impl::add_placements(PointRecord& record, PlacementStage& placements, const Looked& looked,
                                     const Asked& asked) {
  const auto& [seen, traced] = looked;
  see(asked);
  const int worst = worst_placement(placements.counts());
  record.metrics.merge(placement_metrics(placements.counts(), placements.facts(worst)));
  const Technique moved = asked.technique.at(placements.frame(worst));
  const SceneStage& loaded = asked.loaded;
  LookupStage lookup_there = stages->prepare_lookup(renderer, *loaded.tracer, seen, traced, moved);
  MapStage drawn = stages->draw_map(renderer, *loaded.scene, moved);
  const ShownStage shown = stages->show(renderer, drawn, lookup_there, traced, moved);
  const Climbed climbed = stages->climb_strips(
      renderer, lookup_there, seen, traced, shown, moved, nullptr,
      [&](const LookupEvidence& evidence, PixelRange strip) { placements.compare(evidence, worst, strip); });
  record.metrics["error_worst_shown"] = error_of(climbed.ladder);
  record.metrics["placement_disagreements"] = static_cast<double>(placements.disagreements());
  // A defect that only the worst placement shows makes the point unsound too.
  std::map<std::string, double> there = climbed.soundness;
  there["residual"] = climbed.ladder.residual;
  there["tap_residual"] = climbed.ladder.tap_residual;
  for (const SoundLimit& limit : sound_limits)
    if (const auto value = there.find(limit.metric); value != there.end())
      if (double& found = record.metrics[limit.metric]; !(value->second <= found)) found = value->second;
  add_time(record, "placement", placements.time());
}

PhaseDiagram Workbench::phase(const Settings& settings, const PhaseOptions& options, const PhaseDiagram* measured,
                              const RowDone& row_done) {
  const Impl::Asked asked = impl_->begin(settings);
  const SceneStage& loaded = asked.loaded;
  const auto [view, truth] = impl_->look(asked);
  if (measured) return rejudged_phase(*measured, *loaded.scene, view, truth, settings, options);
  return measure_phase(impl_->renderer, *loaded.tracer, *loaded.scene, view, truth, settings, options, row_done);
}

std::vector<PhasePlace> Workbench::places(const Settings& picture, std::span<const Settings> points) {
  const Impl::Asked asked = impl_->begin(picture);
  const SceneStage& loaded = asked.loaded;
  const auto [view, truth] = impl_->look(asked);
  // Each place reads medians over the receivers, and the points of a sweep share most of their maps.
  std::map<std::string, PhasePlace> of_one_unit;
  std::vector<PhasePlace> places;
  for (const Settings& point : points) {
    Settings one = point;
    one.bias["constant"] = 1;
    std::string key = find_setting("bias.unit").get(one);
    for (const Setting& row : settings_table())
      if (row.name.starts_with("map.")) key += " " + row.get(one);
    auto known = of_one_unit.find(key);
    if (known == of_one_unit.end())
      known = of_one_unit.emplace(key, phase_place(*loaded.scene, view, truth, one)).first;
    places.push_back({known->second.texel_m, known->second.bias_m * point.bias["constant"]});
  }
  return places;
}

// One attempt at a live picture, of the picture's size in the settings.
LivePicture Workbench::Impl::draw_live(const SceneStage& loaded, const Settings& settings) {
  const Technique technique(*loaded.scene, settings);
  const ViewStage seen = stages->take_view(renderer, *loaded.scene, settings.view);
  const TruthStage traced = stages->trace_truth(loaded, seen, technique);
  renderer.load_receivers(seen.receivers, seen.camera.eye_m);
  LookupStage asked = stages->prepare_lookup(renderer, *loaded.tracer, seen, traced, technique);
  const MapDepths stored =
      renderer.read_map(*stages->draw_map(renderer, *loaded.scene, technique).map, asked.exact_depth.texels);
  const BiasPart& varied = *curve_part(settings.bias);
  LivePicture picture = empty_live_picture(seen.receivers.width(), seen.receivers.height());
  picture.taps = asked.probe.taps();
  picture.parameter = "bias." + std::string(varied.name);
  picture.unit = find_setting("bias.unit").get(settings);
  picture.scale = bias_scale(technique.frame, seen.receivers, traced.receivers, settings.bias.unit);
  for (size_t i = 0; i < picture.flags.size(); ++i)
    if (seen.receivers.primitive[i] != no_primitive) picture.flags[i] = live_surface;
  each_strip_of(renderer, asked, traced, technique, [&](const LookupEvidence& evidence, PixelRange strip) {
    add_live_strip(picture, evidence, stored, settings.bias, varied, strip);
  });
  return picture;
}

// One attempt at a stack of pictures. As in draw_live, nothing that the bench remembers is replaced, because the next
// point has a picture of full size again.
PictureStack Workbench::Impl::draw_stack(const SceneStage& loaded, const Settings& settings,
                                         const std::vector<double>& marks) {
  const BiasPart& part = stacked_part(settings.bias);
  const Technique as_set(*loaded.scene, settings);
  const ViewStage seen = stages->take_view(renderer, *loaded.scene, settings.view);
  const TruthStage traced = stages->trace_truth(loaded, seen, as_set);
  renderer.load_receivers(seen.receivers, seen.camera.eye_m);
  std::optional<BiasScale> scale;
  double otherwise = 1;
  if (part.acts_on == BiasTarget::compared_depth) {
    scale = bias_scale(as_set.frame, seen.receivers, traced.receivers, settings.bias.unit);
    otherwise = 1 / (scale->texels_per_depth * scale->depth_per_unit);
  }
  Remembered<LookupStage> lookup_stage;
  Remembered<MapStage> map_stage;
  std::optional<PictureStack> stack;
  Settings at = settings;
  for (const double value : stack_values(part, settings.bias[part.name], marks, otherwise)) {
    at.bias[part.name] = value;
    const StageKeys keys(at);
    const Technique technique(*loaded.scene, at);
    LookupStage& asked = lookup_stage.get(
        keys.lookup, [&] { return stages->prepare_lookup(renderer, *loaded.tracer, seen, traced, technique); });
    const auto draw_map = [&] { return stages->draw_map(renderer, *loaded.scene, technique); };
    MapStage& drawn = map_stage.get(keys.map, draw_map);
    if (!drawn.map) drawn = draw_map();
    const ShownStage shown = stages->show(renderer, drawn, asked, traced, technique);
    const Climbed climbed = stages->climb_strips(renderer, asked, seen, traced, shown, technique, nullptr);
    if (!stack) stack = empty_picture_stack(seen.receivers, traced.receivers, asked.probe);
    add_picture(*stack, value, climbed.ladder);
  }
  stack->parameter = "bias." + std::string(part.name);
  stack->unit = part.unit == "bias.unit" ? find_setting("bias.unit").get(settings) : std::string(part.unit);
  stack->why = why_no_live_picture(settings);
  stack->scale = scale;
  return *stack;
}

template <class Draw, class Write>
auto Workbench::Impl::draw_small(const Settings& settings, const Draw& draw, const Write& write) {
  const SceneStage& loaded = load(settings);
  // The picture needs a map and a lookup of its own. There may be no memory for two of each.
  lookup.forget();
  map.forget();
  receivers_on_device.clear();
  Settings small = settings;
  const double shrink = std::min({1.0, static_cast<double>(most_live_width_px) / small.view.width_px,
                                  static_cast<double>(most_live_height_px) / small.view.height_px});
  for (double size = shrink;; size /= 2) {
    small.view.width_px = std::max(1, static_cast<int>(settings.view.width_px * size));
    small.view.height_px = std::max(1, static_cast<int>(settings.view.height_px * size));
    auto drawn = draw(loaded, small);
    if (write(drawn).size() <= most_live_bytes || small.view.width_px * small.view.height_px == 1) return drawn;
  }
}

std::optional<LivePicture> Workbench::live_picture(const Settings& settings) {
  validate(settings);
  if (!why_no_live_picture(settings).empty()) return std::nullopt;
  return impl_->draw_small(
      settings, [&](const SceneStage& loaded, const Settings& small) { return impl_->draw_live(loaded, small); },
      live_file);
}

PictureStack Workbench::picture_stack(const Settings& settings, const std::vector<double>& marks) {
  validate(settings);
  return impl_->draw_small(
      settings,
      [&](const SceneStage& loaded, const Settings& small) { return impl_->draw_stack(loaded, small, marks); },
      stack_file);
}

std::vector<ReceiverSection> Workbench::sections(const Measurement& m, std::span<const glm::ivec2> pixels) {
  Impl& b = *impl_;
  const Impl::Asked asked = b.begin(m.technique.settings);
  const Impl::Looked looked = b.look(asked);
  LookupStage& lookup = b.lookup.get(asked.keys.lookup, [&] {
    return b.stages->prepare_lookup(b.renderer, *asked.loaded.tracer, looked.view, looked.truth, asked.technique);
  });
  std::vector<std::optional<ReceiverSection>> found(pixels.size());
  const auto cut = [&](const LookupEvidence& evidence, PixelRange strip) {
    for (size_t k = 0; k < pixels.size(); ++k) {
      const glm::ivec2 pixel = pixels[k];
      // section_of() says what is wrong with a pixel outside the picture.
      const bool outside = !inside_map(pixel, {m.receivers.width(), m.receivers.height()});
      const size_t i = outside ? 0 : m.receivers.primitive.index(pixel.x, pixel.y);
      if (!found[k] && (outside || (strip.first <= i && i < strip.end)))
        found[k] =
            section_of({m.scene, m.receivers, m.technique, m.ladder, evidence, m.stored_map, m.stored_rows}, pixels[k]);
    }
  };
  each_strip_of(b.renderer, lookup, looked.truth, asked.technique, cut);
  std::vector<ReceiverSection> sections;
  for (std::optional<ReceiverSection>& one : found) sections.push_back(std::move(one.value()));
  return sections;
}

PassTimes Workbench::time_passes(const Settings& settings, bool map, bool lookup) {
  Impl& b = *impl_;
  const Impl::Asked asked = b.begin(settings);
  const auto& [loaded, technique, keys] = asked;
  b.see(asked);
  b.lookup.forget();  // there may be no memory for another map
  b.map.forget();
  PassTimes times;
  std::vector<glm::vec3> casters;
  if (technique.moves_casters())
    casters = caster_positions(*loaded.scene, technique.frame, settings.map, technique.bias);
  const gl::ShadowMap drawn = b.renderer.render_map(technique, map ? &times.map_ms.emplace() : nullptr, casters);
  if (lookup) b.renderer.lookup(drawn, technique, &times.lookup_ms.emplace());
  return times;
}

Measurement Workbench::measure(const Settings& settings, const std::optional<CurveOptions>& curve_options,
                               MetricSet metrics) {
  Impl& b = *impl_;
  const Impl::Asked asked = b.begin(settings);
  const SceneStage& loaded = asked.loaded;
  const Technique& technique = asked.technique;
  const Scene& scene = *loaded.scene;

  const Impl::Looked looked = b.look(asked);
  const ViewStage& view = looked.view;  // named, because clang 14 lets no lambda capture a structured binding
  const TruthStage& truth = looked.truth;
  if (!b.lookup.has(asked.keys.lookup)) b.free_large_map();
  LookupStage& lookup = b.lookup.get(
      asked.keys.lookup, [&] { return b.stages->prepare_lookup(b.renderer, *loaded.tracer, view, truth, technique); });
  MapStage& map = b.drawn(scene, technique, asked.keys.map);
  // A search does not read it, and it costs a pass over the map.
  if (metrics == MetricSet::all && !map.used) map.used = b.renderer.used_texels(*map.map);
  ShownStage shown = b.stages->show(b.renderer, map, lookup, truth, technique);

  const BiasPart* const varied = curve_options ? curve_part(settings.bias) : nullptr;
  const std::string curve_key = varied ? curve_key_of(settings, *varied, *curve_options) : "";
  const BiasPart* const unknown = varied && !b.curve.has(curve_key) ? varied : nullptr;
  // Only for a curve that is not known yet.
  const BiasScale scale =
      unknown ? bias_scale(technique.frame, view.receivers, truth.receivers, settings.bias.unit) : BiasScale();
  std::unique_ptr<PlacementStage> placements;
  EachStrip each_strip;
  if (settings.map.placements > 1) {
    placements = make_placement_stage(
        {*b.stages, b.renderer, *loaded.tracer, lookup.probe, view, truth, technique}, unknown,
        unknown ? placement_edges(biases_of(*curve_options), scale.depth_per_unit) : std::vector<float>());
    each_strip = [&](const LookupEvidence& evidence, PixelRange strip) { placements->add(evidence, strip); };
  }
  Climbed climbed = b.stages->climb_strips(b.renderer, lookup, view, truth, shown, technique, unknown, each_strip);
  if (placements) placements->finish();
  // What is not needed again is freed before the point's numbers are computed, because it is large.
  shown.r4 = Image<float>();
  shown.tie_lookup = Image<float>();
  if (!settings.view.motion.any()) shown.r5 = Image<float>();
  b.free_large_picture(view.receivers);
  Measurement m{{},           technique, std::move(climbed.ladder), view.camera,        scene, view.receivers,
                lookup.probe, {},        std::move(shown.stored),   lookup.exact_depth, {}};
  m.record = record_of(m, loaded, view, truth, lookup, climbed.soundness, metrics);
  add_answers(m.record, truth.receivers.answers, lookup.texel_answers, climbed.tap_answers);
  const auto texels = static_cast<double>(m.record.metrics.at("map_texels"));
  m.record.metrics["map_seen"] = static_cast<double>(lookup.exact_depth.texels->count()) / texels;
  if (metrics == MetricSet::all) m.record.metrics["map_used"] = static_cast<double>(*map.used) / texels;
  if (varied && !nothing_judged(m.record))
    m.record.curve = b.curve.get(curve_key, [&] {
      BiasCurve curve = summarise(*climbed.counts, scale, *curve_options);
      climbed.counts.reset();  // large, and not needed again: freed before the curve is copied
      if (placements) add_bands(curve, placements->counts(), scale.depth_per_unit);
      return curve;
    });
  if (settings.view.motion.any()) {
    b.see(asked);
    m.flicker = trace_flicker({*b.stages, b.renderer, loaded, view, truth, technique, shown.r5});
    m.record.metrics.merge(measure_flicker(*m.flicker));
  }
  if (placements && !nothing_judged(m.record)) b.add_placements(m.record, *placements, looked, asked);
  m.stored_rows = [&b, &scene, technique = technique, key = asked.keys.map](int first_row, int count) {
    return b.renderer.read_rows(*b.drawn(scene, technique, key).map, first_row, count);
  };
  return m;
}

}  // namespace noonmark
