#include "app/definition/frame_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/suggestion.h"
#include "compare/ladder/ladder.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"

namespace noonmark {

namespace {

bool is_cause(std::string_view metric) {
  for (int cause = 1; cause < compared_cause_count; ++cause)
    if (metric == cause_name(static_cast<Cause>(cause))) return true;
  return false;
}

}  // namespace

bool needs_own_map(std::string_view metric) {
  return is_cause(metric) || is_cause_of_own_map(metric) || metric == frame_lookup_differs;
}

void require_frame_metric(std::string_view metric) {
  std::vector<std::string_view> names = {"receivers", "facing", "counted", "ambiguous"};
  for (const Metric& row : metrics_table())
    if (row.is(Metric::frames)) names.push_back(row.name);
  for (int cause = 1; cause < compared_cause_count; ++cause) names.push_back(cause_name(static_cast<Cause>(cause)));
  if (std::find(names.begin(), names.end(), metric) != names.end()) return;
  find_metric(metric);  // an unknown name has its own message
  const std::string of_frame = fmt::format("frame_{}", metric);
  const bool has_twin = std::find(names.begin(), names.end(), of_frame) != names.end();
  throw Error(ErrorKind::usage,
              fmt::format("a frame of another renderer has no metric '{}'{}", metric,
                          has_twin ? fmt::format("; its own is '{}'", of_frame) : did_you_mean(metric, names)));
}

}  // namespace noonmark
