#include "measure/point_record.h"

#include "compare/ladder/join_maps.h"
#include "compare/ladder/law_metrics.h"
#include "compare/ladder/numbers.h"
#include "measure/view_shading.h"
#include "scenes/camera_frame.h"
#include "technique/cost.h"

namespace noonmark {
namespace {

void add_cost(PointRecord& record, const FrameCost& cost) {
  record.metrics.insert({{"texel_work", static_cast<double>(cost.texel_work)},
                         {"traffic_bytes", static_cast<double>(cost.traffic_bytes)},
                         {"map_bytes", static_cast<double>(cost.map_bytes)},
                         {"map_texels", static_cast<double>(cost.map_texels)},
                         {"map_triangles", static_cast<double>(cost.map_triangles)},
                         {"lookup_fetches", static_cast<double>(cost.lookup.fetches)},
                         {"lookup_texels", static_cast<double>(cost.lookup.texels)},
                         {"lookup_operations", static_cast<double>(cost.lookup.operations)}});
}

// What share of the truth was found how. Without a receiver that faces the light nothing was asked.
void add_answers(PointRecord& record, const TruthAnswers& receivers, const TruthAnswers& texels,
                 const TruthAnswers& taps) {
  TruthAnswers answers = receivers;
  answers += texels;
  answers += taps;
  const auto share = [&](uint64_t some) {
    return answers.all() == 0 ? 0 : static_cast<double>(some) / static_cast<double>(answers.all());
  };
  record.metrics["truth_by_cells"] = share(answers.cells);
  record.metrics["truth_by_rays"] = share(answers.rays);
  record.metrics["truth_by_scan"] = share(answers.scan);
}

// How many lookups the facing receivers need: two in a blend band.
int64_t lookups(const Recorded& in, double facing) {
  int64_t count = static_cast<int64_t>(facing);
  for (size_t i = 0; i < in.choice.next.size(); ++i) count += in.truth.receivers.facing[i] && in.choice.next[i] > 0;
  return count;
}

std::map<std::string, double> laws_of(const ClimbedMap& map, const Ladder& ladder, const SceneStage& loaded,
                                      const ViewStage& view) {
  const Technique& technique = map.technique;
  return measure_laws({ladder, *loaded.scene, view.receivers, view.camera, technique.frame,
                       technique.settings.map.format, map.lookup.probe});
}

// What one of several maps has by itself: the numbers of its receivers in the ladder of the whole point. Hides the others for that
// time.
std::map<std::string, double> metrics_of_map(const ClimbedMap& map, int which, Ladder& ladder, const MapChoice& choice,
                                             const SceneStage& loaded, const ViewStage& view) {
  const Image<uint8_t> flags = ladder.flags;
  for (size_t i = 0; i < flags.size(); ++i)
    if (choice.of[i] != which) ladder.flags[i] = 0;
  std::map<std::string, double> metrics =
      record_of({map.technique, ladder, loaded, view, map.truth, {looked_up(map)}, only_map, MetricSet::searched})
          .metrics;
  metrics.merge(laws_of(map, ladder, loaded, view));
  ladder.flags = flags;
  metrics.insert(map.climbed.soundness.begin(), map.climbed.soundness.end());
  return metrics;
}

}  // namespace

LookedUpMap looked_up(const ClimbedMap& map) {
  return {map.technique.frame, map.lookup.probe, map.technique.bias, map.lookup.edge_distance_texels};
}

void add_time(PointRecord& record, const std::string& stage, const StageTime& time) {
  record.times[stage + "_ms"] = time.milliseconds;
  record.times[stage + "_rays"] = static_cast<double>(time.rays);
}

PointRecord record_of(const Recorded& in) {
  const Technique& t = in.technique;
  const Ladder& ladder = in.ladder;
  const ReceiverImage& receivers = in.view.receivers;
  const Image<float> occluders = in.loaded.tracer->occluder_distance(receivers, t.frame, peter_panning_mask(ladder));
  PointRecord record;
  record.settings = settings_map(t.settings);
  const MeasureInput input{ladder, receivers, in.maps, occluders, t.moves_casters(), in.loaded.surfaces, in.choice};
  record.metrics = measure_ladder(input);
  record.metrics.insert(in.view.metrics.begin(), in.view.metrics.end());
  const CameraFrame camera = make_camera_frame(in.view.camera, receivers.width(), receivers.height());
  DepthSpan depths;
  for (size_t i = 0; i < ladder.flags.size(); ++i)
    if (is_counted(ladder, i)) depths.add(camera.in_axes(receivers.position[i]).z);
  const bool any = depths.least_m <= depths.most_m;
  record.metrics["nearest_receiver_m"] = any ? depths.least_m : not_a_number;
  record.metrics["farthest_receiver_m"] = any ? depths.most_m : not_a_number;
  if (in.metrics != MetricSet::searched) {
    record.metrics["shaded_rmse"] = shaded_rmse(receivers, t.frame, camera, ladder.truth(), ladder.shown());
    record.metrics["flip"] = shaded_flip(receivers, t.frame, camera, ladder.truth(), ladder.shown());
  }
  int64_t texels = 0;
  int tiles = 0;
  for (const LookedUpMap& map : in.maps) texels += map.frame.texels(), tiles += map.frame.tiles;
  add_cost(record, frame_cost(t.settings, tiles, texels, lookups(in, record.metrics["facing"]),
                              static_cast<int64_t>(in.loaded.scene->triangles.size())));
  add_time(record, "hard_truth", in.truth.hard);
  add_time(record, "soft_truth", in.truth.soft);
  record.causes = ladder.brought;
  record.worst = worst_pixel(ladder);
  record.worst_of = worst_pixels(input);
  return record;
}

void add_maps(PointRecord& record, std::span<const ClimbedMap> maps, Ladder& ladder, std::span<const Seam> seams,
              const ChoiceStage& choice, const SceneStage& loaded, const ViewStage& view, Checks checks) {
  if (maps.size() == 1) {
    record.metrics.merge(laws_of(maps.front(), ladder, loaded, view));
    record.metrics.insert(maps.front().climbed.soundness.begin(), maps.front().climbed.soundness.end());
    return;
  }
  std::vector<std::map<std::string, double>> of_each;
  for (size_t k = 0; k < maps.size(); ++k) {
    const ViewSlice& slice = maps[k].technique.cascade->slices[k];
    of_each.push_back(metrics_of_map(maps[k], static_cast<int>(k), ladder, choice.chosen, loaded, view));
    std::map<std::string, double> own = of_each.back();
    own.merge(seam_metrics(seams[k]));
    record.cascades.push_back({slice.begin_m, slice.end_m, kept_of_cascade(own), {}});
  }
  Seam all;
  for (const Seam& seam : seams) all.add(seam);
  record.metrics.merge(seam_metrics(all));
  record.metrics.merge(join_laws(of_each));
  if (checks == Checks::none) return;
  record.metrics.merge(join_soundness(of_each, maps.front().climbed.soundness));
  record.metrics["cascade_choice_excess"] = choice.excess;
}

void add_texels(PointRecord& record, std::span<const ClimbedMap> maps, const MapStage& drawn, const TruthStage& truth,
                MetricSet metrics) {
  TruthAnswers texels, taps;
  StageTime texel_stage, tap_stage;
  double seen = 0;
  const auto add = [](StageTime& all, const StageTime& one) {
    all.milliseconds += one.milliseconds;
    all.rays += one.rays;
  };
  for (const ClimbedMap& map : maps) {
    const LookupStage& lookup = map.lookup;
    add(texel_stage, lookup.texel_stage);
    add(tap_stage, lookup.tap_stage);
    texels += lookup.texel_answers;
    taps += map.climbed.tap_answers;
    seen += static_cast<double>(lookup.seen_texels);
  }
  add_time(record, "texel", texel_stage);
  add_time(record, "tap", tap_stage);
  add_answers(record, truth.receivers.answers, texels, taps);
  record.metrics["map_seen"] = seen / record.metrics.at("map_texels");
  if (metrics == MetricSet::all)
    record.metrics["map_used"] = static_cast<double>(*drawn.used) / record.metrics.at("map_texels");
}

}  // namespace noonmark
