// The laws in the report: a table, and the data of its chart.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The table of laws, with the place of the chart of measured against predicted. Empty without laws.
Markup laws_table(const Results& results);

// The data of the laws whose samples can be drawn.
nlohmann::json law_data(const Results& results);

}  // namespace noonmark::report
