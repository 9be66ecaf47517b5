// The phase diagram of a scene: texel size against bias, both in metres. For every pair it says how large the error is,
// which cause it has, and whether the pair is usable: acne and Peter Panning both within their bounds, at every
// placement of the texel grid.
//
//   write(dir + "/phase.html", render_phase(diagram));
#pragma once
#include <string>
#include <vector>

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

// An interval of biases in metres; empty if from > to.
struct BiasInterval {
  double from = 0, to = -1;
  bool empty() const { return !(from <= to); }
};

struct PhaseDiagram {
  std::string scene, light, technique;  // names for the reader; technique: the settings other than texel size and bias
  std::string command;                  // that made it
  std::string render;  // "noonmark render --set ...": the same point, to which resolution and bias come
  std::string version, notes;
  int placements = 1;    // S
  double receivers = 0;  // counted, of the first row
  double acne_bound = 0, peter_panning_bound = 0;
  double range_m = 0;          // near to far: no bias is larger
  double metres_per_bias = 1;  // of one unit of bias.constant as `render` sets it
  std::vector<double> bias_m;  // ascending
  std::vector<PhaseRow> rows;  // from the coarsest texel to the finest
  // Law 1: the bias, as a multiple of the texel, that leaves a lit plane's acne at the bound in the mean over all
  // placements; and that no lit receiver's plane needs more than. NaN where the technique has no such law.
  double law_at_bound = 0, law_steepest = 0;

  // At every placement, and in the mean over the placements.
  BiasInterval usable(const PhaseRow& row) const;
  BiasInterval usable_on_average(const PhaseRow& row) const;
};

// "Usable from 0.053 m to 0.51 m at 1024 texels ...": what the diagram shows, as sentences.
std::vector<std::string> phase_words(const PhaseDiagram& diagram);

// A page of its own, which needs no other file.
std::string render_phase(const PhaseDiagram& diagram);
// One line for each texel size and bias, with every number of the diagram.
std::string phase_csv(const PhaseDiagram& diagram);

}  // namespace noonmark
