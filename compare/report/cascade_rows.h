// The table of a point's cascades, for the terminal and the report. And one sentence: which cascade has most of the error, and
// why.
//
//   for (const CascadeRow& row : cascade_rows_of(point)) print(row.begin_m, row.end_m, row.error);
//   print(worst_cascade(point));   // "Cascade 4 (28 to 80 m, texel 0.37 m) holds 83% of the error; its largest cause: ..."
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

struct CascadeRow {
  int number = 1;  // from 1, the nearest
  // Depths along the view: of the slice, or where cascades are not chosen by it (cascades_by_depth()), of the nearest and the
  // farthest counted receiver, which are not finite without one.
  double begin_m = 0, end_m = 0;
  double texel_m = 0;
  double receivers = 0;         // that are counted
  std::optional<double> error;  // mean |R5 - R1| over its own receivers, a fraction; empty without any
  std::optional<double> share;  // of the whole picture's error, a fraction; empty if the picture has none
  std::string_view cause;       // the largest one's label; empty if nothing is wrong
  std::optional<double> seam;   // seam_jump to the next cascade, a fraction; empty if nothing is seen there
  // Of the part of the bias that the curve varies, in the unit of the setting (cascade_bias_unit()): the least amount without
  // acne, empty if none is enough, and the one that is set; both with the cascade's factor of cascades.bias_scales. Both are
  // empty without a curve.
  std::optional<double> needed, set;
  double m_per_unit = 1;  // metres along the light; 1 where the unit is no length
};

// Whether the cascade of a receiver is that of its depth. Otherwise a cascade's slice says what its map is fitted to, and not
// what is looked up in it.
bool cascades_by_depth(const PointRecord& point);

// Empty for a point with one map.
std::vector<CascadeRow> cascade_rows_of(const PointRecord& point);

// The unit of the bias in the rows: "m", "texels", "depth", that of the part, or empty.
std::string cascade_bias_unit(const PointRecord& point);
// Whether that unit has another length in each cascade: texels and depth have.
bool cascade_bias_unit_varies(const PointRecord& point);

// As in a sentence: "28 to 80 m", and "-" without a receiver; "2.22 texels = 0.0539 m", "0", and "-" for an amount that is empty.
std::string cascade_depths_text(const CascadeRow& row);
std::string cascade_bias_text(const PointRecord& point, const CascadeRow& row, const std::optional<double>& amount);

// Empty if the point has one map, or if nothing is wrong.
std::string worst_cascade(const PointRecord& point);

}  // namespace noonmark
