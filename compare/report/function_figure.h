// The report's first figure: a small chart of error over bias for each resolution and extent (function_grid.h). It is drawn here as
// SVG, once for wide and once for narrow screens. page/function.js switches, highlights and opens; it draws and formats nothing.
#pragma once
#include "compare/report/element.h"
#include "compare/report/shown.h"

namespace noonmark::report {

// Empty if the points do not know their causes. Each chart is a box of 1000 x 1000: its height goes with the square root of the
// share, so that small shares show; its width with the logarithm of the bias, behind a bar for the bias 0.
bool has_function_chart(const ShownPoints& shown);
Markup function_chart(const ShownPoints& shown);

}  // namespace noonmark::report
