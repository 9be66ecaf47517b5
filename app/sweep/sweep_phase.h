// The phase diagrams of a sweep: one for each part of the experiment that asks for it ([phase]).
//
//   for (const PhasePlan& plan : phase_plans(experiment, points(experiment)))
//     store.add_phase(plan.number, make_phase(bench, plan));
//
// A part can have points of many techniques. The diagram is that of its first point that can have one; points whose
// settings differ from it in more than texel size and bias are not on it, and the diagram names these settings.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "measure/workbench.h"

namespace noonmark {

struct PhasePlan : CauseBounds {
  int64_t number = 0;  // of the part, from 0; its number in the store
  std::string part;    // its name
  PhaseRequest request;
  int64_t first = 0;  // the id of the part's first point
  std::vector<Settings> points;
  std::string scene;  // the digest of the first point's scene: a diagram of other contents is not used again

  std::string name() const;  // "the phase diagram of part 'x'"
  // The beginning of PhaseDiagram::made_from: options, bounds and points. A stored diagram that begins otherwise is made
  // anew, or judged anew if its measurement is the same.
  std::string made_from() const;
};

// The digests of the scenes are left empty.
std::vector<PhasePlan> phase_plans(const Experiment& experiment, std::span<const Settings> points);

// Throws Error(usage) if it does not fit into the memory that is free.
void require_room_for(Workbench& bench, const PhasePlan& plan);

// If the part can have no diagram, the result says why (PhaseDiagram::refused). earlier: diagrams of the same
// program; one with the same texel sizes of the same technique is not measured again, only its bounds and points are new.
// Throws Error.
PhaseDiagram make_phase(
    Workbench& bench, const PhasePlan& plan, const std::vector<PhaseDiagram>& earlier = {},
    const RowDone& row_done = [](int) {});

}  // namespace noonmark
