// Measures the phase diagram of a scene (compare/report/phase.h): every texel size at all placements of its own grid,
// and every bias from one set of thresholds. Nothing is rendered but where OpenGL looks up.
#pragma once
#include <functional>

#include "compare/results/phase_record.h"
#include "measure/stages.h"

namespace noonmark {

struct PhaseOptions : CauseBounds {
  int rows = 25;                      // texel sizes, in equal steps of their logarithm
  int coarsest = 128, finest = 8192;  // texels on a side, at the present extent
  int placements = 8;                 // S, along each axis
  int biases_per_octave = 16;
  // Measures from the finest row on, until one has no usable bias: that is the first of the diagram, which has no law.
  bool usable_only = false;
};

// The settings that the diagram is about: those given, with the bias in metres if nothing else of it is set. Throws
// Error(usage) if the diagram has no meaning for them, with what to change.
Settings phase_settings(const Settings& settings, const Scene& scene);

// Called after each texel size, with the number of those that are measured.
using RowDone = std::function<void(int done)>;

// settings: from phase_settings(). The receivers are on the device. The texts of the diagram are left empty
// (describe_phase).
PhaseDiagram measure_phase(gl::Renderer& renderer, const raytrace::Tracer& tracer, const Scene& scene,
                           const ViewStage& view, const TruthStage& truth, const Settings& settings,
                           const PhaseOptions& options, const RowDone& row_done);

// The same diagram at the bounds of `options`, from its rows.
PhaseDiagram rejudged_phase(const PhaseDiagram& measured, const Scene& scene, const ViewStage& view,
                            const TruthStage& truth, const Settings& settings, const PhaseOptions& options);

// Fills in the names for the reader and the command that renders a cell.
void describe_phase(PhaseDiagram& diagram, const Settings& settings, const Scene& scene);

// Where a point lies on a diagram of the same receivers: the width of its texel, and its constant bias along the light,
// both in metres and at the median receiver.
struct PhasePlace {
  double texel_m = 0, bias_m = 0;
};
PhasePlace phase_place(const Scene& scene, const ViewStage& view, const TruthStage& truth, const Settings& settings);

}  // namespace noonmark
