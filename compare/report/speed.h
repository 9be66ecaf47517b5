// Speed against accuracy: what the chart of cost against error, its table and its sentences are made from.
//
//   for (size_t i : front_of(group, "traffic_bytes", "error")) print(names.of(group.choices[i].choice));
#pragma once
#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <unordered_set>
#include <vector>

#include "compare/judge/tradeoff.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The costs and the errors that can be an axis, in the order in which they are offered.
inline constexpr std::array cost_metrics{"texel_work",    "traffic_bytes",  "map_bytes",     "map_texels",
                                         "map_triangles", "lookup_fetches", "lookup_texels", "lookup_operations",
                                         "map_ms",        "lookup_ms",      "shadow_ms"};
inline constexpr std::array error_metrics{
    "error_soft",  "error",        "flip",       "edge_displacement_mean_pixels", "edge_displacement_p95_pixels",
    "wrong_patch", "aliasing_rms", "shaded_rmse"};

// The metrics that the reader can choose for an axis: RunInfo::cost and the other costs; RunInfo::accuracy and the other errors;
// of the others first those that the experiment asks to plot. Only those that are finite at some point.
std::vector<std::string> costs_of(const Results& results);
std::vector<std::string> errors_of(const Results& results);
// RunInfo::accuracy. "error" if that was not measured, and in place of "error_soft" if no light has a size, because both
// are equal then.
std::string error_shown_first(const Results& results);

// The error at which a choice stands: the largest over the conditions, at the bias. NaN if it does not count (counts_by).
double error_in_plane(const ComparedChoice& one, const std::string& error, AtBias at);

// Indices of the choices on the Pareto front, from the cheapest to the most accurate: those that count and are on
// pareto_front() (cause_shares.h). The cost is the largest over the conditions too.
std::vector<size_t> front_of(const ComparedGroup& group, const std::string& cost, const std::string& error,
                             AtBias at = AtBias::best);

// The group with the most choices, which the page shows first. There must be a group.
size_t group_shown_first(const std::vector<ComparedGroup>& groups);

// Names groups by the settings that differ between them: "scene cube-room, light spot". Empty if there is one group.
class GroupNames {
 public:
  GroupNames(const Results& results, const std::vector<ComparedGroup>& groups);
  std::string of(const ComparedGroup& group) const;

 private:
  std::vector<std::string> differing_;
};

// Names choices by their part and by the swept settings that differ within it: "filters, filter box". Settings that name the
// group (GroupNames) are left out.
class ChoiceNames {
 public:
  explicit ChoiceNames(const Results& results);
  // best: without the setting that the curves of the choice vary, because its own bias is said beside the name.
  std::string of(const Choice& choice, AtBias at = AtBias::as_set) const;
  // The technique of the choice: without what it is tuned by (tuned_settings) and without the setting along the curve
  // (Techniques::scale).
  std::string technique(const Choice& choice, const std::string& scale) const;

 private:
  std::string named(const Choice& choice, std::vector<std::string> settings) const;
  std::map<std::string, std::vector<std::string>> differing_;  // by part
};

// The point that stands for a choice on the page: the condition that is worst by `error`, or another one, because only
// shown points have a row. Null if none is shown.
const PointRecord* point_on_page(const ComparedChoice& one, const std::string& error,
                                 const std::unordered_set<int64_t>& shown_ids);

// For page/chart_speed.js: the metrics of both axes, and each group with its choices that are shown. A value that is not
// finite is null.
nlohmann::json speed_data(const ShownPoints& shown);

}  // namespace noonmark::report
