// The laws in the report: a table, and the data of its chart.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/store/records.h"

namespace noonmark::report {

// With the place of the chart of measured against predicted; empty without laws.
std::string laws_table(const Results& results);

// Of the laws whose samples can be drawn.
nlohmann::json law_data(const Results& results);

}  // namespace noonmark::report
