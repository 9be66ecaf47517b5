// What the truth costs, beside the rays that it cannot do without. ctest does not run it; it is built with
// -DNOONMARK_BENCHMARKS=ON.
//
//   benchmark_cells [--help] [--r1] [rounds] [scene ...]     a scene: a built-in one, hills, or the path of a glTF file
//
// Every row has a floor: the bare rays, one robust ray in packets of 16 for each receiver (R1), or for each distinct
// place of its taps, without any decision about what they meet. Program and floor run in turns within one process; the
// figures are medians of the process's CPU time.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "raytrace/light_view.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "tests/raytrace/bare_rays.h"
#include "tests/raytrace/fixture.h"
#include "tests/support/benchmark.h"

namespace noonmark::raytrace {
namespace {

constexpr int width = 1280, height = 720, map_resolution = 1024;

ReceiverImage seen_by_camera(const Scene& scene, const EmbreeScene& embree) {
  const CameraFrame camera = make_camera_frame(scene.camera, width, height);
  Image<uint32_t> primitives(width, height, no_primitive);
  for_each_packet(primitives.size(), [&](size_t first, int n) {
    LightRay rays[packet_size];
    for (int i = 0; i < n; ++i) {
      const int pixel = static_cast<int>(first) + i;
      const Ray ray = camera.pixel_ray(pixel % width, pixel / width, width, height);
      rays[i] = {glm::vec3(ray.origin), glm::vec3(glm::normalize(ray.direction))};
    }
    embree.first_hits(n, rays, &primitives.pixels[first]);
  });
  return resolve_receivers(scene, scene.camera, primitives);
}

using Bare = BareRays::Ray;

std::vector<double> medians(int rounds, const std::vector<std::function<void()>>& jobs) {
  return test::medians(test::run_in_turns(rounds, jobs));
}

class Bench {
 public:
  Bench(const std::string& name, int rounds)
      : rounds_(rounds),
        scene_(name == "hills" ? test::hills() : test::builtin(name)),
        frame_(test::frame_of(scene_, map_resolution)),
        embree_(device_, scene_),
        tracer_(std::make_unique<Tracer>(scene_)),
        receivers_(seen_by_camera(scene_, embree_)),
        bare_(device_, scene_) {
    truth_ = tracer_->receiver_truth(receivers_, frame_, {});
    for (size_t i = 0; i < truth_.facing.size(); ++i)
      if (truth_.facing[i]) facing_.push_back(static_cast<uint32_t>(i));
    fmt::print("{}: {} triangles, {} facing receivers of {} x {} pixels\n", name, scene_.triangles.size(),
               facing_.size(), width, height);
  }
  void hard_truth() {
    std::vector<Bare> rays;
    for (uint32_t i : facing_)
      rays.push_back({receivers_.position[i], frame_.light().way_to_centre(frame_, receivers_.position[i]).direction});
    const BareRays::Packets packets(rays);
    StageTime kept, first;
    const auto judge = [&](StageTime& stage) {
      stage = {};
      truth_ = tracer_->receiver_truth(receivers_, frame_, {}, &stage);
    };
    // A scene keeps what its last two lights see.
    const LightFrame other = test::frame_of(test::builtin("plane"), 1),
                     another = test::frame_of(test::builtin("wall"), 1);
    const std::vector<double> ms = medians(rounds_, {
                                                        [&] { bare_.cast(packets); },
                                                        [&] { judge(kept); },
                                                        [&] {  // forgets
                                                          tracer_->receiver_truth({}, other, {});
                                                          tracer_->receiver_truth({}, another, {});
                                                        },
                                                        [&] { judge(first); },
                                                    });
    row("R1 and its certainty", ms[1], ms[0], kept.rays, facing_.size());
    row("R1, first use of the light", ms[3], ms[0], first.rays, facing_.size());
  }

  void soft_truth() {
    StageTime hard, soft;
    const SoftTruth sun = test::sun(0.53, 0.01);
    const std::vector<double> ms =
        medians(std::max(1, rounds_ / 3), {
                                              [&] { tracer_->receiver_truth(receivers_, frame_, {}); },
                                              [&] {
                                                soft = {};
                                                truth_ = tracer_->receiver_truth(receivers_, frame_, sun, &hard, &soft);
                                              },
                                          });
    size_t partial = 0;
    for (uint32_t i : facing_) partial += truth_.soft[i] > 0 && truth_.soft[i] < 1;
    fmt::print("  {:<28} {:9.1f} ms CPU besides R1, {:6.2f} rays for each receiver; {:.2f} % lie in a penumbra\n",
               "R0 of a sun of 0.53 degrees", ms[1] - ms[0], static_cast<double>(soft.rays) / count(),
               100 * static_cast<double>(partial) / count());
  }

  void taps(const char* name, const FilterSettings& filter) {
    const LookupProbe probe = test::probe_of(receivers_, frame_, filter);
    std::vector<Bare> rays;
    const auto add = [&](glm::dvec3 place) {
      const LightRay ray = view_.ray(place);
      rays.push_back({ray.origin, ray.direction});
    };
    std::vector<uint8_t> seen(size_t{1} << 26);
    for (uint32_t i : facing_)
      for (int tap = 0; tap < probe.taps(); ++tap) {
        if (const glm::ivec2 t = probe.texel(i, tap) + 2048; t.x >= 0 && t.y >= 0 && t.x < 8192 && t.y < 8192) {
          uint8_t& before = seen[static_cast<size_t>(t.y) * 8192 + static_cast<size_t>(t.x)];
          if (!before) add(view_.texel_place(t - 2048));
          before = 1;
        }
        if (const glm::dvec3 offset = probe.offset(i, tap); offset != glm::dvec3(0))
          add(view_.normal_place(frame_.tap_place(frame_.to_light(receivers_.position[i]), offset)));
      }
    const BareRays::Packets packets(rays);
    LookupTruth truth;
    const std::vector<double> ms = medians(
        rounds_,
        {[&] { bare_.cast(packets); }, [&] { truth = tracer_->lookup_truth(receivers_, truth_, probe, frame_, {}); }});
    row(name, ms[1], ms[0], truth.texel_stage.rays + truth.tap_stage.rays, rays.size());
  }

 private:
  double count() const { return static_cast<double>(facing_.size()); }

  // rate: of the program, as a fraction of the floor's.
  void row(const char* what, double ms, double floor, uint64_t cast, size_t bare) const {
    fmt::print(
        "  {:<28} {:9.1f} ms CPU, floor {:8.1f}: {:6.2f} x the floor, rate {:.3f}; {:.3f} rays for each bare ray\n",
        what, ms, floor, ms / floor, floor / ms, static_cast<double>(cast) / static_cast<double>(bare));
    std::fflush(stdout);
  }

  int rounds_;
  Scene scene_;
  LightFrame frame_;
  EmbreeDevice device_;
  EmbreeScene embree_;
  LightView view_{scene_, frame_};
  std::unique_ptr<Tracer> tracer_;
  ReceiverImage receivers_;
  ReceiverTruth truth_;
  std::vector<uint32_t> facing_;
  BareRays bare_;
};

void measure(const std::string& name, int rounds, bool only_r1) {
  Bench bench(name, rounds);
  bench.hard_truth();
  if (only_r1) return;
  bench.taps("taps: no filter", {});
  bench.taps("taps: box 3 x 3", test::box(3));
  bench.taps("taps: box 7 x 7", test::box(7));
  bench.taps("taps: box 15 x 15", test::box(15));
  bench.soft_truth();
}

}  // namespace
}  // namespace noonmark::raytrace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool only_r1 = std::erase(words, "--r1") > 0;
  const auto asked = noonmark::test::benchmark_arguments(
      words,
      "usage: benchmark_cells [--r1] [rounds] [scene ...]\n"
      "  --r1    only R1 and its certainty\n"
      "  rounds  the figures are medians of so many rounds; 5\n"
      "  scene   hills, a built-in scene, or the path of a glTF file; cube-room hills\n"
      "Prints CPU time beside that of bare rays.\n",
      5, {"cube-room", "hills"});
  if (!asked) return 0;
  fmt::print("{}\n", noonmark::test::processor_name());
  for (const std::string& scene : asked->what) noonmark::raytrace::measure(scene, asked->rounds, only_r1);
}
