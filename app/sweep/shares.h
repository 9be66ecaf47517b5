// Splits an experiment into shares that several machines measure, each by itself: noonmark run --shard 2/4.
//
//   const Shard shard = shard_from("2/4");
//   const std::vector<Share> shares = split(experiment, points(experiment), shard.of);
//   for (int64_t id : shares[shard.number - 1].points) measure(id);
//
// Points that share scene, view, light and map are a group and stay together, so that no truth is traced on two machines. A
// share is a run of groups, in the order in which the experiment first has them; its points are listed group by group. The
// shares are those whose largest cost is the least possible. The cost of a point comes from the settings alone. So
// the split depends on the experiment and n, and on nothing else. A lost share can be measured again on any machine.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/definition/experiment.h"

namespace noonmark {

// Which share: number from 1 to `of`.
struct Shard {
  int number = 1, of = 1;
  std::string text() const;    // "2/4"
  std::string folder() const;  // "share-2-of-4": its results, below the folder of --out
};
inline constexpr int most_shards = 10000;

// From "2/4". Throws Error(usage).
Shard shard_from(std::string_view text);

// The task of a Slurm array that the program runs in, by SLURM_ARRAY_TASK_ID, _MIN, _MAX, _STEP and _COUNT. Empty outside an
// array. Throws Error(usage) if the variables do not say how many shares there are: tasks that are not evenly numbered, or
// one task alone, which most likely runs a lost share again.
std::optional<Shard> slurm_shard();

struct Share {
  std::vector<int64_t> points;  // ids, in the order to measure them; empty if there are fewer groups than shares
  size_t groups = 0;
  uint64_t cost = 0;  // the sum of nominal_cost()
};

// The points of one share, and what is printed of one without points.
std::vector<int64_t> points_of_share(const Experiment& experiment, const Shard& shard);
std::string no_points_text(const Shard& shard);

// n shares, of which the last ones may be empty. planned: points(experiment).
std::vector<Share> split(const Experiment& experiment, const std::vector<Settings>& planned, int n);

}  // namespace noonmark
