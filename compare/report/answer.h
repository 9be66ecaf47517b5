// The report's first section: the verdict, what breaks, what to set, bounds and laws.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark::report {

std::string answer_section(const Results& results);

}  // namespace noonmark::report
