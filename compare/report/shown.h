// The points that the report shows one by one. Each point takes 4 to 9 kB of the page, for its row, bar, symbols and
// curve, and a browser on two cores needs 1.5 to 2 s for 1000 of them. So charts and tables of a large sweep show a choice
// of its points, and say so.
//
//   const ShownPoints shown = shown_points(results);
//   for (const PointRecord& point : shown.results.points) use(point);  // rows, bars, symbols
//   page += shown.note;                                        // empty if every point is shown
#pragma once
#include <string>
#include <vector>

#include "compare/judge/findings.h"
#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Sweeps of up to this many points are shown whole: 4 MB, 9 MB with bias curves.
inline constexpr size_t most_whole_points = 1000;
// Of larger sweeps, at most this many evenly chosen points are shown, because more lines and symbols hide each other, and
// a browser on two cores needs a second for them. Also the most samples of a law that its chart draws of many.
inline constexpr size_t max_even_points = 500;
// Points that are shown although they are not among the evenly chosen ones (see shown_points): at most this many.
inline constexpr size_t max_marked_points = 150;

// What was found in all points, and the points that are shown.
struct ShownPoints : Findings {
  explicit ShownPoints(const Results& of) : Findings(of) {}
  Results results;                         // the same results with the shown points only, in the same order
  Markup note;                             // how many of how many, how they were chosen, and where all points are
  std::vector<std::string> costs, errors;  // costs_of(), errors_of() (compare/report/speed.h)
  std::string error_first;                 // error_shown_first()
};

// A large sweep is thinned to a smaller grid: of the settings with the most values, some values are kept, evenly spaced
// and with both ends. So the lines of a chart keep all their points. Points that the page speaks of (the recommended
// ones, the worst one, those of bounds and laws, the Pareto front, the first ones with pictures) are shown as well. If
// the points are no grid (parts, an interrupted sweep), every n-th point is shown.
ShownPoints shown_points(const Results& results);

}  // namespace noonmark::report
