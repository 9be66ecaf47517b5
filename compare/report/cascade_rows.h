// The table of a point's cascades as text, for the terminal and the report. And one sentence: which cascade has most of the
// error, and why.
//
//   for (const CascadeRow& row : cascade_rows_of(point)) print(row.depths, row.error);
//   print(worst_cascade(point));   // "Cascade 4 (28 to 80 m, texel 0.37 m) holds 83% of the error; its largest cause: ..."
#pragma once
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

struct CascadeRow {
  int number = 1;        // from 1, the nearest
  std::string depths;    // "28 to 80 m"
  std::string texel;     // "0.37 m"
  double receivers = 0;  // that are counted
  std::string error;     // mean over its own receivers: "1.2%"
  std::string share;     // of the whole picture's error: "83%"; "-" if the picture has none
  std::string cause;     // the largest one's label; empty if nothing is wrong
  // Of the part of the bias that the curve varies, in the unit of the setting: the least amount without acne, and the one
  // that is set. "-" without a curve.
  std::string needed = "-", set = "-";  // "2.22 texels = 0.0539 m"
};

// Empty for a point with one map.
std::vector<CascadeRow> cascade_rows_of(const PointRecord& point);

// Empty if the point has one map, or if nothing is wrong.
std::string worst_cascade(const PointRecord& point);

}  // namespace noonmark
