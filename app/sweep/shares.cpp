#include "app/sweep/shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <unordered_map>

#include "base/error.h"
#include "measure/pass_times.h"
#include "measure/stage_keys.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// The factors are nanoseconds of processor time for one of each count, rounded, as they were measured for cube-room on two cores
// with llvmpipe. They only have to be in proportion.
// In microseconds of one machine (two cores with llvmpipe), of which only ratios matter: counts, weighed with fixed costs, in
// integers. So it is the same number on every machine. before: the point that was measured before, which left its values in the
// workbench (measure/stage_keys.h); null: none. options: empty without a bias curve. timed: map and lookup are timed.
uint64_t nominal_cost(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                      bool timed) {
  const auto anew = [&](const auto& key) { return !before || key(s) != key(*before); };
  const uint64_t pixels = static_cast<uint64_t>(s.view.width_px) * static_cast<uint64_t>(s.view.height_px);
  const TapPattern pattern = tap_pattern(s);
  const uint64_t taps = pixels * static_cast<uint64_t>(pattern.taps);
  const uint64_t texels = static_cast<uint64_t>(s.map.resolution) * static_cast<uint64_t>(s.map.rows());
  const uint64_t look = 300 * taps, compare = 200 * taps;
  uint64_t ns = 10'000'000 + compare;
  if (anew(scene_key_of)) ns += 50'000'000;
  if (anew(map_key_of)) ns += 3 * texels * (timed ? 1 + 2 * timed_rounds : 1);
  if (anew(view_key_of)) ns += 170 * pixels;
  if (anew(truth_key_of)) {
    const bool sized = s.light.angular_diameter_deg.value_or(0) > 0 || s.light.radius_m.value_or(0) > 0;
    ns += (sized ? 30 + 300 : 30) * pixels;
  }
  if (anew(lookup_key_of)) ns += look;
  if (timed && anew(lookup_work_of)) ns += 60 * taps;
  const BiasPart* const varied = options ? curve_part(s) : nullptr;
  if (varied && anew([&](const Settings& one) { return curve_key_of(one, *varied, *options); })) ns += 60 * taps;
  if (s.map.placements > 1) {
    const auto side = static_cast<uint64_t>(s.map.placements);
    // Of a filtered map each placement is looked up and compared by itself.
    ns += pattern.blurred ? (look + compare) * (side * side - 1) : 70 * taps * side * side;
  }
  return ns / 1000 + 1;
}

struct Group {
  std::vector<int64_t> points;
  uint64_t cost = 0;
};

// A whole number of the text and nothing else; empty if it is none.
std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<Group> groups_of(const Experiment& experiment, const std::vector<Settings>& planned) {
  const bool timed = times_measured(experiment);
  std::vector<Group> groups;
  std::unordered_map<std::string, size_t> by_key;
  for (size_t i = 0; i < planned.size(); ++i) {
    const auto [found, added] = by_key.emplace(truth_key_of(planned[i]) + map_key_of(planned[i]), groups.size());
    if (added) groups.emplace_back();
    groups[found->second].points.push_back(static_cast<int64_t>(i));
  }
  const Settings* before = nullptr;
  for (Group& group : groups)
    for (const int64_t id : group.points) {
      const Settings& point = planned[static_cast<size_t>(id)];
      const Experiment& part = part_of_point(experiment, id);
      group.cost += nominal_cost(point, before, part.curve_enabled ? std::optional(part.curve) : std::nullopt, timed);
      before = &point;
    }
  return groups;
}

// How many runs the groups need if no run may cost more than `most`.
size_t runs_within(const std::vector<Group>& groups, uint64_t most) {
  size_t runs = 1;
  uint64_t sum = 0;
  for (const Group& group : groups) {
    if (sum + group.cost > most) {
      ++runs;
      sum = 0;
    }
    sum += group.cost;
  }
  return runs;
}

// The least cost that the largest of n runs can have.
uint64_t least_largest(const std::vector<Group>& groups, size_t n) {
  uint64_t low = 0, high = 0;
  for (const Group& group : groups) {
    low = std::max(low, group.cost);
    high += group.cost;
  }
  while (low < high) {
    const uint64_t middle = low + (high - low) / 2;
    if (runs_within(groups, middle) <= n)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

// The same for the groups from each group on: element g counts the runs of the groups g, g + 1, ...
std::vector<size_t> runs_from(const std::vector<Group>& groups, uint64_t most) {
  std::vector<size_t> runs(groups.size() + 1, 0);
  uint64_t sum = 0;  // of the groups from g to end - 1
  size_t end = groups.size();
  for (size_t g = groups.size(); g-- > 0;) {
    sum += groups[g].cost;
    while (sum > most) sum -= groups[--end].cost;
    runs[g] = 1 + runs[end];
  }
  return runs;
}

}  // namespace

std::string Shard::text() const { return fmt::format("{}/{}", number, of); }
std::string Shard::folder() const { return fmt::format("share-{}-of-{}", number, of); }

Shard shard_from(std::string_view text) {
  const size_t slash = std::min(text.find('/'), text.size());
  const int number = whole(text.substr(0, slash)).value_or(0);
  const int of = slash < text.size() ? whole(text.substr(slash + 1)).value_or(0) : 0;
  if (of < 1 || of > most_shards || number < 1 || number > of)
    throw Error(
        ErrorKind::usage,
        fmt::format("--shard {}: give the number of the share and how many there are, as 2/4: from 1/1 to {}/{}", text,
                    most_shards, most_shards));
  return {number, of};
}

std::optional<Shard> slurm_shard() {
  const auto read = [](const char* name) {
    const char* const text = std::getenv(name);
    return text ? whole(text) : std::nullopt;
  };
  const std::optional<int> id = read("SLURM_ARRAY_TASK_ID"), from = read("SLURM_ARRAY_TASK_MIN"),
                           to = read("SLURM_ARRAY_TASK_MAX");
  if (!id || !from || !to) return std::nullopt;
  const int step = read("SLURM_ARRAY_TASK_STEP").value_or(1);
  const auto refuse = [&](const std::string& why) {
    throw Error(
        ErrorKind::usage,
        fmt::format("this is task {} of a Slurm array {}; give the share with --shard, as --shard {}/4 (--shard "
                    "1/1 measures all points)",
                    *id, why, std::max(1, *id)));
  };
  if (step < 1 || *from < 0 || *to < *from || *id < *from || *id > *to || (*to - *from) / step >= most_shards ||
      (*to - *from) % step != 0 || (*id - *from) % step != 0)
    refuse(fmt::format("from {} to {} in steps of {}, which does not say how many shares there are", *from, *to, step));
  const int tasks = (*to - *from) / step + 1;
  if (tasks == 1) refuse("of one task, which does not say how many shares there are");
  if (const std::optional<int> count = read("SLURM_ARRAY_TASK_COUNT"); count && *count != tasks)
    refuse(fmt::format("of {} tasks with numbers from {} to {}, so some are left out", *count, *from, *to));
  return Shard{(*id - *from) / step + 1, tasks};
}

std::vector<int64_t> points_of_share(const Experiment& experiment, const Shard& shard) {
  std::vector<Share> shares = split(experiment, points(experiment), shard.of);
  return std::move(shares[static_cast<size_t>(shard.number - 1)].points);
}

std::string no_points_text(const Shard& shard) {
  return fmt::format(
      "share {} has no points: the experiment has fewer groups (points that share scene, view, light and map) than "
      "there "
      "are shares; nothing is measured and nothing is written\n",
      shard.text());
}

std::vector<Share> split(const Experiment& experiment, const std::vector<Settings>& planned, int n) {
  const std::vector<Group> groups = groups_of(experiment, planned);
  const uint64_t most = least_largest(groups, static_cast<size_t>(n));
  const std::vector<size_t> runs = runs_from(groups, most);
  std::vector<Share> shares(static_cast<size_t>(n));
  uint64_t left = 0;
  for (const Group& group : groups) left += group.cost;
  size_t at = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    const Group& group = groups[g];
    // A share ends when the next group does not fit below the largest cost, when it has its part of what is left, or when
    // each share that follows needs one of the groups that are left.
    const size_t shares_after = shares.size() - at - 1, groups_left = groups.size() - g;
    const Share& now = shares[at];
    const uint64_t even = (left + now.cost) / (shares_after + 1);
    const bool full = now.cost + group.cost > most;
    const bool even_already = now.cost + group.cost / 2 >= even && runs[g] <= shares_after;
    if (now.groups > 0 && shares_after > 0 && (full || even_already || groups_left <= shares_after)) ++at;
    Share& share = shares[at];
    share.points.insert(share.points.end(), group.points.begin(), group.points.end());
    share.cost += group.cost;
    ++share.groups;
    left -= group.cost;
  }
  return shares;
}

}  // namespace noonmark
