#include "app/sweep/sweep_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "measure/pass_times.h"
#include "measure/point_work.h"

namespace noonmark {
namespace {

// Seconds of processor time on the machine of nominal_cost (two cores with llvmpipe), rounded. They only have to be in
// proportion, because a run replaces them by what it finds.
constexpr double row_s_per_pixel_placement = 0.27e-6;  // a texel size of a diagram
constexpr double times_factor = 4;  // what timing takes, of what nominal_cost (which weighs shares) gives to it
constexpr double picture_s_per_pixel = 4e-6;  // the files of one point
constexpr double picture_s_per_texel = 0.1e-6;
constexpr double report_s = 0.5, report_s_per_point = 0.002;

double pixels_of(const Settings& point) { return static_cast<double>(point.view.width_px) * point.view.height_px; }

double seconds(uint64_t nominal) { return 1e-6 * static_cast<double>(nominal); }

std::optional<CurveOptions> curve_of(const Experiment& experiment, int64_t id) {
  const Experiment& part = part_of_point(experiment, id);
  return part.curve_enabled ? std::optional(part.curve) : std::nullopt;
}

double picture_s(const Settings& point) {
  return picture_s_per_pixel * pixels_of(point) + picture_s_per_texel * point.map.resolution * point.map.rows();
}

// What a point costs more if it is timed.
double timing_s(const Experiment& experiment, const std::vector<Settings>& planned, const std::vector<int64_t>& ids) {
  double sum = 0;
  const Settings* before = nullptr;
  for (const int64_t id : ids) {
    const Settings& point = planned[static_cast<size_t>(id)];
    const std::optional<CurveOptions> curve = curve_of(experiment, id);
    sum += seconds(nominal_cost(point, before, curve, true)) - seconds(nominal_cost(point, before, curve, false));
    before = &point;
  }
  return times_factor * sum;
}

std::vector<double> rows_of(const std::vector<const PhasePlan*>& diagrams) {
  std::vector<double> rows;
  for (const PhasePlan* plan : diagrams) {
    const Settings& point = plan->points.front();
    const double smaller = std::min(1.0, static_cast<double>(plan->request.width_px) / point.view.width_px);
    const double placements = static_cast<double>(plan->request.placements) * plan->request.placements;
    rows.insert(rows.end(), static_cast<size_t>(plan->request.texel_sizes),
                row_s_per_pixel_placement * pixels_of(point) * smaller * smaller * placements);
  }
  return rows;
}

std::vector<double> points_of(const Experiment& experiment, const std::vector<Settings>& planned,
                              const std::vector<int64_t>& ids) {
  std::vector<double> points;
  const Settings* before = nullptr;
  for (const int64_t id : ids) {
    const Settings& point = planned[static_cast<size_t>(id)];
    const bool drawn = experiment.pictures == "all" || (experiment.pictures == "first" && id == 0);
    points.push_back(seconds(nominal_cost(point, before, curve_of(experiment, id), false)) +
                     (drawn ? picture_s(point) : 0));
    before = &point;
  }
  return points;
}

std::vector<double> rounds_of(const Experiment& experiment, const std::vector<Settings>& planned,
                              const std::vector<int64_t>& ids) {
  std::vector<Settings> timed;
  for (const int64_t id : ids) timed.push_back(planned[static_cast<size_t>(id)]);
  const auto rounds = static_cast<size_t>(time_rounds(timed));
  return std::vector<double>(rounds,
                             rounds == 0 ? 0 : timing_s(experiment, planned, ids) / static_cast<double>(rounds));
}

// The dearest point, because pictures are of those with the largest error, and not known yet.
std::vector<double> pictures_of(const std::vector<Settings>& planned, size_t drawn) {
  double most = 0;
  if (drawn > 0)
    for (const Settings& point : planned)
      most = std::max(most, seconds(nominal_cost(point, nullptr, std::nullopt, false)) + picture_s(point));
  return std::vector<double>(drawn, most);
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

SweepProgress::SweepProgress(const Experiment& experiment, const std::vector<Settings>& planned, const Ahead& ahead,
                             bool quiet)
    : shown(quiet),
      rows(shown.add(rows_of(ahead.diagrams))),
      points(shown.add(points_of(experiment, planned, ahead.unmeasured))),
      rounds(shown.add(rounds_of(experiment, planned, ahead.timed))),
      pictures(shown.add(pictures_of(planned, ahead.drawn))),
      report(shown.add(1, report_s + report_s_per_point * static_cast<double>(planned.size()))) {
  for (const PhasePlan* plan : ahead.diagrams) rows_ahead_ += static_cast<size_t>(plan->request.texel_sizes);
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
