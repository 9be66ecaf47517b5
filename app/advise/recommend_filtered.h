// Filtered maps in a recommendation (docs/how-to/filtered-maps.md). Nothing is compared, so there is no acne, and what decides is
// lookup.reduction in place of a bias: too small, and shadows leak; too large, and it darkens what is lit.
//
//   for (BiasLevel& level : filtered_levels({"vsm", "msm"})) request.levels.push_back(level);
//
// Light in a shadow, from a leak, a bias or a floor of the variance, is held to the bound on Peter Panning. A lit surface that the lookup's
// own bound or its reduction darkens is held to the bound on acne.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/advise/recommend.h"

namespace noonmark {

// The lookups that can be chosen among, by name: all. Forms of engines are searched over what the engine has fields for
// (app/advise/engine_forms.h).
std::vector<std::string> searched_lookups();

// The levels of lookups that compare no depths, from searched_lookups(), in this order. A lookup that darkens lit slopes (law 17) comes
// without a bias and with one of a standard deviation of the blur. searched: the bounds of the search.
std::vector<BiasLevel> filtered_levels(const std::vector<std::string>& lookups,
                                       const CurveOptions& searched = searched_bounds({}));

// blur_deviation_texels() (technique/lookups.h) with two digits after the point, and no less than it is.
double short_deviation(std::span<const double> weights);

// Of these shares the largest over points and placements.
FilteredShares filtered_shares(const PointRecord& point);
void raise(FilteredShares& most, const FilteredShares& other);

// Which bounds these break, as a clause: "it leaks 0.2%". Empty: none.
std::string why_not_filtered(const FilteredShares& shares, const CurveOptions& bounds);

// The shares of these bounds that a search uses up, as searched_text().
std::string searched_filtered_text();

// A reduction as a user types it: the number of fewest decimals that lies in [low, high] and differs from `value` by at most
// 0.0025 or 2.5%. `value` lies in [low, high]; it is returned itself if nothing shorter does.
double typed_reduction(double value, double low, double high);
// "0 to 0.115": the ends of the window with three decimals, or more in a narrow window. Both are rounded so that they lie inside it.
std::string window_text(const ReductionChoice& choice);

// The settings at n x n places of the grid of texels, the first of them `from` of a step off, each a point that OpenGL renders.
std::vector<Settings> placed_on_grid(const Settings& settings, int n, double from);

// Of a point that is measured with a curve of these bounds and no reduction: what no reduction can mend, or that none keeps both
// bounds. Of a form of an engine: what it breaks as it is. Empty: nothing.
std::string why_no_reduction(const PointRecord& point, const CurveOptions& searched);

// Chooses the reduction for the points, one for each condition, which are measured with a curve of the bounds of the search and no
// reduction, and measures what it gives there: fills Tried::reduction, error and worst, or why_not and worst. With placements
// the window is that of all of them, and the error the largest. Throws Error.
// Of a form of an engine there is nothing to choose: fills Tried::as_is, error and worst, or why_not and worst.
void judge_filtered(Workbench& bench, Tried& tried, const std::vector<PointRecord>& points,
                    const CurveOptions& searched, const std::string& accuracy);

}  // namespace noonmark
