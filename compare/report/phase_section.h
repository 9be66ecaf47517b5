// The phase diagrams as parts of a page: in the report of a sweep with the sweep's own points on them, and on the page of
// `noonmark map`. compare/report/page/chart_phase.js draws what phase_data() gives into the place in phase_figure().
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The report's section, with the points that are shown one by one; empty if the experiment asks for no diagram.
Markup phase_section(const ShownPoints& shown);

// Whether the report has a diagram, and the place of the first one's chart, which stands at the top of the page.
bool has_diagram(const Results& results);
Markup first_diagram();

// One diagram in words, as the place of its chart and as a table. number: from 0, of the diagrams of a page. points: about the
// points on it. with_chart: without it, only the words and the table.
Markup phase_figure(const PhaseDiagram& diagram, size_t number, const Markup& points = "", bool with_chart = true);
nlohmann::json phase_data(const PhaseDiagram& diagram);

// "12.3 mm", "1.2 m".
std::string metres(double m);

}  // namespace noonmark::report
