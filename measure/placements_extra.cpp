#include "measure/placements_extra.h"

#include <cmath>
#include <numeric>

#include "compare/judge/poor_view.h"
#include "compare/judge/soundness.h"
#include "compare/ladder/join_maps.h"
#include "compare/ladder/numbers.h"
#include "measure/point_record.h"

namespace noonmark {
namespace {

// The mean of |R5 - R1| over the counted receivers of a map, each weighted by the map's share in it. NaN without one.
double error_of_map(const Image<float>& shown, const ReceiverTruth& truth) {
  double sum = 0, all = 0;
  for (size_t i = 0; i < shown.size(); ++i) {
    if (!truth.facing[i] || truth.ambiguous[i]) continue;
    const double share = truth.share.size() == 0 ? 1 : truth.share[i];
    sum += share * std::abs(static_cast<double>(shown[i]) - static_cast<double>(truth.lit[i]));
    all += share;
  }
  return all > 0 ? sum / all : not_a_number;
}

}  // namespace

void PlacementsExtra::begin(size_t map, const LookupStage& lookup, const ShownStage&) {
  stages_.push_back(make_placement_stage({*in_.bench.stages, in_.bench.renderer, *in_.asked.loaded.tracer, lookup.probe,
                                          in_.looked.view, *in_.maps.truths[map], in_.maps.techniques()[map]},
                                         request_));
}

// OpenGL renders the worst placement of a map too: what it shows there is a metric of its own, and with checks the counts are
// compared with it.
PlacementsExtra::Worst PlacementsExtra::render_worst(size_t map) {
  Bench& b = in_.bench;
  b.see(in_.asked);
  PlacementStage& placements = *stages_[map];
  const int worst = worst_placement(placements.shares());
  const Technique moved = in_.maps.techniques()[map].at(placements.frame(worst));
  const SceneStage& loaded = in_.asked.loaded;
  const TruthStage& truth = *in_.maps.truths[map];
  if (in_.checks == Checks::none) {
    const MapStage drawn = b.stages->draw_map(b.renderer, *loaded.scene, moved);
    const MapResults results = b.stages->look_up(b.renderer, *drawn.map, {&moved, 1});
    return {error_of_map(result_in_map(results, only_map, 0), truth.receivers), {}};
  }
  LookupStage lookup_there = b.stages->prepare_lookup(b.renderer, *loaded.tracer, in_.looked.view, truth, moved);
  MapStage drawn = b.stages->draw_map(b.renderer, *loaded.scene, moved);
  const ShownStage shown = b.stages->show(b.renderer, drawn, lookup_there, truth, moved);
  Climbed climbed = b.stages->climb_strips(
      b.renderer, lookup_there, in_.looked.view, truth, shown, moved, nullptr,
      [&](const LookupEvidence& evidence, PixelRange strip) { placements.compare(evidence, worst, strip); });
  climbed.soundness["residual"] = climbed.ladder.residual;
  climbed.soundness["tap_residual"] = climbed.ladder.tap_residual;
  return {error_of_map(shown.r5, truth.receivers), std::move(climbed.soundness)};
}

std::map<std::string, double> PlacementsExtra::joined() const {
  std::vector<std::map<std::string, double>> of_each;
  std::vector<double> receivers;
  for (const auto& stage : stages_) {
    const PlacementShares shares = stage->shares();
    // Several maps have no worst placement in common that could be named.
    of_each.push_back(placement_metrics(
        shares, stages_.size() == 1 ? stage->facts(worst_placement(shares)) : std::vector<PlacementFact>()));
    receivers.push_back(stage->receivers());
    if (const auto usable = stage->reductions())
      of_each.back().insert({{"reduction_min_worst", usable->low}, {"reduction_max_worst", usable->high}});
  }
  return join_placements(of_each, receivers, in_.maps.choice.chosen.blends());
}

void PlacementsExtra::put(Measurement& m) {
  if (nothing_judged(m.record)) return;
  PointRecord& record = m.record;
  record.metrics.merge(joined());
  const double receivers = std::accumulate(stages_.begin(), stages_.end(), 0.0,
                                           [](double sum, const auto& stage) { return sum + stage->receivers(); });
  double error = 0, disagreements = 0;
  StageTime time;
  for (size_t k = 0; k < stages_.size(); ++k) {
    const PlacementStage& stage = *stages_[k];
    time.milliseconds += stage.time().milliseconds;
    time.rays += stage.time().rays;
    const double share = stage.receivers() / receivers;
    if (!(share > 0)) continue;
    const Worst worst = render_worst(k);
    error += share * worst.error_shown;
    disagreements += static_cast<double>(stage.disagreements());
    // A defect that only the worst placement shows makes the point unsound too.
    for (const SoundLimit& limit : sound_limits)
      if (const auto value = worst.soundness.find(limit.metric); value != worst.soundness.end())
        if (double& found = record.metrics[limit.metric]; !(value->second <= found)) found = value->second;
  }
  record.metrics["error_worst_shown"] = error;
  if (in_.checks == Checks::all) record.metrics["placement_disagreements"] = disagreements;
  add_time(record, "placement", time);
}

std::vector<const PlacementCounts*> PlacementsExtra::counts() const {
  std::vector<const PlacementCounts*> all;
  for (const auto& stage : stages_) all.push_back(stage->counts());
  return all;
}

}  // namespace noonmark
