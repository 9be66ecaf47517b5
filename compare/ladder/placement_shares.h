// What is measured at each placement of the map's grid (technique/placements.h), and metrics over all of them.
//
//   const PlacementShares shares = counts.shares();
//   std::map<std::string, double> metrics = placement_metrics(shares, stage.facts(worst_placement(shares)));
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "technique/placements.h"

namespace noonmark {

// At the point's own bias, by the name of the metric (error, acne, ...): a fraction for each placement. NaN without a receiver.
using PlacementShares = std::map<std::string, std::vector<double>>;

// The placement with the largest error; the first of several.
int worst_placement(const PlacementShares& shares);

// Mean, worst and best over the placements, and which placement has the largest error (KindOfLight::placement_facts).
// Names: "acne_mean", "acne_worst", "acne_best", "worst_shift_u_texels".
std::map<std::string, double> placement_metrics(const PlacementShares& shares, std::span<const PlacementFact> worst);

}  // namespace noonmark
