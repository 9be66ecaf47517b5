// Shares of an experiment and their merge (run --shard, merge): what is refused, what is missing, and what differs. The merge of
// whole shares is compared with one run in tests/project/many_machines_test.py.
#include <signal.h>
#include <stdlib.h>

#include <map>

#include "compare/store/store.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

// Two maps with two biases each. The bound holds at every point.
const std::string two_maps =
    one_point + "[sweep]\nmap.resolution = [64, 128]\nbias.constant = [0.001, 0.002]\n" + held_bound;

class Merge : public Program {
 protected:
  void measure(const std::string& shard, const std::string& out = "out", const std::string& experiment = two_maps) {
    ASSERT_EQ(run({"run", write("maps.toml", experiment), "--out", out, "--shard", shard}), 0) << output_;
  }
  void copy(const std::string& from, const std::string& to) {
    fs::create_directories((folder_ / to).parent_path());
    fs::copy(folder_ / from, folder_ / to, fs::copy_options::recursive);
  }
  // Changes what one share says of its points, as a machine would that computes otherwise.
  void set_metrics(const std::string& share, const std::map<int64_t, std::map<std::string, double>>& values) {
    const std::string path = (folder_ / share / "results.sqlite").string();
    const std::string fingerprint = ResultStore::open(path).fingerprint();
    ResultStore store(path, fingerprint, Existing::resume);
    store.set_metrics(values);
  }
  bool exists(const std::string& file) const { return fs::exists(folder_ / file); }
};

TEST_F(Merge, OfPointsThatSeveralSharesHave) {
  measure("1/2");
  measure("2/2");
  copy("out/share-2-of-2", "elsewhere");
  expect_run({"merge", "joined", "out/share-1-of-2", "out/share-2-of-2", "elsewhere"}, 0,
             {"4 of 4 points from 3 stores (2 in more than one, and alike)", ": Held: the bound at these 4 points; "});
  EXPECT_TRUE(exists("joined/report.html") && exists("joined/junit.xml") && exists("joined/summary.md"));
  EXPECT_FALSE(exists("out/share-1-of-2/junit.xml")) << "a share is not judged";
  // Again, with the shares in another order; the joined store is replaced.
  const std::string before = without_times(folder_ / "joined/results.csv");
  ASSERT_EQ(run({"merge", "joined", "elsewhere", "out/share-1-of-2"}), 0) << output_;
  EXPECT_EQ(without_times(folder_ / "joined/results.csv"), before);
}

TEST_F(Merge, ShowsBothValuesOfPointsThatDiffer) {
  measure("1/2");
  measure("2/2");
  copy("out/share-2-of-2", "elsewhere");
  ASSERT_EQ(run({"merge", "joined", "out/share-1-of-2", "out/share-2-of-2"}), 0) << output_;
  set_metrics("elsewhere", {{3, {{"acne", 0.625}}}});
  expect_run({"merge", "joined", "out/share-1-of-2", "out/share-2-of-2", "elsewhere"}, 5,
             {"point 3", "acne is 0.625 in elsewhere and "});
  for (const char* file : {"results.sqlite", "report.html", "junit.xml", "results.csv"})
    EXPECT_FALSE(exists(std::string("joined/") + file)) << file << ": nothing stale stays";
  EXPECT_TRUE(exists("elsewhere/results.sqlite") && exists("out/share-2-of-2/results.sqlite"));
}

TEST_F(Merge, NamesTheShareThatContradictsItself) {
  measure("1/2");
  measure("2/2");
  copy("out/share-2-of-2", "elsewhere");
  set_metrics("elsewhere", {{2, {{"residual", 0.5}}}});
  expect_run({"merge", "joined", "out/share-2-of-2", "elsewhere"}, 5, {"elsewhere is not sound: residual = 0.5"});
}

TEST_F(Merge, TimesMayDiffer) {
  const std::string timed = "times = true\n" + two_maps;
  measure("1/2", "out", timed);
  measure("2/2", "out", timed);
  copy("out/share-2-of-2", "elsewhere");
  set_metrics("elsewhere", {{3, {{"shadow_ms", 1e6}, {"map_ms", 1e6}}}});
  EXPECT_EQ(run({"merge", "joined", "out/share-1-of-2", "out/share-2-of-2", "elsewhere"}), 0) << output_;
}

TEST_F(Merge, NamesWhatIsMissing) {
  measure("2/2");
  expect_run({"merge", "joined", "out/share-2-of-2"}, 6,
             {"missing: 2 points from 0 to 1; measured by: noonmark run ", "--shard 1/2 --out out"});
  EXPECT_TRUE(exists("joined/report.html")) << "what is there is shown";
}

TEST_F(Merge, RefusesStoresThatDoNotBelongTogether) {
  measure("1/2");
  measure("2/2", "others",
          one_point + "[sweep]\nmap.resolution = [64, 128]\nbias.constant = [0.001, 0.003]\n" + held_bound);
  measure("2/2", "bounds", two_maps + "[[bound]]\nmetric = \"acne\"\nmax = 1\n");
  const auto refused = [&](const std::vector<std::string>& shares, const std::string& words) {
    expect_run(Words{"merge", "joined"} + shares, 2, {words});
    EXPECT_FALSE(exists("joined/results.sqlite"));
  };
  refused({"out/share-1-of-2", "others/share-2-of-2"},
          "out/share-1-of-2 and others/share-2-of-2 do not belong together");
  refused({"out/share-1-of-2", "bounds/share-2-of-2"}, "their bounds, laws, title or options are not the same");
  refused({"out/share-1-of-2", "nowhere"}, "nowhere: there are no results here");
  expect_run({"merge", "out/share-1-of-2", "out/share-1-of-2"}, 2, {"is one of the shares"});
  EXPECT_TRUE(exists("out/share-1-of-2/results.sqlite"));
  ASSERT_EQ(run({"run", write("maps.toml", two_maps), "--out", "whole"}), 0) << output_;
  expect_run({"merge", "whole", "out/share-1-of-2"}, 2, {"holds results that were measured there"});
  EXPECT_EQ(run({"merge", "whole", "out/share-1-of-2", "--overwrite"}), 6) << output_;
}

// Whenever it is killed, the same command joins anew. A third of the kills come before the store says that it is a joined one.
TEST_F(Merge, AKilledMergeIsDoneAgainByTheSameCommand) {
  measure("1/2");
  measure("2/2");
  const std::vector<std::string> merge = {"merge", "joined", "out/share-1-of-2", "out/share-2-of-2"};
  ASSERT_EQ(run(merge), 0) << output_;
  const std::string whole = without_times(folder_ / "joined/results.csv");
  constexpr int kills = 24;
  useconds_t longest = 0;  // until a merge ends by itself
  for (int code = -SIGKILL; code == -SIGKILL; longest += 20000) {
    const pid_t child = start(merge);
    usleep(longest);
    kill(child, SIGKILL);
    code = wait_for(child);
  }
  for (int i = 0; i < kills; ++i) {
    SCOPED_TRACE(i);
    if (i % 2) fs::remove_all(folder_ / "joined");
    const pid_t child = start(merge);
    usleep(longest * static_cast<useconds_t>(i) / kills);
    kill(child, SIGKILL);
    wait_for(child);
    ASSERT_EQ(run(merge), 0) << output_;
    EXPECT_EQ(without_times(folder_ / "joined/results.csv"), whole);
  }
  // The moment itself: the store knows its points' settings, and not yet what it is.
  const std::string store = (folder_ / "joined/results.sqlite").string();
  const std::string facts = ResultStore::open(store).fingerprint(), plan = ResultStore::open(store).plan();
  ResultStore(store, facts, Existing::overwrite).set_plan(facts, plan);
  EXPECT_EQ(run(merge), 0) << output_;
  // What is no store, and was not made by a merge, is not replaced.
  fs::create_directories(folder_ / "other");
  write("other/results.sqlite", "mine");
  EXPECT_EQ(run({"merge", "other", "out/share-1-of-2", "out/share-2-of-2"}), 2) << output_;
  EXPECT_EQ(text("other/results.sqlite"), "mine");
}

TEST_F(Merge, OfOtherContentsOfAScene) {
  const std::string experiment = "scene = \"../shared.gltf\"\n" + small_view + "[sweep]\nmap.resolution = [64, 128]\n";
  const auto model = [&](float height) {
    write(
        "shared.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,)" +
            std::to_string(height) +
            R"(,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
            R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,0,1]}],)"
            R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
            R"(AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAA"}]})");
  };
  fs::create_directories(folder_ / "x");
  model(0);
  write("x/a.toml", experiment);
  ASSERT_EQ(run({"run", "x/a.toml", "--out", "out", "--shard", "1/2"}), 0) << output_;
  model(0.5f);
  ASSERT_EQ(run({"run", "x/a.toml", "--out", "out", "--shard", "2/2"}), 0) << output_;
  expect_run({"merge", "joined", "out/share-1-of-2", "out/share-2-of-2"}, 2, {"the contents of the scene shared.gltf"});
  // Named by an absolute path, the experiment belongs to one host; the joined store does not hold that path.
  const std::string here = (folder_ / "x/a.toml").string();
  for (const char* shard : {"1/2", "2/2"})
    ASSERT_EQ(run({"run", here, "--out", "abs", "--shard", shard}), 0) << output_;
  EXPECT_EQ(run({"merge", "joined", "abs/share-1-of-2", "abs/share-2-of-2"}), 0) << output_;
  EXPECT_EQ(text("joined/results.sqlite").find(folder_.string()), std::string::npos);
}

TEST_F(Merge, ASlurmTaskIsAShare) {
  const auto as_task = [&](const char* id, const std::vector<std::string>& more, const std::string& out) {
    return run(Words{"run", write("maps.toml", two_maps), "--out", out} + more, [&] {
      setenv("SLURM_ARRAY_TASK_ID", id, 1);
      setenv("SLURM_ARRAY_TASK_MIN", "10", 1);
      setenv("SLURM_ARRAY_TASK_MAX", "11", 1);
    });
  };
  ASSERT_EQ(as_task("11", {}, "out"), 0) << output_;
  EXPECT_TRUE(says("--shard 2/2 is taken")) << output_;
  EXPECT_TRUE(exists("out/share-2-of-2/results.sqlite"));
  ASSERT_EQ(as_task("11", {"--shard", "1/1"}, "whole"), 0) << output_;
  EXPECT_TRUE(exists("whole/results.sqlite"));
}

TEST_F(Merge, WhatAShareCannotDoIsSaid) {
  const std::string file = write("maps.toml", two_maps);
  EXPECT_EQ(run({"run", file, "--out", "out", "--shard", "3/2"}), 2) << output_;
  expect_run({"check", file, "--out", "out", "--shard", "1/2", "--baseline", "b.json"}, 2, {"merge the shares"});
  expect_run({"run", file, "--out", "out", "--shard", "3/3"}, 0, {"share 3/3 has no points"});
  EXPECT_FALSE(exists("out"));
  expect_run({"run", file, "--dry-run", "--shard", "2/3"}, 0,
             {"share 1/3: 2 points from 0 to 1 in 1 group", "share 3/3: no points"});
  expect_run({"check", file, "--out", "out", "--shard", "1/2"}, 0, {"not judged: noonmark merge does that"});
}

}  // namespace
}  // namespace noonmark::acceptance
