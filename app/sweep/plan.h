// The dry run: what a run would do.
#pragma once
#include <optional>

#include "app/definition/experiment.h"
#include "app/sweep/shares.h"

namespace noonmark {

// Prints every point with its memory. Writes nothing. Throws Error(usage) for a point that
// does not fit into memory. shard: only its points are printed, and then what each share has of the cost.
void print_plan(const Experiment& experiment, const std::optional<Shard>& shard);

}  // namespace noonmark
