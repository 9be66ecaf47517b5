// The report's sections of error against a setting. Each is a function from results to HTML: all points for what is counted, and the
// points that are shown one by one.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Each is empty if the results have nothing for it.
// The windows' table.
Markup bias_section(const ShownPoints& shown);
// Of frames: where each one errs, as bars.
Markup places_section(const ShownPoints& shown);

// The figure that charts.js fills. It is hidden without JavaScript; the table below it has the same numbers.
// caption: text.
Markup chart_place(std::string_view name, const std::string& caption);

// Of each swept setting the class of its cells in a table: "text", which is aligned to the left, or none for numbers.
std::map<std::string, std::string> text_classes(const Results& results);

// Words that follow the bias that the reader chose; without JavaScript those of the bias as set.
Markup by_bias(const Markup& as_set, const Markup& recommended);

}  // namespace noonmark::report
