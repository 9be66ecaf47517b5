// The dry run: what a run would do, and how long it would take.
#pragma once
#include "app/experiment.h"

namespace noonmark {

// Prints every point with its memory, and an estimate of the time. Writes nothing. Throws Error(usage) for a point that
// does not fit into memory.
void print_plan(const Experiment& experiment);

}  // namespace noonmark
