#include "measure/pass_times.h"

#include <algorithm>
#include <set>

#include "compare/judge/interval.h"
#include "measure/stage_keys.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// The samples of each work, one for each finished round.
using Samples = std::map<std::string, std::vector<double>>;

struct Work {
  std::string map, lookup;
};

// One sample of each work that has none in this round.
void sample_round(const SamplePasses& sample, std::span<const Settings> points, const std::vector<size_t>& picture,
                  const std::vector<Work>& work, size_t round, Samples& maps, Samples& filters, Samples& lookups) {
  for (const size_t i : picture) {
    std::vector<double>&map = maps[work[i].map], &lookup = lookups[work[i].lookup];
    const bool map_wanted = map.size() == round, lookup_wanted = lookup.size() == round;
    if (!map_wanted && !lookup_wanted) continue;
    const PassTimes times = sample(points[i], map_wanted, lookup_wanted);
    if (map_wanted) map.push_back(*times.map_ms);
    if (lookup_wanted) lookup.push_back(*times.lookup_ms);
    if (lookup_wanted && times.prefilter_ms) filters[work[i].lookup].push_back(*times.prefilter_ms);
  }
}

void add(TimeMetrics& metrics, const std::string& name, const std::vector<double>& samples) {
  const MedianInterval time = interval_of_median(samples);
  const auto [low, high] = interval_names(name);
  metrics.insert({{low, time.low}, {name, time.middle}, {high, time.high}});
}

// Points with one picture are timed together.
std::string picture_key_of(const Settings& point) { return settings_key(point, {Stage::scene, Stage::view}); }

}  // namespace

int time_rounds(std::span<const Settings> points) {
  std::set<std::string> pictures;
  for (const Settings& point : points) pictures.insert(picture_key_of(point));
  return timed_rounds * static_cast<int>(pictures.size());
}

std::optional<std::vector<TimeMetrics>> time_passes(const SamplePasses& sample, std::span<const Settings> points,
                                                    const std::function<bool(int done, int all)>& go_on) {
  std::map<std::string, std::vector<size_t>> pictures;
  std::vector<Work> work;
  for (size_t i = 0; i < points.size(); ++i) {
    pictures[picture_key_of(points[i])].push_back(i);
    work.push_back({map_key_of(points[i]), lookup_work_of(points[i])});
  }
  std::vector<TimeMetrics> all(points.size());
  const int rounds = time_rounds(points);
  int done = 0;
  for (const auto& [key, picture] : pictures) {
    Samples maps, filters, lookups;
    for (int round = 0; round < timed_rounds; ++round, ++done) {
      if (!go_on(done, rounds)) return std::nullopt;
      sample_round(sample, points, picture, work, static_cast<size_t>(round), maps, filters, lookups);
    }
    for (const size_t i : picture) {
      const std::vector<double>&map = maps[work[i].map], &lookup = lookups[work[i].lookup];
      std::vector<double> sum(map.size());
      std::transform(map.begin(), map.end(), lookup.begin(), sum.begin(), std::plus<>());
      if (const auto filter = filters.find(work[i].lookup); filter != filters.end()) {
        std::transform(sum.begin(), sum.end(), filter->second.begin(), sum.begin(), std::plus<>());
        add(all[i], "prefilter_ms", filter->second);
      }
      add(all[i], "map_ms", map);
      add(all[i], "lookup_ms", lookup);
      add(all[i], "shadow_ms", sum);
    }
  }
  return all;
}

std::optional<std::vector<TimeMetrics>> time_passes(Workbench& bench, std::span<const Settings> points,
                                                    const std::function<bool(int done, int all)>& go_on) {
  return time_passes(
      [&](const Settings& point, bool map, bool lookup) { return bench.time_passes(point, map, lookup); }, points,
      go_on);
}

TimeMetrics time_passes(Workbench& bench, const Settings& point) {
  return time_passes(bench, {&point, 1}, [](int, int) { return true; })->front();
}

}  // namespace noonmark
