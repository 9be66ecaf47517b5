// Whether settings hold the bounds of a search, and with which bias.
#pragma once
#include <string>
#include <vector>

#include "app/advise/recommend.h"

namespace noonmark {

// The metric that is measured at every placement in place of this one: error_soft of a light without a size is the error. Itself,
// if there is none.
std::string placed_accuracy(Workbench& bench, const Settings& settings, const std::string& accuracy);

// Chooses the bias for the points, one for each condition, and measures the error there: fills Tried::bias, error and worst;
// or why_not, worst and nearest. searched: the bounds of the search. Throws Error.
void judge_bias(Workbench& bench, Tried& tried, std::vector<PointRecord> points, const CurveOptions& searched,
                const std::string& accuracy);

}  // namespace noonmark
