// results.csv: one row per point, for spreadsheets and data frames.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark {

// RFC 4180: a heading, then one row per point in order of id; CRLF, fields with a comma, a quote or a line break in
// quotes. Columns, in the order of their tables: `point`, every setting, every metric that is no time, the quantities
// of the bias curve (compare/store/quantities.h), the worst pixel; then, at the end, the times. All columns before the
// first time are deterministic: two runs of one experiment on one machine agree in them byte for byte. Numbers are the
// shortest decimals that read back as the same double; `nan`, `inf` and `-inf` say so; an empty field means that the
// point has no such number (no curve, no usable bias). A text that a spreadsheet would take for a formula has an
// apostrophe before it (compare/report/escape.h).
std::string to_csv(const Results& results);

}  // namespace noonmark
