// The report's section on speed against accuracy: what is seen in words, the chart's place, and the Pareto front as a
// table, which needs no JavaScript.
#pragma once
#include <string>

#include "compare/report/shown.h"
#include "compare/store/records.h"

namespace noonmark::report {

// Words, chart and table are for RunInfo::cost and error_shown_first() (compare/report/speed.h); in the chart the reader
// chooses others.
std::string speed_section(const Results& results, const ShownPoints& shown);

}  // namespace noonmark::report
