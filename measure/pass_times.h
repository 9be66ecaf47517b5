// The times of map and lookup of points, so that they can be compared.
//
//   for (const auto& [name, value] : time_passes(bench, settings)) record.metrics[name] = value;
//
// - A sample is the time of one pass on a warm device (Renderer::render_map). Its clock: gl::DeviceInfo::times.
// - Points of one picture (scene and view) take turns: nine rounds over all of them. So a slow minute of the machine meets
//   all that can be compared, and not one of them.
// - Points that ask the same of the machine share their samples (measure/stage_keys.h), so they have one cost.
// - Of the nine samples the median and its interval are kept (compare/judge/interval.h).
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/workbench.h"

namespace noonmark {

inline constexpr int timed_rounds = 9;

// One sample of each pass that is asked for: Workbench::time_passes().
using SamplePasses = std::function<PassTimes(const Settings& point, bool map, bool lookup)>;

// For each point its metrics that are times, by name. go_on(done, all): called before each round, with the number of rounds
// that are finished; if it returns false, the result is empty. Throws what the sampling throws.
using TimeMetrics = std::map<std::string, double>;
std::optional<std::vector<TimeMetrics>> time_passes(const SamplePasses& sample, std::span<const Settings> points,
                                                    const std::function<bool(int done, int all)>& go_on);
std::optional<std::vector<TimeMetrics>> time_passes(Workbench& bench, std::span<const Settings> points,
                                                    const std::function<bool(int done, int all)>& go_on);

// How many rounds these points need.
int time_rounds(std::span<const Settings> points);

// Of one point.
TimeMetrics time_passes(Workbench& bench, const Settings& point);

}  // namespace noonmark
