// The same experiment gives the same bytes: on one thread and on two, in another run, and after a kill.
#include <signal.h>

#include <set>
#include <sstream>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

// One setting of each kind: a light with a size (sampled), filters, slopes, formats, culled faces, curves.
const std::string repeated_sweep = R"(
scene = "cube-room"
pictures = "none"
[view]
width_px = 160
height_px = 90
[light]
angular_diameter_deg = 2
[bias]
slope_floor = 0.005
[truth]
standard_error = 0.05
[sweep]
map.resolution = [100, 256]
map.format = ["16", "32f"]
map.cull = ["none", "front"]
bias.slope = [0, 0.05]
filter.kind = ["none", "box"]
[[bound]]
metric = "residual"
max = 1e-6
)";

class Determinism : public Program {
 protected:
  // No times are measured, so every byte is the same.
  std::string results(const std::string& out) const {
    const std::string csv = with_all_columns(folder_ / out / "results.csv");
    EXPECT_GT(csv.size(), 32u * 200u);
    return csv;
  }
};

TEST_F(Determinism, OneThreadOrTwoAndAgain) {
  write("x.toml", repeated_sweep);
  ASSERT_EQ(run({"run", "x.toml", "--out", "one", "--threads", "1"}), 0) << output_;
  ASSERT_EQ(run({"run", "x.toml", "--out", "two", "--threads", "2"}), 0) << output_;
  ASSERT_EQ(run({"run", "x.toml", "--out", "again"}), 0) << output_;
  const std::string expected = results("one");
  EXPECT_EQ(results("two"), expected);
  EXPECT_EQ(results("again"), expected);
}

// No file but the store says when and how long a run was. junit.xml does, because its format asks for it.
TEST_F(Determinism, EqualRunsWriteEqualFiles) {
  write("x.toml",
        "scene = \"cube-room\"\npictures = \"first\"\n[view]\nwidth_px = 64\nheight_px = 36\n[[bound]]\n"
        "metric = \"residual\"\nmax = -1\n");
  const auto check = [&](const fs::path& out) {
    fs::remove_all(folder_ / "out");
    ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 1) << output_;
    fs::rename(folder_ / "out", folder_ / out);
  };
  check("one");
  sleep(1);  // dates in files count whole seconds
  check("two");
  int compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "one")) {
    const fs::path file = entry.path().lexically_relative(folder_ / "one");
    if (!entry.is_regular_file() || file == "results.sqlite" || file == "junit.xml") continue;
    EXPECT_EQ(text("one" / file), text("two" / file)) << file;
    ++compared;
  }
  EXPECT_GE(compared, 15) << "two EXR files, the pictures, the report, the table and the summary";
}

TEST_F(Determinism, AKilledRunOnTwoThreadsGoesOnOnOne) {
  write("x.toml", repeated_sweep);
  ASSERT_EQ(run({"run", "x.toml", "--out", "whole"}), 0) << output_;
  const pid_t child = start_until("[5/32]", {"run", "x.toml", "--out", "killed", "--threads", "2"});
  kill(child, SIGKILL);
  wait_for(child);
  EXPECT_FALSE(fs::exists(folder_ / "killed/results.csv")) << "the run ended before it could be killed";
  expect_run({"run", "x.toml", "--out", "killed", "--threads", "1"}, 0, {"points are in killed already"});
  EXPECT_EQ(results("killed"), results("whole"));
}

// A point reuses data that an earlier point left in memory. This must not change its results.
TEST_F(Determinism, APointDoesNotDependOnThoseBefore) {
  write("x.toml", repeated_sweep);
  std::string reversed = repeated_sweep;
  const auto swap_values = [&](const std::string& from, const std::string& to) {
    const size_t at = reversed.find(from);
    ASSERT_NE(at, std::string::npos);
    reversed.replace(at, from.size(), to);
  };
  swap_values("[100, 256]", "[256, 100]");
  swap_values("[\"16\", \"32f\"]", "[\"32f\", \"16\"]");
  swap_values("bias.slope = [0, 0.05]", "bias.slope = [0.05, 0]");
  write("r.toml", reversed);
  ASSERT_EQ(run({"run", "x.toml", "--out", "a"}), 0) << output_;
  ASSERT_EQ(run({"run", "r.toml", "--out", "b"}), 0) << output_;
  // The same lines in another order, under other numbers.
  const auto lines = [&](const std::string& out) {
    std::multiset<std::string> set;
    std::istringstream in(results(out));
    for (std::string line; std::getline(in, line);)
      if (!line.empty()) set.insert(line.substr(line.find(',')));
    return set;
  };
  EXPECT_EQ(lines("a"), lines("b"));
}

}  // namespace
}  // namespace noonmark::acceptance
