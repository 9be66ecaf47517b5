// What a sweep costs, beside the work that no way of measuring can leave out. ctest does not run it; it is built with
// -DNOONMARK_BENCHMARKS=ON.
//
//   benchmark_sweep [--help] [rounds] [experiment ...]
#include <fmt/format.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <unordered_set>

#include "app/definition/experiment_file.h"
#include "app/sweep/results_folder.h"
#include "app/sweep/sweep.h"
#include "base/error.h"
#include "measure/stages.h"
#include "raytrace/light_view.h"
#include "technique/setting_rules.h"
#include "tests/raytrace/bare_rays.h"
#include "tests/support/benchmark.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

constexpr const char* help = R"(benchmark_sweep [--help] [rounds] [experiment ...]

rounds: how often sweep and floor run, in turns (default 3). experiment: its file (default:
experiments/cube-room.toml), with directional or spot lights.

The floor is, in milliseconds of the process's CPU time:
  receivers   the camera's picture, once for each view
  maps        each different shadow map drawn once and read back
  lookups     each point's lookup drawn once, and the probe's read-back once for each place of the taps
  rays        one bare ray (packets of 16, no decision about what it meets) for each receiver, each exact place of a tap
              and each texel that a tap reads, once for each place of the taps
The sweep is `run` as users start it: with curves, phase diagram, store, pictures and report, in a folder of its own.
)";

// CPU milliseconds.
struct Floor {
  double receivers = 0, maps = 0, lookups = 0, rays = 0;
  size_t ray_count = 0;
  double all() const { return receivers + maps + lookups + rays; }
};

template <class Work>
void timed(double& ms, const Work& work) {
  const double before = test::cpu_ms();
  work();
  ms += test::cpu_ms() - before;
}

// Does the unavoidable work of the points, in their order.
class FloorOfPoints {
 public:
  FloorOfPoints() : renderer_(gl::DebugMode::off) {}

  Floor measure(const std::vector<Settings>& points) {
    floor_ = {};
    done_.clear();
    for (const Settings& settings : points) add(settings);
    return floor_;
  }

 private:
  bool first(const Settings& settings, std::initializer_list<Stage> stages, const char* what) {
    return done_.insert(what + settings_key(settings, stages)).second;
  }

  void add(const Settings& settings) {
    if (first(settings, {Stage::scene}, "scene")) {
      scene_ = pipeline_.load_scene(renderer_, settings);
      bare_ = std::make_unique<raytrace::BareRays>(device_, *scene_.scene);
    }
    const LightFrame frame = make_light_frame(*scene_.scene, settings);
    if (first(settings, {Stage::scene, Stage::view}, "view")) {
      timed(floor_.receivers, [&] {
        view_ = pipeline_.take_view(renderer_, *scene_.scene, settings.view);
        renderer_.load_receivers(view_.receivers, view_.camera.eye_m);
      });
    }
    const LightView light(*scene_.scene, frame);
    if (first(settings, {Stage::scene, Stage::view, Stage::truth}, "truth")) cast(receiver_rays(frame));
    if (first(settings, {Stage::scene, Stage::map}, "map"))
      timed(floor_.maps, [&] { map_.emplace(pipeline_.draw_map(renderer_, *scene_.scene, {settings, frame})); });
    if (first(settings, {Stage::scene, Stage::view, Stage::lookup}, "lookup")) {
      std::optional<LookupProbe> probe;
      timed(floor_.lookups, [&] { probe.emplace(renderer_.probe({settings, frame})); });
      cast(tap_rays(frame, light, *probe));
    }
    timed(floor_.lookups, [&] { renderer_.lookup(*map_->map, {settings, frame}); });
  }

  using Rays = std::vector<raytrace::BareRays::Ray>;
  void cast(const Rays& rays) {
    floor_.ray_count += rays.size();
    const raytrace::BareRays::Packets packets(rays);
    timed(floor_.rays, [&] { bare_->cast(packets); });
  }

  template <class Visit>
  void each_facing(const LightFrame& frame, const Visit& visit) const {
    for (size_t i = 0; i < view_.receivers.position.size(); ++i)
      if (view_.receivers.primitive[i] != no_primitive) {
        const glm::vec3 way = frame.light().way_to_centre(frame, view_.receivers.position[i]).direction;
        if (glm::dot(glm::vec3(view_.receivers.normal[i]), way) > 0) visit(i, way);
      }
  }

  Rays receiver_rays(const LightFrame& frame) const {
    Rays rays;
    each_facing(frame, [&](size_t i, glm::vec3 way) { rays.push_back({view_.receivers.position[i], way}); });
    return rays;
  }

  // Of the exact places of the taps that are no receiver, and of each texel that they read, once.
  Rays tap_rays(const LightFrame& frame, const LightView& light, const LookupProbe& probe) const {
    Rays rays;
    std::unordered_set<uint64_t> texels;
    const auto add = [&](const auto& ray) { rays.push_back({ray.origin, ray.direction}); };
    each_facing(frame, [&](size_t i, glm::vec3) {
      for (int tap = 0; tap < probe.taps(); ++tap) {
        const glm::ivec2 texel = probe.texel(i, tap);
        if (texels.insert(static_cast<uint64_t>(static_cast<uint32_t>(texel.y)) << 32 | static_cast<uint32_t>(texel.x))
                .second)
          add(light.ray(light.texel_place(texel)));
        if (const glm::dvec3 offset = probe.offset(i, tap); offset != glm::dvec3(0))
          add(light.ray(light.normal_place(frame.tap_place(frame.to_light(view_.receivers.position[i]), offset))));
      }
    });
    return rays;
  }

  gl::Renderer renderer_;
  EmbreeDevice device_;
  Pipeline pipeline_;
  SceneStage scene_;
  std::unique_ptr<raytrace::BareRays> bare_;
  ViewStage view_;
  std::optional<MapStage> map_;
  std::set<std::string> done_;
  Floor floor_;
};

void measure(const std::string& path, int rounds) {
  const Experiment experiment = load_experiment(path);
  const std::vector<Settings> planned = points(experiment);
  std::string folder = (std::filesystem::temp_directory_path() / "noonmark-benchmark-XXXXXX").string();
  if (!mkdtemp(folder.data())) throw Error(ErrorKind::file, "cannot make " + folder);
  FloorOfPoints points_floor;
  std::vector<double> sweeps, floors;
  Floor floor;
  for (int round = 0; round < rounds; ++round) {
    double sweep = 0;
    timed(sweep, [&] {
      run_sweep(experiment, ResultsFolder(folder, experiment.path), {.overwrite = true, .command = "benchmark_sweep"});
    });
    floor = points_floor.measure(planned);
    sweeps.push_back(sweep);
    floors.push_back(floor.all());
  }
  std::filesystem::remove_all(folder);
  const double sweep = test::median(sweeps), least = test::median(floors);
  fmt::print("{}: {} points\n  sweep {:.0f} ms CPU, floor {:.0f}: {:.2f} x the floor\n", path, planned.size(), sweep,
             least, sweep / least);
  fmt::print("  floor: receivers {:.0f}, maps {:.0f}, lookups {:.0f}, {:.1f} million rays {:.0f} ms CPU (last round)\n",
             floor.receivers, floor.maps, floor.lookups, static_cast<double>(floor.ray_count) * 1e-6, floor.rays);
}

}  // namespace
}  // namespace noonmark

int main(int argc, char** argv) {
  const auto asked = noonmark::test::benchmark_arguments(
      {argv + 1, argv + argc}, noonmark::help, 3, {noonmark::test::source_dir() + "/experiments/cube-room.toml"});
  if (!asked) return 0;
  for (const std::string& experiment : asked->what) noonmark::measure(experiment, asked->rounds);
}
