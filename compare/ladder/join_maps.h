// Numbers of a point with several maps that come from those of each map. All other numbers come from the joined ladder (join(),
// compare/ladder/ladder.h).
//
//   metrics.merge(join_laws(metrics_of_each));
#pragma once
#include <map>
#include <span>
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// Metrics by name, for each map those of its own receivers.
using MetricsOfMaps = std::span<const std::map<std::string, double>>;

// The metrics of measure_laws(), as law_metrics says. Throws std::out_of_range if a map lacks one that another has.
std::map<std::string, double> join_laws(MetricsOfMaps maps);

// What was checked of each map (of_first: what of the first): contract is the share of all facing receivers, the others are the largest
// of the maps that have some. NaN if none has.
std::map<std::string, double> join_soundness(MetricsOfMaps maps, const std::map<std::string, double>& of_first);

// The metrics of placement_metrics(): means over all counted receivers of what each map has at its own worst, mean and best. The grids
// of cascades lie independently of each other, so each is a real placement of the whole. Several maps have no common placement that could be
// named. receivers: the sum of the shares that each map has in the results of its receivers (PlacementStage::receivers). Where
// maps share receivers, wrong_* and aliasing_rms_* are left out: a pixel that two maps have a part in has no sum over them. Of one map
// its own, unchanged.
std::map<std::string, double> join_placements(MetricsOfMaps maps, std::span<const double> receivers, bool shared);

// What a record keeps of a cascade: the metrics of cascade_metrics, NaN where they were not measured.
std::map<std::string, double> kept_of_cascade(const std::map<std::string, double>& metrics);

}  // namespace noonmark
