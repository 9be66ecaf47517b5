// The numbers of a phase diagram: texel size against bias, both in metres. For every pair it says how large the error
// is, which cause it has, and whether the pair is usable: acne and Peter Panning both within their bounds, at every
// placement of the texel grid. measure/phase_diagram.h measures it, compare/report/phase.h shows it.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/interval.h"
#include "compare/results/cause_bounds.h"

namespace noonmark {

struct PhaseRow {
  int resolution = 0;  // texels on a side, at the present extent
  double texel_m = 0;  // of the median counted receiver under a spot light
  // One value for each bias: fractions of the counted receivers. Causes are means over the placements; for `error`, acne
  // and Peter Panning also the largest over the placements.
  std::vector<double> error, acne, peter_panning, aliasing, coverage, filter, undecided;
  std::vector<double> error_worst, acne_worst, peter_panning_worst;
  double last_acne_m = 0;  // the least bias without acne at any placement; infinity: none is enough
};

// The lists of a row, by name. The store's columns, the page's data and phase.csv are made from these.
struct PhaseSeries {
  std::string_view name;
  std::vector<double> PhaseRow::*values;
};
std::span<const PhaseSeries> phase_series();

// A point of the sweep: its place on the diagram, or why it has none.
struct PhasePoint {
  int64_t point = 0;
  double texel_m = 0, bias_m = 0;  // bias_m: of the constant part alone
  std::string left_out;            // "filter.kind = box": the settings that are not those of the diagram
};

struct PhaseDiagram : CauseBounds {
  std::string part;       // the experiment's part; empty if it has no parts, and on a page of its own
  std::string refused;    // why this part can have no diagram, as a sentence; then there are no rows
  std::string made_from;  // what decides the numbers beside the points' settings, one "name = value" a line
  std::string scene, light, technique;  // names for the reader; technique: the settings other than texel size and bias
  std::string command;                  // that made it, on a page of its own
  std::string render;               // "noonmark render --set ...": the same point, to which resolution and bias come
  std::string version, notes;       // on a page of its own
  int width_px = 0, height_px = 0;  // of the picture whose receivers it counts
  int placements = 1;               // S
  double receivers = 0;             // counted, of the first row
  double range_m = 0;               // near to far: no bias is larger
  double metres_per_bias = 1;       // of one unit of bias.constant as `render` sets it
  std::vector<double> bias_m;       // ascending
  std::vector<PhaseRow> rows;       // from the coarsest texel to the finest
  // Law 1: the bias, as a multiple of the texel, that leaves a lit plane's acne at the bound in the mean over all
  // placements; and that no lit receiver's plane needs more than. NaN where the technique has no such law.
  double law_at_bound = 0, law_steepest = 0;
  std::vector<PhasePoint> points;  // of the sweep, ascending; empty on a page of its own

  // At every placement, and in the mean over the placements.
  // Biases in metres; empty if none is.
  Interval usable(const PhaseRow& row) const;
  Interval usable_on_average(const PhaseRow& row) const;
  // The row whose texel is nearest, by the logarithm. There must be rows.
  const PhaseRow& nearest_row(double texel_m) const;
};

}  // namespace noonmark
