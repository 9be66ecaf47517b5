// The report's live picture: what OpenGL shows at every bias, with a slider. It reads the file that a point with
// pictures has (compare/ladder/live_picture.h), and page/live.js draws it.
#pragma once
#include <functional>
#include <string>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Whether a point has such a file; the report has the figure only then.
bool has_live_picture(const Results& results);

// Of the point with which the page opens (compare/report/opening.h). read_file: as in render_report. If the file cannot be
// read, a line says why, and how to get one.
Markup live_figure(const ShownPoints& shown, const std::function<std::string(const std::string& path)>& read_file);

}  // namespace noonmark::report
