// The time that the truth takes. ctest does not run it; it is built with -DNOONMARK_BENCHMARKS=ON. `rays` is rays per
// second of the stage's own time. The n in a benchmark's name gives the triangles (0: cube-room).
#include <benchmark/benchmark.h>

#include <memory>
#include <tuple>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

// A floor and a rippled sheet of 2 n^2 triangles over it, or cube-room.
Scene scene_of(int n) {
  if (n == 0) return test::builtin("cube-room");
  Scene scene;
  add_quad(scene, "floor", {-5, -1, -5}, {0, 0, 10}, {10, 0, 0});
  add_surface(scene, "sheet", n, n, false, [](double s, double t) {
    return glm::dvec3(6 * s - 3, 0.5 * std::sin(20 * s) * std::cos(15 * t), 3 - 6 * t);
  });
  scene.light.position_m = {2, 3, 1};
  return scene;
}

struct Bench {
  Scene scene;
  LightFrame frame;
  Tracer tracer;
  ReceiverImage receivers;
  explicit Bench(int n)
      : scene(scene_of(n)),
        frame(test::frame_of(scene, 1024)),
        tracer(scene),
        receivers(test::random_receivers(scene, frame.direction_to_light(), false, 1280 * 720, 1)) {
    // Sorted so that neighbours look at neighbouring places, as the pixels of a picture do.
    std::vector<size_t> order(receivers.primitive.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    const LookupProbe probe = test::probe_of(receivers, frame);
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      const auto key = [&](size_t i) {
        const glm::ivec2 t = probe.texel(i, 0);
        return std::tuple(t.y >> 4, t.x >> 2, t.y, t.x, i);
      };
      return key(a) < key(b);
    });
    const ReceiverImage unsorted = receivers;
    for (size_t i = 0; i < order.size(); ++i) {
      receivers.position[i] = unsorted.position[order[i]];
      receivers.normal[i] = unsorted.normal[order[i]];
      receivers.primitive[i] = unsorted.primitive[order[i]];
    }
  }
};

void report(benchmark::State& state, double milliseconds, uint64_t rays) {
  state.counters["rays"] = benchmark::Counter(static_cast<double>(rays) / (milliseconds / 1e3),
                                              benchmark::Counter::kDefaults, benchmark::Counter::OneK::kIs1000);
  state.counters["stage_ms"] = milliseconds / static_cast<double>(state.iterations());
}

void build(benchmark::State& state) {
  const Scene scene = scene_of(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(std::make_unique<Tracer>(scene));
}

void hard_truth(benchmark::State& state) {
  const Bench b(static_cast<int>(state.range(0)));
  double ms = 0;
  uint64_t rays = 0;
  for (auto _ : state) {
    StageTime hard, soft;
    benchmark::DoNotOptimize(b.tracer.receiver_truth(b.receivers, b.frame, {}, &hard, &soft).lit.pixels.data());
    ms += hard.milliseconds;
    rays += hard.rays;
  }
  report(state, ms, rays);
}

void soft_truth(benchmark::State& state) {
  const Bench b(static_cast<int>(state.range(0)));
  double ms = 0;
  uint64_t rays = 0;
  for (auto _ : state) {
    StageTime hard, soft;
    const SoftTruth sun = test::sun(0.53, 0.05);
    benchmark::DoNotOptimize(b.tracer.receiver_truth(b.receivers, b.frame, sun, &hard, &soft).soft.pixels.data());
    ms += soft.milliseconds;
    rays += soft.rays;
  }
  report(state, ms, rays);
}

void lookups(benchmark::State& state, bool taps) {
  const Bench b(static_cast<int>(state.range(0)));
  const ReceiverTruth truth = b.tracer.receiver_truth(b.receivers, b.frame, {});
  const LookupProbe probe = test::probe_of(b.receivers, b.frame, test::box(static_cast<int>(state.range(1))));
  double ms = 0;
  uint64_t rays = 0;
  for (auto _ : state) {
    const LookupTruth lookup = b.tracer.lookup_truth(b.receivers, truth, probe, b.frame, {});
    const StageTime& stage = taps ? lookup.tap_stage : lookup.texel_stage;
    ms += stage.milliseconds;
    rays += stage.rays;
  }
  report(state, ms, rays);
}
void texel_rays(benchmark::State& state) { lookups(state, false); }
void tap_truth(benchmark::State& state) { lookups(state, true); }

BENCHMARK(build)->Arg(0)->Arg(224)->Arg(708)->ArgName("n")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(hard_truth)->Arg(0)->Arg(224)->Arg(708)->ArgName("n")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(soft_truth)->Arg(0)->Arg(224)->ArgName("n")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(texel_rays)
    ->ArgsProduct({{0, 224, 708}, {1}})
    ->ArgNames({"n", "kernel"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(tap_truth)
    ->ArgsProduct({{0, 224, 708}, {1, 3}})
    ->ArgNames({"n", "kernel"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace noonmark::raytrace

BENCHMARK_MAIN();
