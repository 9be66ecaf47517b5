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

// A table with a row for each part, and for each group in it that can be compared: the cheapest choice that is good enough, its
// free setting with the usable window, its cost and its error; or why none is, and what may help. Empty without parts, in a
// report of laws, of frames or of an unfinished sweep, and if no point has a curve.
Markup part_answers(const Results& results, const ShownPoints& shown);

}  // namespace noonmark::report
