// What the exact error at 1,000 biases costs, beside three other ways to get it. ctest does not run it; it is built with
// -DNOONMARK_BENCHMARKS=ON.
//
//   benchmark_biases [--help] [rounds] [scene ...]       a scene: cube-room, hills, or the path of a glTF file
//
// The curve and the other ways run in turns within one process; the figures are medians of the process's CPU time. The
// other ways run at some of the biases only, and their time is multiplied: each bias costs them the same.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "compare/ladder/receiver_taps.h"
#include "measure/workbench.h"
#include "scenes/scene_digest.h"
#include "scenes/surfaces.h"
#include "tests/support/benchmark.h"

namespace noonmark {
namespace {

constexpr int biases = 1000;

constexpr const char* help = R"(benchmark_biases [--help] [rounds] [scene ...]

rounds: how often each job runs (default 9). scene: cube-room, hills (130,736 triangles) or the path of a glTF file
(default: cube-room hills). Each is measured at 1280 x 720 with a 24-bit map of 2048 texels, without a filter and with a
3 x 3 box.

The curve is exact at every bias; here it is read at 1,000. Its cost is what it adds to a pass that only reads the taps,
because the ladder and the soundness check make such a pass anyway. It is compared with
  map and camera     the picture of the camera, the map and the lookup drawn anew for each bias, and compared with R1
  cached lookup      only the lookup drawn anew for each bias, and compared with R1
  loop               one thread, which compares cached (reference, depth) pairs of all taps for each bias
"with all": with what both sides need, once: receivers, R1, the map and its read-back, the probe and the rays of the taps
(drawing map and camera anew needs only receivers and R1).
)";

Settings settings_of(const std::string& scene, bool box) {
  Settings settings;
  settings.scene.name = scene == "hills" ? "cube-room" : scene;
  settings.view.width_px = 1280;
  settings.view.height_px = 720;
  settings.map.resolution = 2048;
  if (box) {
    settings.filter.kind = "box";
    settings.filter["size"] = 3;
  }
  return settings;
}

CurveOptions thousand_biases() {
  CurveOptions options;
  options.bias_depth.push_back(0);
  for (int i = 1; i < biases; ++i) options.bias_depth.push_back(std::pow(10.0, -7 + 7.0 * (i - 1) / (biases - 2)));
  return options;
}

// Reads the taps and does nothing with them.
struct NoJudge {
  struct Part {
    double weights = 0;  // so that reading is not optimised away
  };
  void receiver(size_t, const ReceiverTaps& taps, Part& part) const { part.weights += taps[0].weight; }
  void join(const Part&) {}
  void end_batch() {}
};

// What every way must do once, in CPU milliseconds.
struct Once {
  double receivers = 0, truth = 0, map = 0, lookup = 0;
};

// What stage() makes; its CPU milliseconds are put into ms.
template <class Stage>
auto timed(double& ms, const Stage& stage) {
  const double before = test::cpu_ms();
  auto made = stage();
  ms = test::cpu_ms() - before;
  return made;
}

// Measures a point as the program does, and times the ways to a curve while its taps are at hand.
class Bench final : public Pipeline {
 public:
  Bench(std::string name, int rounds) : name_(std::move(name)), rounds_(rounds) {}

  SceneStage load_scene(gl::Renderer& renderer, const Settings& settings) override {
    if (name_ != "hills") return Pipeline::load_scene(renderer, settings);
    auto scene = std::make_unique<Scene>(test::hills());
    auto tracer = std::make_unique<raytrace::Tracer>(*scene);
    renderer.load_scene(*scene);
    std::string identity = scene_digest(*scene);
    std::vector<uint32_t> surfaces = surfaces_of(*scene);
    return {std::move(scene), std::move(identity), std::move(tracer), 0, std::move(surfaces)};
  }
  ViewStage take_view(gl::Renderer& renderer, const Scene& scene, const ViewSettings& settings) override {
    scene_ = &scene;
    return timed(once_.receivers, [&] { return Pipeline::take_view(renderer, scene, settings); });
  }
  TruthStage trace_truth(const SceneStage& scene, const ViewStage& view, const Technique& technique) override {
    return timed(once_.truth, [&] { return Pipeline::trace_truth(scene, view, technique); });
  }
  MapStage draw_maps(gl::Renderer& renderer, const Scene& scene, std::span<const Technique> techniques) override {
    return timed(once_.map, [&] { return Pipeline::draw_maps(renderer, scene, techniques); });
  }
  LookupStage prepare_lookup(gl::Renderer& renderer, const raytrace::Tracer& tracer, const ViewStage& view,
                             const TruthStage& truth, const Technique& technique) override {
    return timed(once_.lookup, [&] {
      LookupStage lookup = Pipeline::prepare_lookup(renderer, tracer, view, truth, technique);
      each_strip_of(renderer, lookup, truth, technique, [](const LookupEvidence&, PixelRange) {});
      return lookup;
    });
  }
  Climbed climb_strips(gl::Renderer& renderer, LookupStage& lookup, const ViewStage& view, const TruthStage& truth,
                       const ShownStage& shown, const Technique& technique, const BiasPart* varied,
                       const EachStrip& each_strip) override {
    if (lookup.strips.size() != 1) throw std::logic_error("the taps do not fit into one strip");
    compare_ways({renderer, lookup, view, truth, shown, technique, *varied});
    return Pipeline::climb_strips(renderer, lookup, view, truth, shown, technique, varied, each_strip);
  }

 private:
  struct Stages {
    gl::Renderer& renderer;
    LookupStage& lookup;
    const ViewStage& view;
    const TruthStage& truth;
    const ShownStage& shown;
    const Technique& technique;
    const BiasPart& varied;
  };
  // All taps of the receivers that a curve counts, as a loop over biases reads them.
  struct CachedTaps {
    std::vector<float> reference, depth;
    std::vector<uint8_t> should_be_lit;
  };

  static CachedTaps cached(const Stages& s) {
    CachedTaps all;
    for (size_t i = 0; i < s.truth.receivers.facing.size(); ++i) {
      if (!s.truth.receivers.facing[i] || s.truth.receivers.ambiguous[i]) continue;
      ReceiverTaps taps;
      taps.read(s.lookup.probe, s.lookup.taps, s.technique.settings.map, s.shown.stored, i);
      for (size_t t = 0; t < taps.size(); ++t) {
        all.reference.push_back(taps[t].always_lit ? 0 : taps[t].reference);
        all.depth.push_back(taps[t].depth);
        all.should_be_lit.push_back(s.truth.receivers.lit[i]);
      }
    }
    return all;
  }

  static uint32_t wrong_taps(const CachedTaps& taps, float bias) {
    uint32_t wrong = 0;
    for (size_t i = 0; i < taps.reference.size(); ++i)
      wrong += static_cast<uint32_t>(!(taps.reference[i] - bias > taps.depth[i])) != taps.should_be_lit[i];
    return wrong;
  }

  static double error_of(const ReceiverTruth& truth, const Image<float>& picture) {
    double sum = 0;
    for (size_t i = 0; i < picture.size(); ++i)
      if (truth.facing[i]) sum += std::abs(picture[i] - static_cast<float>(truth.lit[i]));
    return sum;
  }

  void compare_ways(const Stages& s);
  void print(double curve, double summary, double scene, double lookup, double loop) const;

  std::string name_;
  int rounds_;
  const Scene* scene_ = nullptr;
  Once once_;
};

void Bench::compare_ways(const Stages& s) {
  constexpr int drawn = 10, looped = 20;  // at so many biases the other ways run
  const CurveOptions options = thousand_biases();
  const BiasScale scale = bias_scale(s.technique.frame, s.view.receivers, s.truth.receivers, BiasUnit::depth);
  const CachedTaps taps = cached(s);
  const gl::ShadowMap drawn_map = s.renderer.render_map(s.technique);
  double kept = 0;  // so that nothing is optimised away
  const LookupEvidence evidence{s.truth.receivers,        s.lookup.probe,   s.lookup.taps, s.lookup.exact_depth,
                                s.technique.settings.map, s.technique.bias, s.shown.r4,    s.shown.r5};
  const PixelRange all{0, s.truth.receivers.facing.size()};
  std::optional<BiasCounts> counts;
  const auto at_biases = [&](int count, const auto& visit) {
    for (int k = 0; k < count; ++k) {
      Settings settings = s.technique.settings;
      settings.bias["constant"] = 1e-4 * k;
      kept += visit(settings);
    }
  };
  const auto look_up = [&](const gl::ShadowMap& map, const Settings& settings) {
    return error_of(s.truth.receivers, s.renderer.lookup(map, {settings, s.technique.frame}));
  };
  const auto times = test::run_in_turns(
      rounds_, {[&] {
                  NoJudge nothing;
                  read_taps(evidence, all, nothing);
                },
                [&] {
                  counts.emplace(evidence.probe, s.varied);
                  counts->add(evidence, s.shown.stored, all);
                },
                [&] { kept += summarise(*counts, scale, options).best_error; },
                [&] {
                  at_biases(drawn, [&](const Settings& settings) {
                    kept +=
                        s.renderer.render_primitives(s.view.camera, settings.view.width_px, settings.view.height_px)[0];
                    return look_up(s.renderer.render_map({settings, s.technique.frame}), settings);
                  });
                },
                [&] { at_biases(drawn, [&](const Settings& settings) { return look_up(drawn_map, settings); }); },
                [&] {
                  for (int k = 0; k < looped; ++k) kept += wrong_taps(taps, 1e-4f * static_cast<float>(k));
                }});
  std::vector<double> added;  // by the curve, round by round
  for (size_t r = 0; r < times[0].size(); ++r) added.push_back(times[1][r] - times[0][r]);
  const std::vector<double> ms = test::medians(times);
  fmt::print("{}, {}: {} taps of {} receivers\n", name_, s.technique.settings.filter.kind, taps.reference.size(),
             taps.reference.size() / static_cast<size_t>(s.lookup.probe.taps()));
  print(test::median(added), ms[2], ms[3] * biases / drawn, ms[4] * biases / drawn, ms[5] * biases / looped);
  if (kept == 0) fmt::print("no wrong tap at any bias\n");
}

void Bench::print(double curve, double summary, double drawn, double lookup, double loop) const {
  const double one = curve + summary;
  const double traced = once_.receivers + once_.truth, all = traced + once_.map + once_.lookup;
  fmt::print("  the curve {:.1f} ms CPU in the pass over the taps, {:.2f} to read it at {} biases\n", curve, summary,
             biases);
  fmt::print(
      "  once, for all ways: receivers {:.1f}, R1 {:.1f}, map {:.1f}, probe and rays of the taps {:.1f} ms CPU\n",
      once_.receivers, once_.truth, once_.map, once_.lookup);
  const auto row = [&](const char* what, double ms, double shared) {
    fmt::print("  {:<16} {:9.0f} ms CPU for {} biases: {:7.1f} x the curve; with all {:6.1f} x\n", what, ms, biases,
               ms / one, (ms + shared) / (one + all));
  };
  row("map and camera", drawn, traced);
  row("cached lookup", lookup, all);
  row("loop", loop, all);
  std::fflush(stdout);
}

void measure(const std::string& scene, int rounds) {
  for (const bool box : {false, true}) {
    Workbench bench(gl::DebugMode::off, {}, std::make_unique<Bench>(scene, rounds));
    bench.measure(settings_of(scene, box), thousand_biases());
  }
}

}  // namespace
}  // namespace noonmark

int main(int argc, char** argv) {
  const auto asked =
      noonmark::test::benchmark_arguments({argv + 1, argv + argc}, noonmark::help, 9, {"cube-room", "hills"});
  if (!asked) return 0;
  for (const std::string& scene : asked->what) noonmark::measure(scene, asked->rounds);
}
