// What a picture and its hard truth cost from nothing, as another ray tracer's sample of each pixel does: which surface
// each pixel shows, where, and whether a sun reaches it. ctest does not run it; it is built with
// -DNOONMARK_BENCHMARKS=ON, and scripts/compare-cycles runs it.
//
//   benchmark_view [--help] [rounds] [experiment ...]
#include <fmt/format.h>

#include <string>

#include "app/definition/experiment_file.h"
#include "measure/stages.h"
#include "tests/support/benchmark.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

constexpr const char* help = R"(benchmark_view [--help] [rounds] [experiment ...]

rounds: the figures are medians of so many rounds (default 9). experiment: its file; its first point is taken (default:
experiments/cube-room.toml).

In milliseconds of the process's CPU time:
  picture   the triangle that each pixel shows (OpenGL), its place and normal
  R1        the hard truth of each receiver, with its certainty; what was learnt of this light is kept
  first R1  the same when the light is new
)";

void measure(const std::string& path, int rounds) {
  const Settings settings = points(load_experiment(path)).front();
  gl::Renderer renderer(gl::DebugMode::off);
  Pipeline pipeline;
  const SceneStage scene = pipeline.load_scene(renderer, settings);
  const LightFrame frame = make_light_frame(*scene.scene, settings);
  Settings other = settings;  // of a light that lies elsewhere
  other.light.kind = LightChoice::directional;
  other.light.position_m = glm::dvec3(0.1, 3, 0.2);
  other.light.target_m = glm::dvec3(0);
  other.light.azimuth_deg = other.light.elevation_deg = {};
  const LightFrame other_frame = make_light_frame(*scene.scene, other);
  ViewStage view, nothing;
  TruthStage truth;
  const std::vector<double> ms = test::medians(
      test::run_in_turns(rounds, {
                                     [&] { view = pipeline.take_view(renderer, *scene.scene, settings.view); },
                                     [&] {
                                       truth = pipeline.trace_truth(scene, view, {settings, frame});
                                     },
                                     [&] {
                                       pipeline.trace_truth(scene, nothing, {other, other_frame});
                                     },  // forgets the light
                                     [&] {
                                       truth = pipeline.trace_truth(scene, view, {settings, frame});
                                     },
                                 }));
  size_t facing = 0;
  for (const uint8_t faces : truth.receivers.facing.pixels) facing += faces != 0;
  fmt::print("{}: {} triangles, {} facing receivers\n  picture {:.1f} ms CPU, R1 {:.1f}, first R1 {:.1f}\n", path,
             scene.scene->triangles.size(), facing, ms[0], ms[1], ms[3]);
}

}  // namespace
}  // namespace noonmark

int main(int argc, char** argv) {
  const auto asked = noonmark::test::benchmark_arguments(
      {argv + 1, argv + argc}, noonmark::help, 9, {noonmark::test::source_dir() + "/experiments/cube-room.toml"});
  if (!asked) return 0;
  for (const std::string& experiment : asked->what) noonmark::measure(experiment, asked->rounds);
}
