// Why a point with a motion has no flicker: none of its points of the world is seen, and has one truth, in both frames.
// Then every metric of flicker but the counts is missing ("not measured").
#pragma once
#include <span>
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// "flicker is not measured: of 17931 points that can be judged, ...", with the reason and what to do, without a full
// stop. Empty if flicker is measured, and for a point without a motion. A picture without a point that can be judged is
// poor (compare/judge/poor_view.h), which says why.
std::string why_no_flicker(const PointRecord& point);

// The same for several points: how many have none, and the text of the first. Empty if there is none.
std::string no_flicker_note(std::span<const PointRecord> points);

}  // namespace noonmark
