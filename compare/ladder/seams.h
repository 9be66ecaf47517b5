// The seam between two maps: what would change if a receiver near the end of its map were looked up in the next one.
// It is the step that the picture has at a split without a blend band. A seam moves no single pixel away from its truth, so
// it is no cause; it is split by the causes of the two lookups.
//
//   Seam all;
//   all.add(seam_of(ladder_of_map_1, ladder_of_map_2, mask));
//   record.metrics.merge(seam_metrics(all));
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "base/image.h"
#include "compare/ladder/ladder.h"

namespace noonmark {

// The parts of a seam, as the causes are grouped for people: aliasing and coverage with both their signs.
inline constexpr std::array<std::string_view, 8> seam_parts{"filter",        "displacement", "aliasing",  "acne",
                                                            "peter_panning", "coverage",     "undecided", "precision"};

struct Seam {
  double points = 0;                              // counted receivers
  double jump = 0;                                // sum of |R5 of the next - R5 of this|
  std::array<double, seam_parts.size()> parts{};  // sums of |difference of the steps|
  void add(const Seam& other);
};

// here, next: of one map and of the one after it, both with the receivers of the seam. mask: 1 at these.
Seam seam_of(const Ladder& here, const Ladder& next, const Image<uint8_t>& mask);

// seam_points, seam_jump, and seam_filter to seam_precision: means over the points. NaN without a point.
std::map<std::string, double> seam_metrics(const Seam& seam);

}  // namespace noonmark
