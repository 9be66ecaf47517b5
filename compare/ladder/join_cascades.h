// Numbers of a point with several cascades that come from those of each cascade. All other numbers come from the joined
// ladder (join(), compare/ladder/ladder.h).
//
//   metrics.merge(join_laws(record.cascades, technique.moments.has_value()));
#pragma once
#include <map>
#include <span>
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// The metrics of measure_laws(), as law_metrics says. read_moments: LawInput::reads_moments. Throws std::out_of_range if a cascade
// lacks one of them.
std::map<std::string, double> join_laws(std::span<const PointRecord::Cascade> cascades, bool read_moments);

// What was checked of each map (of_one: what of one of them): contract is the share of all facing receivers, the others are the
// largest of the cascades that have some. NaN if none has.
std::map<std::string, double> join_soundness(std::span<const PointRecord::Cascade> cascades,
                                             const std::map<std::string, double>& of_one);

// The metrics of placement_metrics(), which the cascades have too: means over all counted receivers of what each cascade has
// at its own worst, mean and best. The grids of cascades lie independently of each other, so each is a real placement of
// the whole map. Which placement it is has no name here. receivers: the sum of the shares that each cascade has in the
// results of its receivers (PlacementStage::receivers). Where cascades share receivers, wrong_* and aliasing_rms_* are left
// out: a pixel that two maps have a part in has no sum over them.
std::map<std::string, double> join_placements(std::span<const PointRecord::Cascade> cascades,
                                              std::span<const double> receivers, bool shared);

// Removes all metrics of each cascade that a record does not keep. It keeps those of cascade_metrics.
void keep_cascade_metrics(std::span<PointRecord::Cascade> cascades);

}  // namespace noonmark
