#include "app/sweep/sweep_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "measure/pass_times.h"

namespace noonmark {
namespace {

size_t rows_of(const std::vector<const PhasePlan*>& diagrams) {
  size_t rows = 0;
  for (const PhasePlan* plan : diagrams) rows += static_cast<size_t>(plan->request.texel_sizes);
  return rows;
}

size_t rounds_of(const std::vector<Settings>& planned, const std::vector<int64_t>& ids) {
  std::vector<Settings> timed;
  for (const int64_t id : ids) timed.push_back(planned[static_cast<size_t>(id)]);
  return static_cast<size_t>(time_rounds(timed));
}

}  // namespace

size_t drawn_after_points(const Experiment& experiment, const std::vector<Settings>& planned) {
  // The worst point, the best one, and the answer; or the three answers.
  const size_t most = experiment.pictures == "worst"                                          ? 2
                      : experiment.pictures == "extremes" || experiment.pictures == "answers" ? 3
                                                                                              : 0;
  return std::min(most, planned.size());
}

SweepProgress::Ahead ahead_of(const Experiment& experiment, const std::vector<Settings>& planned,
                              const std::vector<int64_t>& wanted, const ResultStore& store,
                              const std::vector<const PhasePlan*>& undrawn) {
  const std::vector<int64_t> there = store.finished();
  SweepProgress::Ahead ahead;
  ahead.diagrams = undrawn;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(ahead.unmeasured),
               [&](int64_t id) { return !std::binary_search(there.begin(), there.end(), id); });
  if (times_measured(experiment) && (!ahead.unmeasured.empty() || !store.lacking("shadow_ms").empty()))
    ahead.timed = wanted;
  // Of a share such pictures are not drawn.
  if (!ahead.unmeasured.empty() && wanted.size() == planned.size())
    ahead.drawn = drawn_after_points(experiment, planned);
  return ahead;
}

SweepProgress::SweepProgress(const std::vector<Settings>& planned, const Ahead& ahead, bool quiet)
    : shown(quiet),
      rows(shown.add(rows_of(ahead.diagrams))),
      points(shown.add(ahead.unmeasured.size())),
      rounds(shown.add(rounds_of(planned, ahead.timed))),
      pictures(shown.add(ahead.drawn)),
      report(shown.add(1)),
      rows_ahead_(rows_of(ahead.diagrams)) {
  if (!ahead.unmeasured.empty()) shown.set_main(points);
}

RowDone SweepProgress::of_diagram(const PhasePlan& plan) {
  shown.say(plan.name());
  return [this, name = plan.name(), all = plan.request.texel_sizes](int done) {
    shown.finished_small(rows, fmt::format("{}: {} of {} texel sizes", name, done, all));
  };
}

void SweepProgress::diagram_done(const PhasePlan& plan) {
  rows_ahead_ -= static_cast<size_t>(plan.request.texel_sizes);
  shown.set_left(rows, rows_ahead_);
}

void SweepProgress::report_alone() {
  for (const Progress::Work work : {rows, points, rounds, pictures}) shown.set_left(work, 0);
  shown.say("the report");
}

}  // namespace noonmark
