// The memory that measurements really need, compared with the prediction. A run that would not fit must not begin.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>
#include <regex>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "measure/memory_estimate.h"
#include "measure/workbench.h"
#include "tests/program/fixture.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::acceptance {
namespace {

class Memory : public Program {
 protected:
  // scripts/test asks the C library for huge pages, which are resident as a whole when a byte of them is used.
  static void with_usual_pages() { unsetenv("GLIBC_TUNABLES"); }
  // The peak memory of a whole run of the program, in bytes.
  double peak(const std::vector<std::string>& arguments) {
    return 1024.0 * static_cast<double>(usage_of(arguments).ru_maxrss);
  }
  struct rusage usage_of(const std::vector<std::string>& arguments) {
    const pid_t child = start(arguments, with_usual_pages);
    int status = 0;
    struct rusage usage {};
    wait4(child, &status, 0, &usage);
    output_ = read_file((folder_ / "output.txt").string());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << output_;
    return usage;
  }
  // Runs with a limited address space, so that the memory of the machine does not decide the test.
  int run_within(rlim_t bytes, const std::vector<std::string>& arguments) {
    struct rlimit before {};
    getrlimit(RLIMIT_AS, &before);
    struct rlimit less = before;
    less.rlim_cur = bytes;
    setrlimit(RLIMIT_AS, &less);  // limits this process too, but only while the other one starts
    const pid_t child = start(arguments, with_usual_pages);
    setrlimit(RLIMIT_AS, &before);
    const int code = wait_for(child);
    output_ = read_file((folder_ / "output.txt").string());
    return code;
  }
  // A bumpy square of 2 n^2 triangles, drawn `instances` times under this name.
  std::string grid(uint16_t n, int instances, const std::string& name = "grid") {
    std::vector<float> positions;
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x)
        for (float value :
             {static_cast<float>(x) / n, static_cast<float>(y) / n, 0.01f * static_cast<float>((x * 7 + y * 13) % 5)})
          positions.push_back(value);
    std::vector<uint16_t> indices;
    for (uint16_t y = 0; y < n; ++y)
      for (uint16_t x = 0; x < n; ++x) {
        const auto a = static_cast<uint16_t>(y * (n + 1) + x), b = static_cast<uint16_t>(a + 1),
                   c = static_cast<uint16_t>(a + n + 1), d = static_cast<uint16_t>(c + 1);
        for (uint16_t v : {a, b, d, a, d, c}) indices.push_back(v);
      }
    test::json document = test::square();
    test::json& primitive = document["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] =
        test::add_accessor(document, test::raw(positions), 5126, "VEC3", positions.size() / 3);
    document["accessors"].back()["min"] = {0, 0, 0};
    document["accessors"].back()["max"] = {1, 1, 1};
    document["meshes"][0]["primitives"][0]["indices"] =
        test::add_accessor(document, test::raw(indices), 5123, "SCALAR", indices.size());
    document["nodes"] = test::json::array();
    document["scenes"][0]["nodes"] = test::json::array();
    for (int i = 0; i < instances; ++i) {
      document["nodes"].push_back({{"mesh", 0}, {"name", name}, {"translation", {i % 16, i / 16, 0}}});
      document["scenes"][0]["nodes"].push_back(i);
    }
    return write("grid.gltf", document.dump());
  }
};

// Squares in a stack, each a little above the one before. As the light sees them, all their edges coincide.
test::json stack(int squares) {
  test::json document = test::square();
  document["nodes"] = test::json::array();
  document["scenes"][0]["nodes"] = test::json::array();
  for (int i = 0; i < squares; ++i) {
    document["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1e-5 * i}}});
    document["scenes"][0]["nodes"].push_back(i);
  }
  return document;
}

struct Case {
  const char* name;
  const char* toml;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
class MemoryOf : public Memory, public testing::WithParamInterface<Case> {};

// The peak must not exceed the prediction, and the prediction must not exceed estimate_factor times the peak. The same
// must hold for the difference to a run that measures almost nothing.
TEST_P(MemoryOf, APointIsPredicted) {
  if (std::string(GetParam().name) == "triangles") grid(100, 40);
  if (std::string(GetParam().name) == "overlapping") write("stack.gltf", stack(100000).dump());
  const std::string small =
      write("small.toml", "pictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = 16\n");
  const std::string file = write("x.toml", GetParam().toml);
  const double nothing = peak({"run", small, "--out", "small"}), measured = peak({"run", file, "--out", "out"});
  const Experiment experiment = load_experiment(file);
  const double predicted =
      Workbench(gl::DebugMode::log).memory(experiment.base, true, experiment.pictures != "none").bytes();
  EXPECT_LE(measured, predicted);
  EXPECT_GT(measured, 1.4 * nothing) << "the point is too small for a comparison";
  EXPECT_LE(predicted - nothing, estimate_factor * (measured - nothing));
}
INSTANTIATE_TEST_SUITE_P(
    Dominated, MemoryOf,
    testing::Values(
        Case{"pixels", "pictures = \"first\"\n[view]\nwidth_px = 1280\nheight_px = 720\n[map]\nresolution = 64\n"},
        Case{"taps",
             "pictures = \"none\"\n[view]\nwidth_px = 640\nheight_px = 360\n[map]\nextent_scale = 4\n[filter]\nkind = "
             "\"box\"\nsize = 9\n"},
        Case{"texels", "pictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = 4096\n"},
        // Too large to be kept on the device (most_kept_map_bytes).
        Case{"large_map", "pictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = 8192\n"},
        // Cascades: the arrays of their drawn, exact and tie maps are kept, or are too large for that.
        Case{"cascades",
             "scene = \"street\"\npictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = "
             "2048\nfit "
             "= \"sphere\"\nreach_m = 80\n[cascades]\ncount = 4\n"},
        Case{"large_cascades",
             "scene = \"street\"\npictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = "
             "6144\nfit "
             "= \"sphere\"\nreach_m = 80\n[cascades]\ncount = 3\n"},
        Case{"snapped_cascades_that_move",
             "scene = \"street\"\npictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\nnear_m = "
             "0.2\n[map]\nresolution = "
             "2048\nfit = \"sphere\"\nreach_m = 80\nsnap = true\n[cascades]\ncount = 4\n[motion]\nmove_m = [0.1, 0, "
             "0.3]\n"},
        Case{"cube",
             "scene = \"point-room\"\npictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = "
             "1536\n"},
        Case{"triangles",
             "scene = \"grid.gltf\"\npictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = "
             "64\n"},
        Case{"overlapping",
             "scene = \"stack.gltf\"\npictures = \"none\"\n[view]\nwidth_px = 16\nheight_px = 16\n[map]\nresolution = "
             "64\n"}),
    [](const auto& one) { return std::string(one.param.name); });

// `render` also lists every part in point.json.
TEST_F(Memory, TilesAreListedAsPredicted) {
  const std::string scene = grid(40, 3, std::string(200, 'n'));
  const std::string file = write("x.toml",
                                 "[scene]\nname = \"grid.gltf\"\nmesh = \"tiles\"\n[view]\nwidth_px = 16\nheight_px = "
                                 "16\n[map]\nresolution = 64\n");
  const double measured = peak({"render", file, "--out", "out"});
  const double predicted = Workbench(gl::DebugMode::log).memory(load_experiment(file).base, true, true).bytes();
  EXPECT_LE(measured, predicted);
  EXPECT_LE(predicted, estimate_factor * measured);
}

// In bytes, of this process so far.
double peak_of_this_process() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return 1024.0 * std::stod(line.substr(6));
  return std::numeric_limits<double>::quiet_NaN();
}

// Strips have half a MB. The taps of the widest kernel fill 120 of them.
TEST_F(Memory, DoesNotGrowWithTheKernel) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a new process: other tests of this one may have used more
  const auto measure = [](const char* size) {
    Settings settings;
    for (const auto& [name, value] :
         std::initializer_list<std::pair<const char*, const char*>>{{"scene.name", "plane"},
                                                                    {"view.width_px", "320"},
                                                                    {"view.height_px", "200"},
                                                                    {"filter.kind", "box"},
                                                                    {"filter.size", size},
                                                                    {"map.resolution", "256"}})
      find_setting(name).set(settings, value);
    const Measurement m = Workbench(gl::DebugMode::log, {}, std::make_unique<Pipeline>(strips_in_kept_taps << 19))
                              .measure(settings, std::nullopt);
    return m.record.metrics.at("contract") == 0;
  };
  const auto grows_by = [&] {
    if (!measure("3")) return std::numeric_limits<double>::infinity();
    const double narrow = peak_of_this_process();
    return measure("31") ? peak_of_this_process() - narrow : std::numeric_limits<double>::infinity();
  };
  EXPECT_EXIT(
      {
        const double bytes = grows_by();
        std::cerr << "it grows by " << bytes << " bytes\n";
        _exit(bytes < 25e6 ? 0 : 1);  // all taps together would take 61 MB, the wide kernel's shader up to 15 (Mesa 25)
      },
      testing::ExitedWithCode(0), "it grows by");
}

TEST_F(Memory, ADryRunNamesIt) {
  const std::string file =
      write("x.toml", "[view]\nwidth_px = 64\nheight_px = 36\n[sweep]\nmap.resolution = [64, 2048]\n");
  ASSERT_EQ(run({"run", file, "--dry-run"}), 0) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("map.resolution = 64  \\([0-9.]+ MB\\)"))) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("at most [0-9.]+ MB, by point 1 .* [0-9.]+ [MG]B are available")))
      << output_;
}

TEST_F(Memory, APointThatDoesNotFitIsRefusedBeforeAnyIsMeasured) {
  const std::string file = write("x.toml",
                                 "pictures = \"none\"\n[view]\nwidth_px = 64\nheight_px = "
                                 "36\n[sweep]\nmap.resolution = [64, 16384]\n");
  const rlim_t space = rlim_t{1900} << 20;
  for (const char* dry : {"", "--dry-run"}) {
    std::vector<std::string> arguments = {"run", file, "--out", "out"};
    if (*dry) arguments.push_back(dry);
    EXPECT_EQ(run_within(space, arguments), 2) << output_;
    EXPECT_TRUE(says("point 1 (map.resolution = 16384)") && says("for the shadow map") && says("ulimit -v") &&
                says("lower map.resolution\n"))
        << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out/results.csv"));
  }
  EXPECT_EQ(run_within(space, {"render", file, "--point", "1", "--out", "out"}), 2) << output_;
  EXPECT_TRUE(says("lower map.resolution")) << output_;
  EXPECT_EQ(run_within(space, {"run", file, "--out", "small", "--set", "map.resolution=64"}), 0) << output_;
}

// The visibility of a frame as an NPY file whose bytes are not on the disk. A picture that is too large to be judged is refused by
// its header, before its values are read.
TEST_F(Memory, AFrameThatDoesNotFitIsRefused) {
  const auto picture = [&](int side) {
    std::string header = fmt::format("{{'descr': '|u1', 'fortran_order': False, 'shape': ({0}, {0}), }}", side);
    header.resize(118, ' ');
    std::ofstream(folder_ / "V.npy", std::ios::binary) << "\x93NUMPY" << std::string("\1\0\x76\0", 4) << header;
    fs::resize_file(folder_ / "V.npy", 128 + static_cast<uintmax_t>(side) * static_cast<uintmax_t>(side));
    return Words{"judge", "cube-room", "--picture", "V.npy", "--out", "out"};
  };
  const rlim_t space = rlim_t{900} << 20;
  for (const auto& [side, words] :
       {std::pair(4000, "to judge 4000 x 4000 pixels takes"), {15000, "to judge 15000 x 15000 pixels takes"}}) {
    EXPECT_EQ(run_within(space, picture(side)), 3) << output_;
    EXPECT_TRUE(says(words)) << output_;
    EXPECT_TRUE(says("V.npy")) << output_;
    EXPECT_TRUE(says("are available")) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out/judge.json"));
  }
}

// At every limit of address space, a sweep is either refused before its first point or measured completely, and a dry
// run predicts which. Points with different kernels free and allocate memory, and the C library keeps freed memory.
TEST_F(Memory, ADryRunSaysWhatARunWillSay) {
  int refused = 0, measured = 0;
  for (const char* pictures : {"none", "first"}) {
    const std::string file = write("x.toml", "scene = \"cube-room\"\npictures = \"" + std::string(pictures) +
                                                 "\"\n[view]\nwidth_px = 320\nheight_px = 180\n[filter]\nkind = "
                                                 "\"box\"\n[sweep]\nfilter.size = [3, 5]\n");
    for (rlim_t megabytes = 1060; megabytes <= 1660; megabytes += 200) {
      SCOPED_TRACE(std::string(pictures) + " " + std::to_string(megabytes));
      const auto code = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"run", file, "--threads", "2", "--out", "out"});
        return run_within(megabytes * 1'000'000, more);
      };
      fs::remove_all(folder_ / "out");
      const int dry = code({"--dry-run"});
      const std::string said = output_;
      EXPECT_EQ(code({}), dry) << said << output_;
      EXPECT_TRUE(dry == 0 || dry == 2 || dry == 4) << said;
      EXPECT_EQ(fs::exists(folder_ / "out/results.csv"), dry == 0) << output_;
      EXPECT_FALSE(says("1/2") && dry != 0) << "a point was measured: " << output_;
      ++(dry == 0 ? measured : refused);
    }
  }
  EXPECT_GT(refused, 1);
  EXPECT_GT(measured, 1);
}

TEST_F(Memory, InstancesAreCountedBeforeTheyAreMade) {
  const std::string scene = grid(100, 3350);  // 67 million triangles in a file of half a megabyte
  EXPECT_LT(fs::file_size(scene), 1'200'000u);
  EXPECT_EQ(run_within(rlim_t{8} << 30, {"render", "--set", "scene.name=" + scene}), 3) << output_;
  EXPECT_TRUE(says("its 67000000 triangles") && says("GB are available")) << output_;
}

TEST_F(Memory, TheModelOfAFileIsCountedBeforeItIsMade) {
  test::json scene = test::square();
  scene["materials"] = test::json::array();
  for (int i = 0; i < 2'000'000; ++i) scene["materials"].push_back(test::json::object());
  EXPECT_EQ(run_within(rlim_t{4} << 30, {"render", "--set", "scene.name=" + write("scene.gltf", scene.dump())}), 3)
      << output_;
  EXPECT_TRUE(says("its JSON takes about 6.") && says("GB are available")) << output_;
}

TEST_F(Memory, OtherTrianglesAreCountedBeforeTheyAreMade) {
  const auto render = [&](const std::string& scene, const char* mesh) {
    return run_within(rlim_t{8} << 30, {"render", "--set", "scene.name=" + scene, "--set",
                                        std::string("scene.mesh=") + mesh, "--out", "out"});
  };
  const std::string below = grid(100, 50);  // 64 million tiles
  EXPECT_EQ(render(below, "tiles"), 2) << output_;
  EXPECT_TRUE(says("scene.mesh = tiles makes 64000000 triangles of its 1000000") && says("ulimit -v")) << output_;
  EXPECT_EQ(render(below, "t_junctions"), 2) << output_;
  EXPECT_TRUE(says("scene.mesh = t_junctions makes 23000000 triangles of its 1000000")) << output_;
  const std::string above = grid(100, 60);
  EXPECT_EQ(render(above, "tiles"), 2) << output_;
  EXPECT_TRUE(says("76800000 triangles of its 1200000, which are more than the 67108864 allowed")) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
