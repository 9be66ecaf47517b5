// The report's section on speed against accuracy: what is seen in words, the chart's place, and the Pareto front as a
// table, which needs no JavaScript.
#pragma once
#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Words, chart and table are for RunInfo::cost and error_shown_first() (compare/report/speed.h); in the chart the reader
// chooses others. on_first_screen: the chart stands there (speed_chart()) and not in the section.
Markup speed_section(const ShownPoints& shown, bool on_first_screen);

// Whether some choices can be compared with each other. One alone has no chart.
bool compares_choices(const std::vector<ComparedGroup>& groups);

// True if choices can be compared and at least one has a finite cost and a finite error. Otherwise there is no chart.
bool has_speed_chart(const ShownPoints& shown);
Markup speed_chart();

}  // namespace noonmark::report
