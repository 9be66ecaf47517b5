// What to set in each part of a report of several parts.
#pragma once
#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

bool has_parts(const Results& results);

// The choice that the head of a report of parts names: of the largest group that can be compared the cheapest that is good
// enough. Null if it has no usable window, because a bound of a part alone can also demand an error; if the group has one choice;
// and of an unfinished sweep.
const ComparedChoice* answer_of_parts(const Results& results, const std::vector<ComparedGroup>& groups);

// The table "What to set in each part". It has a row for each part, and for each group of choices in a part that can be compared.
// A row names the cheapest choice that is good enough, with its free setting, usable window, cost and error. If no choice is good
// enough, the row says why and what may help.
// Empty if the report has no parts or no curve, or if it is one of laws, of frames or of an unfinished sweep.
Markup part_answers(const ShownPoints& shown);

}  // namespace noonmark::report
