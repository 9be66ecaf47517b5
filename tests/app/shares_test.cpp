// The split of an experiment into shares.
#include "app/sweep/shares.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "measure/stage_keys.h"

namespace noonmark {
namespace {

std::string list_of(const std::vector<int>& values) {
  std::string text;
  for (int value : values) text += (text.empty() ? "" : ", ") + std::to_string(value);
  return "[" + text + "]";
}

// Bias changes fastest where it is last, so the points of a group do not always follow each other.
Experiment grid(const std::vector<int>& resolutions, const std::vector<int>& widths, const std::vector<int>& biases,
                bool bias_first) {
  const std::string bias = "\"bias.constant\" = " + list_of(biases) + "\n";
  return parse_experiment("scene = \"plate\"\npictures = \"none\"\n[sweep]\n" + (bias_first ? bias : "") +
                              "\"map.resolution\" = " + list_of(resolutions) +
                              "\n\"view.width_px\" = " + list_of(widths) + "\n" + (bias_first ? "" : bias),
                          "grid.toml");
}

std::string group_of(const Settings& point) { return truth_key_of(point) + "\n" + map_key_of(point); }

RC_GTEST_PROP(Shares, HaveEveryPointOnceAndGroupsWhole, ()) {
  const auto few = [](int from, int step) {
    std::vector<int> values(static_cast<size_t>(*rc::gen::inRange(1, 5)));
    for (size_t i = 0; i < values.size(); ++i) values[i] = from + step * static_cast<int>(i);
    return values;
  };
  const Experiment experiment = grid(few(64, 480), few(16, 100), few(0, 1), *rc::gen::arbitrary<bool>());
  const std::vector<Settings> planned = points(experiment);
  const int n = *rc::gen::inRange(1, 30);
  const std::vector<Share> shares = split(experiment, planned, n);
  RC_ASSERT(shares.size() == static_cast<size_t>(n));

  std::set<int64_t> seen;
  std::map<std::string, size_t> share_of;
  uint64_t all = 0, most = 0;
  size_t groups = 0, with_points = 0;
  for (size_t s = 0; s < shares.size(); ++s) {
    all += shares[s].cost;
    most = std::max(most, shares[s].cost);
    groups += shares[s].groups;
    with_points += !shares[s].points.empty();
    RC_ASSERT(shares[s].points.empty() == (shares[s].groups == 0));
    for (const int64_t id : shares[s].points) {
      RC_ASSERT(seen.insert(id).second);
      const auto [at, added] = share_of.emplace(group_of(planned[static_cast<size_t>(id)]), s);
      RC_ASSERT(at->second == s);
    }
  }
  RC_ASSERT(seen.size() == planned.size());
  RC_ASSERT(groups == share_of.size());
  RC_ASSERT(with_points == std::min(groups, shares.size()));  // no machine waits while another has two groups

  // The largest share is the least possible one of all runs of groups: found here by trying every border.
  const std::vector<Share> alone = split(experiment, planned, static_cast<int>(groups));
  std::vector<uint64_t> costs;
  for (const Share& one : alone) costs.push_back(one.cost);
  RC_ASSERT(std::accumulate(costs.begin(), costs.end(), uint64_t{0}) == all);
  std::vector<uint64_t> best(costs.size() + 1, 0);  // of the groups before g, in k runs
  for (size_t g = 1; g <= costs.size(); ++g) best[g] = best[g - 1] + costs[g - 1];
  for (int k = 2; k <= n; ++k) {
    std::vector<uint64_t> next = best;
    for (size_t g = 1; g <= costs.size(); ++g) {
      uint64_t last = 0;
      for (size_t from = g; from-- > 0;) {
        last += costs[from];
        next[g] = std::min(next[g], std::max(best[from], last));
      }
    }
    best = next;
  }
  RC_ASSERT(most == best.back());
}

TEST(Shares, DoNotDependOnTheRunOrTheBounds) {
  const Experiment experiment = grid({256, 512, 1024}, {32, 64}, {0, 1, 2}, true);
  Experiment other = experiment;
  other.title = "another title";
  const std::vector<Share> a = split(experiment, points(experiment), 4), b = split(other, points(other), 4);
  for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].points, b[i].points);
}

TEST(Shares, MorePixelsCostMore) {
  const Experiment small = grid({512}, {64}, {0}, true), large = grid({512}, {640}, {0}, true);
  EXPECT_GT(split(large, points(large), 1)[0].cost, split(small, points(small), 1)[0].cost);
  const Experiment coarse = grid({64}, {64}, {0}, true), fine = grid({8192}, {64}, {0}, true);
  EXPECT_GT(split(fine, points(fine), 1)[0].cost, split(coarse, points(coarse), 1)[0].cost);
}

TEST(Shares, AreWrittenAsTwoNumbers) {
  EXPECT_EQ(shard_from("2/4").number, 2);
  EXPECT_EQ(shard_from("2/4").of, 4);
  EXPECT_EQ(shard_from("2/4").text(), "2/4");
  EXPECT_EQ(shard_from("10000/10000").of, most_shards);
  for (const char* text : {"", "2", "/", "2/", "/4", "0/4", "5/4", "-1/4", "2/4/8", "2 /4", "2/4 ", "a/b", "1/0",
                           "1/10001", "99999999999/4", "+1/4", "1.0/4"})
    EXPECT_THROW(shard_from(text), Error) << text;
}

class SlurmShare : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : names) unsetenv(name);
  }
  void TearDown() override { SetUp(); }
  static void task(const char* id, const char* from, const char* to, const char* step, const char* count = nullptr) {
    const char* const values[] = {id, from, to, step, count};
    for (size_t i = 0; i < std::size(names); ++i)
      if (values[i]) setenv(names[i], values[i], 1);
  }
  static constexpr const char* names[] = {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX",
                                          "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT"};
};

TEST_F(SlurmShare, IsThatOfTheTask) {
  EXPECT_FALSE(slurm_shard());
  task("3", "1", "4", "1", "4");
  EXPECT_EQ(slurm_shard()->text(), "3/4");
  SetUp();
  task("0", "0", "3", nullptr);
  EXPECT_EQ(slurm_shard()->text(), "1/4");
  SetUp();
  task("14", "10", "18", "4", "3");  // --array=10-18:4
  EXPECT_EQ(slurm_shard()->text(), "2/3");
}

TEST_F(SlurmShare, IsRefusedWhereTheTasksDoNotSayHowManyThereAre) {
  task("3", "1", "7", "1", "3");  // --array=1,3,7
  EXPECT_THROW(slurm_shard(), Error);
  SetUp();
  task("2", "2", "2", "1", "1");  // --array=2: a lost share that is run again
  EXPECT_THROW(slurm_shard(), Error);
  SetUp();
  task("9", "1", "4", "1");
  EXPECT_THROW(slurm_shard(), Error);
}

}  // namespace
}  // namespace noonmark
