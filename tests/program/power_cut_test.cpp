// The power fails at any moment of a check. Every point that was reported as measured must still be there, and the
// check must continue to the same results. The kill tests cannot show this, because the system still writes the data of
// a killed program to the disk.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <random>

#include "base/error.h"
#include "compare/store/store.h"
#include "tests/program/fixture.h"
#include "tests/program/lossy_disk.h"
#include "tests/support/sample_results.h"

namespace noonmark::acceptance {
namespace {

const std::string cut_sweep = R"(
scene = "plate"
pictures = "first"
[view]
width_px = 32
height_px = 18
[curve]
bias_depth = [0, 0.001, 0.01]
[sweep]
map.resolution = [16, 24, 32]
bias.constant = [0, 0.01]
[[bound]]
metric = "residual"
max = 1e-6
)";
constexpr int64_t points = 6;

struct Disk {
  const char* name;
  bool network;         // the folder claims to be on a network file system
  const char* journal;  // the file that the store must have been written with
};

void PrintTo(const Disk& disk, std::ostream* out) { *out << disk.name; }

class PowerCut : public Program, public testing::WithParamInterface<Disk> {
 protected:
  // Runs a check with its results in disk/new/out and returns what it did to the folder disk.
  std::vector<test::DiskStep> traced_check() {
    make_folder((folder_ / "disk").string());
    const auto prepare = [&] {
      setenv("LD_PRELOAD", NOONMARK_PRELOAD_DISK, 1);
      setenv("NOONMARK_TEST_DISK_ROOT", (folder_ / "disk").c_str(), 1);
      setenv("NOONMARK_TEST_DISK_LOG", (folder_ / "trace").c_str(), 1);
      if (GetParam().network) setenv("NOONMARK_TEST_DISK_NETWORK", "1", 1);
    };
    EXPECT_EQ(run({"check", write("sweep.toml", cut_sweep), "--out", "disk/new/out"}, prepare), 0) << output_;
    return test::read_trace((folder_ / "trace").string());
  }
};

TEST_P(PowerCut, LosesNothingThatWasSaidToBeMeasured) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer must be loaded before anything else";
#endif
  const std::vector<test::DiskStep> steps = traced_check();
  ASSERT_GT(steps.size(), 300u);
  // The journal of this kind of file system is the one that took the points, and a finished store is one file.
  const std::string journal = GetParam().journal;
  EXPECT_GT(std::count_if(steps.begin(), steps.end(),
                          [&](const test::DiskStep& step) {
                            return step.op == test::DiskOp::create && step.path.ends_with(journal);
                          }),
            0);
  EXPECT_EQ(std::count_if(steps.begin(), steps.end(),
                          [](const test::DiskStep& step) {
                            return step.op == test::DiskOp::create && step.path.ends_with("-shm");
                          }),
            GetParam().network ? 0 : 1)
      << "shared memory is for file systems of this machine";
  for (const char* ending : {"-journal", "-wal", "-shm"})
    EXPECT_FALSE(fs::exists(folder_ / ("disk/new/out/results.sqlite" + std::string(ending)))) << ending;
  const std::string root = (folder_ / "disk").string(), after = (folder_ / "after").string();
  const std::string store = "/new/out/results.sqlite";
  const Results whole = ResultStore::open(root + store).load();
  const std::string fingerprint = ResultStore::open(root + store).fingerprint();
  ASSERT_EQ(whole.points.size(), static_cast<size_t>(points));
  const std::string csv = without_times(root + "/new/out/results.csv");

  std::mt19937 random(1);
  test::LossyDisk disk(root);
  int64_t said = 0, most_found = 0;
  int cuts = 0, resumed = 0, lost = 0;
  for (size_t i = 0; i < steps.size(); ++i) {
    SCOPED_TRACE("after step " + std::to_string(i));
    disk.play(steps[i]);
    if (steps[i].op == test::DiskOp::said && steps[i].data.starts_with("[")) ++said;
    // Tries every step that syncs, moves or reports something, and a third of the writes.
    if (steps[i].op == test::DiskOp::write && random() % 3 != 0) continue;
    fs::remove_all(after);
    fs::create_directories(after);
    disk.cut_power(after, random);
    ++cuts;
    if (!fs::exists(after + store)) {
      ASSERT_EQ(said, 0);
      ++lost;
      continue;
    }
    {
      ResultStore opened(after + store, fingerprint, Existing::resume);
      const Results left = opened.load();  // loading checks the seals
      const auto found = static_cast<int64_t>(left.points.size());
      ASSERT_GE(found, said) << "a point that was reported as measured is lost";
      ASSERT_LE(found, said + 1) << "only the point that was being stored may be new";
      for (int64_t id = 0; id < found; ++id)
        ASSERT_TRUE(same(left.points[static_cast<size_t>(id)].metrics, whole.points[static_cast<size_t>(id)].metrics));
      most_found = std::max(most_found, found);
    }
    // A file that is written under another name and then renamed must be complete or absent.
    for (const char* name : {"results.csv", "report.html", "junit.xml", "summary.md", "images/p0000-truth.png"}) {
      const std::string file = after + "/new/out/" + name;
      if (fs::exists(file)) {
        ASSERT_EQ(read_file(file), read_file(root + "/new/out/" + name)) << name;
      }
    }
    if (cuts % 97 != 60) continue;
    ++resumed;
    ASSERT_EQ(run({"check", (folder_ / "sweep.toml").string(), "--out", "after/new/out"}), 0) << output_;
    EXPECT_EQ(without_times(after + "/new/out/results.csv"), csv);
    for (const auto& entry : fs::recursive_directory_iterator(after))
      EXPECT_NE(entry.path().extension(), ".tmp") << "a temporary file of the interrupted run is left";
  }
  EXPECT_EQ(said, points);
  EXPECT_EQ(most_found, points);
  EXPECT_GT(lost, 0) << "no power cut came while the store was made";
  EXPECT_GT(cuts, 150);
  RecordProperty("cuts", cuts);
  EXPECT_GE(resumed, 2);
  // The trace must contain everything that the program did. Otherwise the simulated disk is wrong.
  int files = 0;
  for (const auto& [path, bytes] : disk.whole()) {
    EXPECT_EQ(bytes, read_file(path)) << path;
    ++files;
  }
  for (const auto& entry : fs::recursive_directory_iterator(root)) files -= entry.is_regular_file();
  EXPECT_EQ(files, 0);
}

INSTANTIATE_TEST_SUITE_P(Disks, PowerCut,
                         testing::Values(Disk{"Local", false, "results.sqlite-wal"},
                                         Disk{"Network", true, "results.sqlite-journal"}),
                         [](const auto& disk) { return disk.param.name; });

}  // namespace
}  // namespace noonmark::acceptance
