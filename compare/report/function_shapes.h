// The shapes of the small charts of the report's first figure (function_figure.h), each in a box of 1000 x 1000, and the axes that
// all of them share.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "compare/report/element.h"
#include "compare/report/function_grid.h"

namespace noonmark::report {

struct FunctionScale {
  static constexpr double box = 1000;
  static constexpr double zero_end = 45, log_begin = 70;  // the bar of the bias 0 ends, the logarithmic axis begins

  double low = 0, high = 0;  // biases in metres; both 0 where no chart has a curve
  double top = 0;            // the share at the upper end

  // Across, by the logarithm of the bias in metres. A bias beyond an end stands on it.
  double x(double bias) const {
    if (!(bias > 0)) return zero_end / 2;
    const double part = (std::log(bias) - std::log(low)) / (std::log(high) - std::log(low));
    return std::clamp(log_begin + (box - log_begin) * part, log_begin, box);
  }
  // Down, by the square root of the share. One that is no number is at the ground.
  double y(double share) const { return share > 0 ? box * (1 - std::sqrt(std::min(share / top, 1.0))) : box; }
};
FunctionScale function_scale(const FunctionFigure& figure);

// Indices of the curve's entries that are drawn: those on the axis, and one beyond each end.
std::vector<size_t> drawn_entries(const FunctionCell& cell, const FunctionScale& scale);

// A chart without its axes: the usable window, the stack as one path for each cause (data-cause), the error, the bounds, the biases
// as set. Of a cell without a curve: a bar for each point. The cell must have points.
Markup function_shapes(const FunctionCell& cell, const FunctionFigure& figure, const FunctionScale& scale);

// What SVG elements of the figure are made with. Colours are the page's variables, without "--".
Attribute at(Name name, double value);
Attribute fill(const std::string& color);
Attribute stroke(const std::string& color);
// None where the value is the usual one: a figure has thousands.
Attribute unless(bool usual, Name name, const std::string& value);
// Its width is that on the screen, however the chart is stretched.
Markup line_in_box(double x1, double y1, double x2, double y2, const std::string& color, const char* dashes,
                   double width = 1);

template <class Use>
void each_cell(const FunctionFigure& figure, const Use& use) {
  for (const FunctionGrid& grid : figure.grids)
    for (const FunctionCell& cell : grid.cells)
      if (!cell.points.empty()) use(cell);
}

}  // namespace noonmark::report
