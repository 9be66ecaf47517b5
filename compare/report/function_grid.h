// What the report's first figure shows: the error, split by cause, as a function of the bias, of the resolution and of the
// extent of the map, and of whatever else was swept.
//
//   const FunctionFigure figure = function_figure(results);
//   for (const FunctionGrid& grid : figure.grids)                 // one for each value of the further settings
//     for (const FunctionCell& cell : grid.cells) print(cell.texel_m, cell.parts.size());
#pragma once
#include <string>
#include <vector>

#include "compare/report/cause_colors.h"
#include "compare/results/records.h"

namespace noonmark::report {

// A grid has at most so many columns and rows, and a figure so many charts in its grids (8 kB of the page each). Of more values some
// are kept, evenly spaced and with both ends; the last grids are left out.
inline constexpr size_t most_in_line = 6, most_charts = 144;

// One small chart. Its points differ in no swept setting but FunctionGrid::inner.
struct FunctionCell {
  std::vector<const PointRecord*> points;  // by ascending values of `inner`
  const BiasCurve* curve = nullptr;        // of the points, which share it; null: the chart has a bar for each point
  double texel_m = 0;                      // NaN if it is not known
  std::vector<double> at;                  // the curve's biases in metres, ascending; of bars: empty
  // For each cause of the figure its share of the counted receivers at each of `at`, or of each point. Filter and displacement
  // do not depend on the bias. Causes after the exact map are in bars alone, because a curve does not split them.
  std::vector<std::vector<double>> parts;
  std::vector<double> error;  // |R5 - R1|
};

struct FunctionGrid {
  std::vector<std::string>
      chosen;                      // the value of each of FunctionFigure::switches; empty: the part has no such setting
  std::string column, row, inner;  // settings; empty: none
  std::vector<std::string> columns, rows;  // their values, at least one each, which is empty without a setting
  std::vector<FunctionCell> cells;         // row by row; without points where an unfinished sweep has none
};

struct FunctionFigure {
  // From the bottom of a stack upward: first those that the experiment asks to plot. Only those that are above 0 somewhere. Light
  // and dark parts of one cause are one.
  std::vector<CauseColor> causes;
  std::vector<std::string> switches;  // settings; "part" where the experiment has parts
  std::vector<FunctionGrid> grids;
  bool thinned = false;  // whether values were left out
};

// Without grids if no point knows its causes, and of frames, which have no setting. The resolution is across and the extent down where they
// were swept, otherwise another setting with short values; without a curve and without a swept bias the first of them is `inner`. The cells refer to the results.
FunctionFigure function_figure(const Results& results);

// The cell with the largest texel that has a usable bias, and its place; null if none has.
const FunctionCell* largest_usable(const FunctionGrid& grid);

}  // namespace noonmark::report
