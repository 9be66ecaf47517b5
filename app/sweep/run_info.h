// What is recorded of a run beside its points: the experiment, the program and the machine.
#pragma once
#include <string>

#include "app/definition/experiment.h"
#include "app/sweep/sweep.h"
#include "compare/results/records.h"
#include "measure/workbench.h"
#include "raytrace/tracer.h"

namespace noonmark {

// Without what the scene and its notes say. folder: of the results. Throws Error(usage) if a share's experiment can be said by
// no file (app/definition/definition.h).
RunInfo run_info(const Experiment& experiment, const std::string& folder, const SweepOptions& options,
                 const gl::DeviceInfo& device, const raytrace::TracerInfo& tracer);

}  // namespace noonmark
