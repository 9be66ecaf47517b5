#include "measure/workbench.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "base/address_space.h"
#include "base/error.h"
#include "base/threads.h"
#include "measure/bench.h"
#include "scenes/scene_size.h"
#include "technique/setting_rules.h"

namespace noonmark {

MetricSet metric_set_for(std::string_view metric) {
  if (metric == "shaded_rmse" || metric == "flip") return MetricSet::shaded;
  constexpr std::string_view of_all[] = {"map_used", "undersampled", "perspective_aliasing",
                                         "perspective_aliasing_p95"};
  const bool searched = std::find(std::begin(of_all), std::end(of_all), metric) == std::end(of_all);
  return searched ? MetricSet::searched : MetricSet::all;
}

namespace {

Settings of_scene(const SceneSettings& scene) {
  Settings settings;
  settings.scene = scene;
  return settings;
}

}  // namespace

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
  bench_ = std::make_unique<Bench>(debug, std::move(shaders), std::move(stages));
  bench_->space_at_start = space;
}
Workbench::~Workbench() = default;

const gl::DeviceInfo& Workbench::device() const { return bench_->renderer.info(); }

const Scene& Workbench::scene(const SceneSettings& settings) { return *bench_->load(of_scene(settings)).scene; }

const std::string& Workbench::scene_identity(const SceneSettings& settings) {
  return bench_->load(of_scene(settings)).identity;
}

MemoryEstimate Workbench::memory(const Settings& settings, bool curve, bool pictures) {
  return bench_->memory(settings, curve, pictures);
}

MemoryEstimate Bench::memory(const Settings& settings, bool curve, bool pictures) {
  const Asked asked = begin(settings);
  const Scene& scene = *asked.loaded.scene;
  return estimate_memory({settings, asked.technique.frame.kind, scene_size(scene), asked.loaded.open_edges,
                          outside_texels(scene, asked.technique), curve, pictures});
}

AvailableMemory Workbench::memory_of_program(bool pictures) const { return bench_->memory_of_program(pictures); }

AvailableMemory Bench::memory_of_program(bool pictures) const {
  return noonmark::memory_of_program(space_at_start, room_to_start(pictures));
}

PhaseDiagram Workbench::phase(const Settings& settings, const PhaseOptions& options, const PhaseDiagram* measured,
                              const RowDone& row_done) {
  const Bench::Asked asked = bench_->begin(settings);
  const SceneStage& loaded = asked.loaded;
  const auto [view, truth] = bench_->look(asked);
  if (measured) return rejudged_phase(*measured, *loaded.scene, view, truth, settings, options);
  return measure_phase(bench_->renderer, *loaded.tracer, *loaded.scene, view, truth, settings, options, row_done);
}

std::vector<PhasePlace> Workbench::places(const Settings& picture, std::span<const Settings> points) {
  const Bench::Asked asked = bench_->begin(picture);
  const SceneStage& loaded = asked.loaded;
  const auto [view, truth] = bench_->look(asked);
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

std::optional<Workbench::Hider> Workbench::hider(const Settings& settings) {
  const Bench::Asked asked = bench_->begin(settings);
  const auto [view, truth] = bench_->look(asked);
  const Scene& scene = *asked.loaded.scene;
  Image<uint8_t> hidden = truth.receivers.facing;
  for (size_t i = 0; i < hidden.size(); ++i) hidden[i] = hidden[i] && !truth.receivers.lit[i];
  std::vector<uint32_t> first =
      asked.loaded.tracer->first_on_the_way(view.receivers, asked.technique.frame, hidden).pixels;
  std::erase(first, no_primitive);
  std::optional<Hider> most;
  for (const Part& part : scene.parts) {
    const auto is_of = [&](uint32_t t) {
      return t - part.first_triangle < part.triangle_count;
    };  // wraps below the first
    const double share =
        static_cast<double>(std::count_if(first.begin(), first.end(), is_of)) / static_cast<double>(first.size());
    if (share > (most ? most->share : 0)) most = {part.name, share};
  }
  return most;
}

PassTimes Workbench::time_passes(const Settings& settings, bool map, bool lookup) {
  Bench& b = *bench_;
  const Bench::Asked asked = b.begin(settings);
  const SceneStage& loaded = asked.loaded;
  const ViewStage& seen = b.see(asked);
  b.forget_maps();  // there may be no memory for another map
  const std::optional<ViewSlice> visible = visible_depths(settings, seen.receivers, seen.camera);
  std::vector<Technique> techniques = techniques_of(*loaded.scene, settings, visible);
  for (Technique& one : techniques)
    if (one.cascade) one.cascade->seam = 1;  // an engine looks up nothing for comparison
  PassTimes times;
  double ms = 0;
  const gl::ShadowMap drawn =
      b.renderer.render_maps(techniques, map ? &ms : nullptr, casters_of(*loaded.scene, techniques.front()));
  if (map) times.map_ms = ms;
  if (!lookup) return times;
  times.prefilter_ms = b.renderer.time_prefilter(drawn, techniques.front());
  b.renderer.lookup_maps(drawn, techniques, &ms);
  times.lookup_ms = ms;
  return times;
}

}  // namespace noonmark
