// The time that the passes take, with their read-back. ctest does not run it; it is built with
// -DNOONMARK_BENCHMARKS=ON. Each benchmark times the whole call; `pass_ms` is the time of the pass alone, as reports
// show it.
#include <benchmark/benchmark.h>

#include <cmath>

#include "gl/renderer.h"
#include "scenes/camera_fit.h"
#include "scenes/receivers.h"
#include "scenes/shapes.h"
#include "technique/filters.h"

namespace noonmark::gl {
namespace {

// A floor and a rippled sheet of 2 n^2 triangles.
Scene sheet(int n) {
  Scene scene;
  add_quad(scene, "floor", {-5, -1, 5}, {10, 0, 0}, {0, 0, -10});
  add_surface(scene, "sheet", n, n, false, [](double s, double t) {
    return glm::dvec3(6 * s - 3, 0.5 * std::sin(20 * s) * std::cos(15 * t), 3 - 6 * t);
  });
  scene.camera.eye_m = {3, 4, 7};
  scene.camera = with_fitted_depths(scene, scene.camera, 1280, 720);
  scene.light.position_m = {2, 8, 1};
  return scene;
}

struct Bench {
  Renderer renderer{DebugMode::off};
  Scene scene;
  Settings settings;
  explicit Bench(int n) : scene(sheet(n)) { renderer.load_scene(scene); }
  void load_receivers() {
    const auto primitives = renderer.render_primitives(scene.camera, 1280, 720);
    renderer.load_receivers(resolve_receivers(scene, scene.camera, primitives), scene.camera.eye_m);
  }
};

void primitives(benchmark::State& state) {
  Bench b(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(b.renderer.render_primitives(b.scene.camera, 1280, 720).pixels.data());
}

void load_receivers(benchmark::State& state) {
  Bench b(100);
  const auto image =
      resolve_receivers(b.scene, b.scene.camera, b.renderer.render_primitives(b.scene.camera, 1280, 720));
  for (auto _ : state) b.renderer.load_receivers(image, b.scene.camera.eye_m);
}

void render_map(benchmark::State& state) {
  Bench b(static_cast<int>(state.range(1)));
  b.settings.map.resolution = static_cast<int>(state.range(0));
  double ms = 0, sum = 0;
  for (auto _ : state) {
    b.renderer.render_map({b.scene, b.settings}, &ms);
    sum += ms;
  }
  state.counters["pass_ms"] = sum / static_cast<double>(state.iterations());
}

void read_map(benchmark::State& state) {
  Bench b(100);
  b.settings.map.resolution = static_cast<int>(state.range(0));
  const ShadowMap map = b.renderer.render_map({b.scene, b.settings});
  for (auto _ : state) benchmark::DoNotOptimize(b.renderer.read_map(map).pixels.data());
}

void upload_map(benchmark::State& state) {
  Bench b(1);
  b.settings.map.resolution = static_cast<int>(state.range(0));
  const Image<float> depth(b.settings.map.resolution, b.settings.map.resolution, 0.5f);
  for (auto _ : state) benchmark::DoNotOptimize(b.renderer.upload_map(depth, b.settings.map).texels());
}

void lookup(benchmark::State& state) {
  Bench b(100);
  b.settings.filter = {"box", {{"size", static_cast<double>(state.range(0))}}};
  if (state.range(0) == 1) b.settings.filter.kind = "none";
  b.load_receivers();
  const LightFrame frame = make_light_frame(b.scene, b.settings);
  const ShadowMap map = b.renderer.render_map({b.settings, frame});
  double ms = 0, sum = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(b.renderer.lookup(map, {b.settings, frame}, &ms).pixels.data());
    sum += ms;
  }
  state.counters["pass_ms"] = sum / static_cast<double>(state.iterations());
}

void probe(benchmark::State& state) {
  Bench b(100);
  b.load_receivers();
  const LightFrame frame = make_light_frame(b.scene, b.settings);
  for (auto _ : state) benchmark::DoNotOptimize(b.renderer.probe({b.settings, frame}).reference.pixels.data());
}

// A cube: all six faces, by one pass and by six.
void render_cube(benchmark::State& state) {
  Bench b(static_cast<int>(state.range(1)));
  b.scene.light.kind = LightKind::point;
  b.settings.map.resolution = 1024;
  b.settings.map.cube_pass = static_cast<CubePass>(state.range(0));
  double ms = 0, sum = 0;
  for (auto _ : state) {
    b.renderer.render_map({b.scene, b.settings}, &ms);
    sum += ms;
  }
  state.counters["pass_ms"] = sum / static_cast<double>(state.iterations());
}

// The argument of a benchmark is a number, so a filter is passed as its row in filters().
int64_t row_of_filter(std::string_view name) { return &find_filter(name) - filters().data(); }

// For a cube map the texel of every tap is read back.
void probe_cube(benchmark::State& state) {
  Bench b(100);
  b.scene.light.kind = LightKind::point;
  b.settings.filter.kind = std::string(filters()[static_cast<size_t>(state.range(0))].name);
  state.SetLabel(b.settings.filter.kind);
  b.load_receivers();
  const LightFrame frame = make_light_frame(b.scene, b.settings);
  for (auto _ : state) benchmark::DoNotOptimize(b.renderer.probe({b.settings, frame}).cube_texel.data());
}

BENCHMARK(primitives)
    ->Arg(22)
    ->Arg(224)
    ->Arg(708)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(load_receivers)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(render_map)
    ->ArgsProduct({{1024, 4096}, {22, 224, 708}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(render_cube)
    ->ArgsProduct({{static_cast<int>(CubePass::layered), static_cast<int>(CubePass::six_passes)}, {22, 224}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(read_map)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(upload_map)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(lookup)
    ->Arg(1)
    ->Arg(3)
    ->Arg(7)
    ->Arg(31)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(probe_cube)
    ->Arg(row_of_filter("none"))
    ->Arg(row_of_filter("cube_disk"))
    ->Arg(row_of_filter("cube_grid"))
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(probe)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace noonmark::gl

BENCHMARK_MAIN();
