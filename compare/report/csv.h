// results.csv: one row per point, for spreadsheets and data frames.
#pragma once
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// The format is RFC 4180: a heading, then one row per point in order of id. Lines end with CRLF. Fields with a comma, a
// quote or a line break are quoted. The columns have the order of their tables: `point`, every setting, every metric
// that is not a time, the quantities of the bias curve (compare/results/quantities.h), the worst pixel, the metrics that are
// times, and the kind of machine at the end. All columns before the first time are deterministic: two runs of one
// experiment on one machine give the same bytes, all of them if no times are measured. When, where and how long the
// program worked stands in the store alone. Numbers are the shortest decimals that read back as the same double, or `nan`, `inf` and `-inf`. An empty
// field means that the point has no such number (no curve, no usable bias). A text that a spreadsheet would treat as a
// formula gets an apostrophe before it (compare/report/escape.h).
std::string to_csv(const Results& results);

}  // namespace noonmark
