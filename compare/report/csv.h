// results.csv: one row per point, for spreadsheets and data frames.
#pragma once
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// asked: what differs between the points, what every reader asks (the metrics that are Metric::csv, the usable window), and
// what the bounds, the laws' formulas, the plot and the answer name; of these, what no point has is left out unless it is named. all: every column.
enum class CsvColumns { asked, all };

// The format is RFC 4180: a heading, then one row per point in order of id. Lines end with CRLF. Fields with a comma, a
// quote or a line break are quoted. The columns have the order of their tables: `point`, every setting, every metric
// that is not a time, the quantities of the bias curve (compare/results/quantities.h), the worst pixel, the metrics that are
// times, and the kind of machine at the end. All columns before the first time are deterministic: two runs of one
// experiment on one machine give the same bytes, all of them if no times are measured. When, where and how long the
// program worked stands in the store alone. Numbers are the shortest decimals that read back as the same double, or `nan`, `inf` and `-inf`. An empty
// field means that the point has no such number (no curve, no usable bias). A text that a spreadsheet would treat as a
// formula gets an apostrophe before it (compare/report/escape.h).
std::string to_csv(const Results& results, CsvColumns columns);

}  // namespace noonmark
