#include "compare/judge/last_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "compare/judge/bounds.h"
#include "compare/judge/undecided.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

// The samples' interval of a time (compare/results/metrics.h: the rows "..._low_ms" and "..._high_ms").
std::optional<std::pair<double, double>> noise_of(const BoundResult& bound, const Results& results) {
  constexpr std::string_view ending = "_ms";
  const PointRecord* const point = find_point(results.points, bound.point);
  if (!point || !bound.metric.ends_with(ending)) return std::nullopt;
  const std::string stem = bound.metric.substr(0, bound.metric.size() - ending.size());
  const std::optional<double> low = quantity(*point, stem + "_low_ms"), high = quantity(*point, stem + "_high_ms");
  if (!low || !high) return std::nullopt;
  return std::pair(*low, *high);
}

// Nothing is as before where the ambiguous receivers, which are left out, may have changed it.
bool is_as_before(const BoundResult& bound, const Results& results) {
  if (std::isnan(*bound.before) && std::isnan(bound.found)) return true;
  return *bound.before == bound.found && room_of(bound, results.points) == 0;
}

std::string value_text(const BoundResult& bound, double value, double other, double room = 0) {
  return std::isfinite(value) ? text_with_room(value, room, bound_unit(bound), digits_to_tell(value, other))
                              : std::string(not_measured);
}

}  // namespace

void add_last_run(std::vector<BoundResult>& bounds, const std::vector<BoundResult>& earlier) {
  for (BoundResult& bound : bounds) {
    const auto same = std::find_if(earlier.begin(), earlier.end(), [&](const BoundResult& one) {
      return one.part == bound.part && one.metric == bound.metric && one.where == bound.where &&
             one.join == bound.join && one.placement == bound.placement && one.max.has_value() == bound.max.has_value();
    });
    if (same != earlier.end() && same->points > 0) bound.before = same->found;
  }
}

bool is_noise(const BoundResult& bound, const Results& results) {
  const auto noise = noise_of(bound, results);
  return noise && bound.before && *bound.before >= noise->first && *bound.before <= noise->second;
}

std::string since_last_run(const BoundResult& bound, const Results& results) {
  if (!bound.before) return "";
  if (is_as_before(bound, results)) return "as before";
  std::string text = fmt::format("{} before", value_text(bound, *bound.before, bound.found));
  if (const auto noise = noise_of(bound, results))
    text += fmt::format(", {} the noise ({:.3g} to {:.3g} ms)", is_noise(bound, results) ? "within" : "beyond",
                        noise->first, noise->second);
  return text;
}

std::string last_run_text(const Results& results) {
  std::vector<std::string> changed;
  size_t as_before = 0;
  for (const BoundResult& bound : results.bounds) {
    if (!bound.before) continue;
    if (is_as_before(bound, results) || is_noise(bound, results)) {
      ++as_before;
      continue;
    }
    changed.push_back(fmt::format("{}{}{} {} -> {}", bound.part, bound.part.empty() ? "" : ": ", bound.metric,
                                  value_text(bound, *bound.before, bound.found),
                                  value_text(bound, bound.found, *bound.before, room_of(bound, results.points))));
  }
  if (changed.empty() && as_before == 0) return "";
  constexpr size_t most_named = 4;
  const size_t more = changed.size() - std::min(changed.size(), most_named);
  changed.resize(std::min(changed.size(), most_named));
  std::string text = fmt::format("since the last run: {}", fmt::join(changed, ", "));
  if (more > 0) text += fmt::format(", and {} more", more);
  if (as_before > 0) text += fmt::format("{}{} as before", changed.empty() ? "" : "; ", counted(as_before, "value"));
  return text;
}

}  // namespace noonmark
