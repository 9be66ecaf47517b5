// The sections below the charts: pictures, points, the meaning of the numbers, how the results were made.
#pragma once
#include <functional>
#include <string>

#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// read_file: as for render_report().
std::string pictures_section(const Results& results, const ShownPoints& shown,
                             const std::function<std::string(const std::string&)>& read_file);
// What to type into other engines (RunInfo::engines); empty without.
std::string engines_section(const Results& results);
std::string points_section(const Results& results, const ShownPoints& shown);
std::string meaning_section(const Results& results);
std::string making_section(const Results& results);

}  // namespace noonmark::report
