// The sections below the charts: pictures, points, the meaning of the numbers, how the results were made.
#pragma once
#include <functional>
#include <string>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// read_file: as for render_report().
Markup pictures_section(const ShownPoints& shown, const std::function<std::string(const std::string&)>& read_file);
// One picture with its caption, or why it is not shown.
Markup picture_figure(const PictureRecord& record, const std::function<std::string(const std::string&)>& read_file);
Markup points_section(const ShownPoints& shown);
Markup meaning_section(const Results& results);
Markup making_section(const Results& results);

}  // namespace noonmark::report
