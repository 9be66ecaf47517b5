// Whether settings hold the bounds of a search, and with which bias.
#pragma once
#include <string>
#include <vector>

#include "app/advise/recommend.h"

namespace noonmark {

// The settings with which a point was measured.
Settings settings_of(const PointRecord& point);

// Chooses the bias for the points, one for each condition, and measures the error there: fills Tried::bias, error and worst;
// or why_not, worst and nearest. searched: the bounds of the search. Throws Error.
void judge_bias(Workbench& bench, Tried& tried, std::vector<PointRecord> points, const CurveOptions& searched,
                const std::string& accuracy);

}  // namespace noonmark
