#include <algorithm>
#include <cmath>
#include <utility>

#include "compare/judge/poor_view.h"
#include "compare/ladder/join_cascades.h"
#include "compare/ladder/law_metrics.h"
#include "compare/ladder/measure.h"
#include "compare/ladder/numbers.h"
#include "compare/ladder/parameter_curve.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/ladder/seams.h"
#include "compare/results/quantities.h"
#include "measure/flicker_stage.h"
#include "measure/texel_footprint.h"
#include "measure/view_shading.h"
#include "measure/workbench_impl.h"
#include "scenes/camera_frame.h"
#include "technique/cascades.h"
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

void add_time(PointRecord& record, const std::string& stage, const StageTime& time) {
  record.times[stage + "_ms"] = time.milliseconds;
  record.times[stage + "_rays"] = static_cast<double>(time.rays);
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

// What a record is made of: the ladder over the receivers of these maps.
struct Recorded {
  const Technique& technique;
  const Ladder& ladder;
  const SceneStage& loaded;
  const ViewStage& view;
  const TruthStage& truth;  // of these receivers
  std::vector<LookedUpMap> maps;
  const ChosenCascades* cascades = nullptr;
  MetricSet metrics = MetricSet::all;
  const Image<uint8_t>* of() const { return cascades ? &cascades->of : nullptr; }
  // How many lookups the facing receivers need: two in a blend band.
  int64_t lookups(double facing) const {
    int64_t count = static_cast<int64_t>(facing);
    if (cascades)
      for (size_t i = 0; i < cascades->next.size(); ++i) count += truth.receivers.facing[i] && cascades->next[i] > 0;
    return count;
  }
};

// The numbers that come from the ladder and the receivers, of any number of maps.
PointRecord record_of(const Recorded& in) {
  const Technique& t = in.technique;
  const Ladder& ladder = in.ladder;
  const ReceiverImage& receivers = in.view.receivers;
  const Image<float> occluders = in.loaded.tracer->occluder_distance(receivers, t.frame, peter_panning_mask(ladder));
  PointRecord record;
  record.settings = settings_map(t.settings);
  const MeasureInput input{ladder, receivers, in.maps, occluders, t.moves_casters(), in.loaded.surfaces, in.of()};
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
  add_cost(record, frame_cost(t.settings, tiles, texels, in.lookups(record.metrics["facing"]),
                              static_cast<int64_t>(in.loaded.scene->triangles.size())));
  add_time(record, "hard_truth", in.truth.hard);
  add_time(record, "soft_truth", in.truth.soft);
  record.causes = ladder.brought;
  record.worst = worst_pixel(ladder);
  record.worst_of = worst_pixels(input);
  return record;
}

std::map<std::string, double> laws_of(const Technique& technique, const Ladder& ladder, const SceneStage& loaded,
                                      const ViewStage& view, const LookupStage& lookup) {
  return measure_laws({ladder, *loaded.scene, view.receivers, view.camera, technique.frame,
                       technique.settings.map.format, lookup.probe, technique.moments.has_value()});
}

// Of the maps' grids and the receivers alone, so that it is the same at every bias.
std::map<std::string, double> footprint_of(const Recorded& in) {
  const ReceiverImage& receivers = in.view.receivers;
  std::vector<const LightFrame*> frames;
  for (const LookedUpMap& map : in.maps) frames.push_back(&map.frame);
  const CameraFrame camera = make_camera_frame(in.view.camera, receivers.width(), receivers.height());
  return footprint_metrics(texel_footprint(receivers, camera, frames, in.of(), in.truth.receivers.facing));
}

// Of the receivers of one cascade, in the ladder of the whole point. It hides the others for that time.
PointRecord::Cascade record_of_cascade(const OneMap& map, Ladder& ladder, const Image<uint8_t>& cascades,
                                       const SceneStage& loaded, const ViewStage& view) {
  const LookupStage& lookup = map.lookup;
  const Technique& technique = map.technique;
  const CascadePlace& place = *technique.cascade;
  const Image<uint8_t> flags = ladder.flags;
  for (size_t i = 0; i < cascades.size(); ++i)
    if (cascades[i] != place.index) ladder.flags[i] = 0;
  PointRecord record = record_of({technique,
                                  ladder,
                                  loaded,
                                  view,
                                  map.truth,
                                  {{technique.frame, lookup.probe, technique.bias, lookup.edge_distance_texels}},
                                  nullptr,
                                  MetricSet::searched});
  record.metrics.merge(laws_of(technique, ladder, loaded, view, lookup));
  ladder.flags = flags;
  record.metrics.insert(map.climbed.soundness.begin(), map.climbed.soundness.end());
  const ViewSlice slice = place.slices[static_cast<size_t>(place.index)];
  return {slice.begin_m, slice.end_m, std::move(record.metrics), {}};
}

// What the maps of a point have seen and taken.
void add_maps(PointRecord& record, std::span<const OneMap> maps, const MapStage& drawn, const TruthStage& truth,
              MetricSet metrics) {
  TruthAnswers texels, taps;
  StageTime texel_stage, tap_stage;
  double seen = 0;
  const auto add = [](StageTime& all, const StageTime& one) {
    all.milliseconds += one.milliseconds;
    all.rays += one.rays;
  };
  for (const OneMap& map : maps) {
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

// Of each cascade the seam to the next; the last has none.
std::vector<Seam> seams_of(std::span<const OneMap> maps, const ChosenCascades& choice) {
  std::vector<Seam> seams(maps.size());
  for (size_t k = 0; k + 1 < maps.size(); ++k) {
    Image<uint8_t> here = choice.seam;
    for (size_t i = 0; i < here.size(); ++i) here[i] = here[i] && choice.of[i] == k;
    seams[k] = seam_of(maps[k].climbed.ladder, maps[k + 1].climbed.ladder, here);
  }
  return seams;
}

}  // namespace

TruthStage truth_of_cascade(const TruthStage& all, const ChosenCascades& choice, int cascade) {
  TruthStage one = all;
  one.receivers.answers = {};
  one.receivers.share = Image<double>(choice.of.width, choice.of.height, 0);
  for (size_t i = 0; i < choice.of.size(); ++i) {
    one.receivers.share[i] = choice.share(i, cascade);
    const bool at_seam = choice.seam[i] && choice.of[i] + 1 == cascade;
    if (one.receivers.share[i] == 0 && !at_seam) one.receivers.facing[i] = 0;
  }
  return one;
}

const TruthStage& Workbench::Impl::truth_of(const Asked& asked, const Looked& looked, MapStages& kept,
                                            const Technique& technique) {
  if (!technique.cascade) return looked.truth;
  return kept.truth.get(asked.keys.truth + asked.keys.lookup, [&] {
    return truth_of_cascade(looked.truth, choose(asked, looked.view, technique).chosen, technique.cascade->index);
  });
}

const ChoiceStage& Workbench::Impl::choose(const Asked& asked, const ViewStage& seen, const Technique& of_any_cascade) {
  return chosen.get(asked.keys.view + asked.keys.lookup, [&] {
    ChoiceStage made{renderer.choose_cascades(of_any_cascade)};
    const CascadePlace& place = *of_any_cascade.cascade;
    ChosenCascades& choice = made.chosen;
    for (size_t i = 0; i < choice.of.size(); ++i) {
      if (choice.of[i] == no_cascade) continue;
      const glm::vec3 at = seen.receivers.position[i];
      const CascadeChoice found{choice.of[i], choice.share(i, choice.of[i] + 1)};
      raise(made.excess, choice_excess(place, seen.camera.eye_m, at, found));
      if (made.excess == infinity) {  // there is no such cascade, or no such weight
        const CascadeChoice exact = choose_cascade(place, seen.camera.eye_m, at);
        choice.of[i] = static_cast<uint8_t>(exact.cascade);
        if (choice.blends()) choice.next[i] = static_cast<float>(exact.next);
      }
    }
    return made;
  });
}

ShownMaps Workbench::Impl::show_maps(const Asked& asked, const ViewStage& seen, KeptMaps& kept,
                                     std::span<const TruthStage* const> truths, std::span<const Technique> techniques,
                                     const ChosenCascades* of_receivers, MetricSet metrics, bool keep_fetched,
                                     Checks checks) {
  const SceneStage& loaded = asked.loaded;
  if (!kept.exact.has(asked.keys.lookup)) kept.exact.forget();
  std::vector<AskedMap> of_each;
  for (size_t k = 0; k < techniques.size(); ++k) {
    Remembered<LookupStage>& lookup = kept.each[k].lookup;
    if (!lookup.has(asked.keys.lookup)) free_large_maps(kept);
    of_each.push_back(
        {lookup.get(asked.keys.lookup,
                    [&] { return stages->prepare_lookup(renderer, *loaded.tracer, seen, *truths[k], techniques[k]); }),
         *truths[k]});
  }
  MapStage& map = drawn(kept, *loaded.scene, techniques, asked.keys.map);
  // A search does not read it, and it costs a pass over the map.
  if (metrics == MetricSet::all && !map.used) map.used = renderer.used_texels(*map.map);
  std::optional<gl::ShadowMap>& exact =
      kept.exact.get(asked.keys.lookup, [] { return std::optional<gl::ShadowMap>(); });
  return stages->show_maps(renderer, map, exact, of_each, techniques, of_receivers, keep_fetched, checks);
}

// OpenGL renders the worst placement of a map too: what it shows there is a metric of its own, and with checks the counts are
// compared with it.
Workbench::Impl::WorstPlacement Workbench::Impl::render_worst(const Asked& asked, const ViewStage& seen,
                                                              const OneMap& map, PlacementStage& placements,
                                                              Checks checks) {
  see(asked);
  const int worst = worst_placement(placements.shares());
  const Technique moved = map.technique.at(placements.frame(worst));
  const SceneStage& loaded = asked.loaded;
  const ReceiverTruth& truth = map.truth.receivers;
  if (checks == Checks::none) {
    const MapStage drawn = stages->draw_map(renderer, *loaded.scene, moved);
    const MapResults results = stages->look_up(renderer, *drawn.map, {&moved, 1});
    return {error_of_map(result_in_map(results, nullptr, 0), truth), {}};
  }
  LookupStage lookup_there = stages->prepare_lookup(renderer, *loaded.tracer, seen, map.truth, moved);
  MapStage drawn = stages->draw_map(renderer, *loaded.scene, moved);
  const ShownStage shown = stages->show(renderer, drawn, lookup_there, map.truth, moved);
  Climbed climbed = stages->climb_strips(
      renderer, lookup_there, seen, map.truth, shown, moved, nullptr,
      [&](const LookupEvidence& evidence, PixelRange strip) { placements.compare(evidence, worst, strip); });
  climbed.soundness["residual"] = climbed.ladder.residual;
  climbed.soundness["tap_residual"] = climbed.ladder.tap_residual;
  return {error_of_map(shown.r5, truth), std::move(climbed.soundness)};
}

// Adds the metrics over all placements of a map, or of each of the cascades, whose worst placements are independent.
// of_maps: placement_metrics() of all of them.
void Workbench::Impl::add_placements(PointRecord& record, std::span<const OneMap> maps,
                                     std::span<const std::unique_ptr<PlacementStage>> placements,
                                     std::map<std::string, double> of_maps, const ViewStage& seen, const Asked& asked,
                                     Checks checks) {
  record.metrics.merge(of_maps);
  double error = 0, disagreements = 0, receivers = 0;
  for (const auto& stage : placements) receivers += stage->receivers();
  StageTime time;
  for (size_t k = 0; k < maps.size(); ++k) {
    PlacementStage& stage = *placements[k];
    time.milliseconds += stage.time().milliseconds;
    time.rays += stage.time().rays;
    const double share = stage.receivers() / receivers;
    if (!(share > 0)) continue;
    const WorstPlacement worst = render_worst(asked, seen, maps[k], stage, checks);
    error += share * worst.error_shown;
    disagreements += static_cast<double>(stage.disagreements());
    // A defect that only the worst placement shows makes the point unsound too.
    for (const SoundLimit& limit : sound_limits)
      if (const auto value = worst.soundness.find(limit.metric); value != worst.soundness.end())
        if (double& found = record.metrics[limit.metric]; !(value->second <= found)) found = value->second;
  }
  record.metrics["error_worst_shown"] = error;
  if (checks == Checks::all) record.metrics["placement_disagreements"] = disagreements;
  add_time(record, "placement", time);
}

std::vector<ReceiverSection> Workbench::sections(const Measurement& m, std::span<const glm::ivec2> pixels) {
  Impl& b = *impl_;
  const Impl::Asked asked = b.begin(m.technique.settings);
  const Impl::Looked looked = b.look(asked);
  std::vector<std::optional<ReceiverSection>> found(pixels.size());
  const glm::ivec2 size(m.receivers.width(), m.receivers.height());
  for (size_t n = 0; n < m.maps.size(); ++n) {
    const MeasuredMap& map = m.maps[n];
    MapStages& kept = b.of_maps(m.maps.size()).each[n];
    const TruthStage& truth = b.truth_of(asked, looked, kept, map.technique);
    LookupStage& lookup = kept.lookup.get(asked.keys.lookup, [&] {
      return b.stages->prepare_lookup(b.renderer, *asked.loaded.tracer, looked.view, truth, map.technique);
    });
    const auto cut = [&](const LookupEvidence& evidence, PixelRange strip) {
      for (size_t k = 0; k < pixels.size(); ++k) {
        const glm::ivec2 pixel = pixels[k];
        // section_of() says what is wrong with a pixel outside the picture.
        const bool outside = !inside_map(pixel, size);
        const size_t i = outside ? 0 : m.receivers.primitive.index(pixel.x, pixel.y);
        const double share = m.maps.size() > 1 ? m.cascades.share(i, static_cast<int>(n)) : 1;
        const bool here = strip.first <= i && i < strip.end && (share > 0 || &m.map_of(i) == &map);
        if (outside ? found[k].has_value() : !here) continue;
        ReceiverSection one = section_of(
            {m.scene, m.receivers, map.technique, m.ladder, evidence, map.stored, map.stored_rows, share}, pixel);
        // In a blend band the map that more of the error comes from.
        const auto part = [](const ReceiverSection& of) {
          return of.share * std::abs(static_cast<double>(of.shown) - static_cast<double>(of.truth));
        };
        if (!found[k] || part(one) > part(*found[k])) found[k] = std::move(one);
      }
    };
    each_strip_of(b.renderer, lookup, truth, map.technique, cut);
  }
  std::vector<ReceiverSection> sections;
  for (std::optional<ReceiverSection>& one : found) sections.push_back(std::move(one.value()));
  return sections;
}

Measurement Workbench::measure(const Settings& settings, const std::optional<CurveOptions>& curve_options,
                               MetricSet metrics, Checks checks) {
  Impl& b = *impl_;
  const Impl::Asked asked = b.begin(settings);
  const SceneStage& loaded = asked.loaded;
  const Technique& technique = asked.technique;
  const Scene& scene = *loaded.scene;

  const Impl::Looked looked = b.look(asked);
  const ViewStage& view = looked.view;  // named, because clang 14 lets no lambda capture a structured binding
  const TruthStage& truth = looked.truth;
  const std::optional<ViewSlice> visible = visible_depths(settings, view.receivers, view.camera);
  const auto all_techniques = std::make_shared<const std::vector<Technique>>(cascades_of(scene, settings, visible));
  const std::vector<Technique>& techniques = *all_techniques;
  const bool cascaded = techniques.size() > 1;
  KeptMaps& kept = b.of_maps(techniques.size());
  const ChoiceStage* const choice = cascaded ? &b.choose(asked, view, techniques.front()) : nullptr;
  std::vector<const TruthStage*> truths;
  std::vector<ScaledMap> scaled;
  for (size_t k = 0; k < techniques.size(); ++k) {
    truths.push_back(&b.truth_of(asked, looked, kept.each[k], techniques[k]));
    scaled.push_back({techniques[k].frame, truths[k]->receivers});
  }

  const BiasPart* const varied = curve_options ? curve_part(settings) : nullptr;
  const std::string curve_key = varied ? curve_key_of(settings, *varied, *curve_options) : "";
  const BiasPart* const unknown = varied && !b.curve.has(curve_key) ? varied : nullptr;
  // Only for a curve that is not known yet.
  const BiasScale scale = unknown ? bias_scale(scaled, view.receivers, settings.bias.unit) : BiasScale();
  const bool reduces = curve_options && has_reduction_curve(settings);
  std::vector<std::unique_ptr<PlacementStage>> placements;  // of each map
  const auto with_placements = [&](LookupStage& lookup) -> EachStrip {
    const size_t k = placements.size();
    PlacementRequest request{unknown, {}, {}, checks};
    if (unknown) request.edges = placement_edges(biases_of(*curve_options), scale.depth_per_unit);
    if (reduces && !cascaded) request.reductions = {curve_options->peter_panning_bound, curve_options->acne_bound};
    placements.push_back(make_placement_stage(
        {*b.stages, b.renderer, *loaded.tracer, lookup.probe, view, *truths[k], techniques[k]}, std::move(request)));
    return [&stage = *placements[k]](const LookupEvidence& evidence, PixelRange strip) { stage.add(evidence, strip); };
  };
  b.see(asked);
  const ChosenCascades* const of_receivers = cascaded ? &choice->chosen : nullptr;
  std::optional<ParameterCurve> over;
  if (curve_options && has_curve_over(settings, curve_options->over.setting))
    over.emplace(curve_options->over, settings);
  ShownMaps shown = b.show_maps(asked, view, kept, truths, techniques, of_receivers, metrics, over.has_value(), checks);
  std::vector<OneMap> maps;
  for (size_t k = 0; k < techniques.size(); ++k) {
    LookupStage& lookup = *kept.each[k].lookup.value();
    // What is not needed again is freed before the point's numbers are computed, because it is large.
    ShownStage one = shown.take(of_receivers, k);
    if (k + 1 == techniques.size()) shown = {};
    const EachStrip placed = settings.map.placements > 1 ? with_placements(lookup) : EachStrip();
    const EachStrip each_strip = [&](const LookupEvidence& evidence, PixelRange strip) {
      if (placed) placed(evidence, strip);
      if (!over) return;
      ParameterCurve::Adding adding(*over, evidence, one.fetched);
      read_taps(evidence, strip, adding);
    };
    Climbed climbed =
        b.stages->climb_strips(b.renderer, lookup, view, *truths[k], one, techniques[k], unknown, each_strip);
    maps.push_back({lookup, techniques[k], *truths[k], std::move(one.stored), std::move(climbed)});
    if (!placements.empty()) placements.back()->finish();
  }
  b.free_large_picture(view.receivers);

  std::vector<PointRecord::Cascade> cascades;
  std::map<std::string, double> laws, soundness, of_placements;
  if (!cascaded) {
    const OneMap& map = maps.front();
    laws = laws_of(technique, map.climbed.ladder, loaded, view, map.lookup);
    soundness = map.climbed.soundness;
    if (!placements.empty()) {
      const PlacementStage& stage = *placements.front();
      const PlacementShares shares = stage.shares();
      of_placements = placement_metrics(shares, stage.facts(worst_placement(shares)));
      if (const auto usable = stage.reductions())
        of_placements.insert({{"reduction_min_worst", usable->low}, {"reduction_max_worst", usable->high}});
    }
  }
  const std::vector<Seam> seams = cascaded ? seams_of(maps, choice->chosen) : std::vector<Seam>();
  Measurement m{{}, technique, std::move(maps.front().climbed.ladder), view.camera, scene, view.receivers, {}, {}, {}};
  for (size_t k = 1; k < maps.size(); ++k) {
    join(m.ladder, maps[k].climbed.ladder, truths[k]->receivers.share);
    maps[k].climbed.ladder = Ladder();
  }
  if (cascaded) {
    m.cascades = choice->chosen;
    for (size_t k = 0; k < maps.size(); ++k) {
      cascades.push_back(record_of_cascade(maps[k], m.ladder, m.cascades.of, loaded, view));
      cascades.back().metrics.merge(seam_metrics(seams[k]));
      if (!placements.empty()) cascades.back().metrics.merge(placement_metrics(placements[k]->shares(), {}));
    }
    if (!placements.empty()) {
      std::vector<double> receivers;
      for (const auto& stage : placements) receivers.push_back(stage->receivers());
      of_placements = join_placements(cascades, receivers, m.cascades.blends());
    }
    laws = join_laws(cascades, technique.moments.has_value());
    if (checks == Checks::all) {
      soundness = join_soundness(cascades, maps.front().climbed.soundness);
      soundness["cascade_choice_excess"] = choice->excess;
    }
    keep_cascade_metrics(cascades);
  }
  Recorded recorded{technique, m.ladder, loaded, view, truth, {}, cascaded ? &m.cascades : nullptr, metrics};
  for (const OneMap& map : maps)
    recorded.maps.push_back(
        {map.technique.frame, map.lookup.probe, map.technique.bias, map.lookup.edge_distance_texels});
  m.record = record_of(recorded);
  if (metrics == MetricSet::all) {
    // Which cascade a receiver is in depends on the lookup.
    const std::string key = asked.keys.truth + (cascaded ? asked.keys.lookup : asked.keys.map);
    for (const auto& [name, value] : b.footprint.get(key, [&] { return footprint_of(recorded); }))
      m.record.metrics[name] = value;
  }
  if (cascaded) {
    Seam all;
    for (const Seam& seam : seams) all.add(seam);
    m.record.metrics.merge(seam_metrics(all));
  }
  m.record.metrics.merge(laws);
  m.record.metrics.merge(soundness);
  if (reduces) {
    ReductionWindow reductions;
    for (OneMap& map : maps) reductions.add(std::exchange(map.climbed.reductions, {}));
    reductions.sort();
    m.record.metrics.merge(
        reduction_metrics(reductions, curve_options->peter_panning_bound, curve_options->acne_bound));
    m.record.lookup_curve = reduction_curve(reductions);
    if (!m.record.lookup_curve.empty()) m.record.lookup_bounds = *curve_options;
  }
  if (over) m.record.over_curve = over->curve();
  add_maps(m.record, maps, *kept.drawn.value(), truth, metrics);
  m.record.cascades = std::move(cascades);
  if (varied && !nothing_judged(m.record)) {
    const CurveStage& found = b.curve.get(curve_key, [&] {
      CurveStage made;
      if (cascaded)
        for (const OneMap& map : maps)
          made.needed_by_cascade.push_back(static_cast<double>(map.climbed.counts->acne_free_from(0)));
      for (size_t k = 1; k < maps.size(); ++k) maps.front().climbed.counts->add(std::move(*maps[k].climbed.counts));
      made.curve = summarise(*maps.front().climbed.counts, scale, *curve_options);
      maps.front().climbed.counts.reset();  // large, and not needed again: freed before the curve is copied
      std::vector<const PlacementCounts*> counts;
      for (const auto& stage : placements) counts.push_back(stage->counts());
      if (!counts.empty()) add_bands(made.curve, counts, scale.depth_per_unit);
      return made;
    });
    m.record.curve = found.curve;
    for (size_t k = 0; k < m.record.cascades.size(); ++k)
      if (m.record.cascades[k].metrics.at("counted") > 0 && std::isfinite(found.needed_by_cascade[k]))
        m.record.cascades[k].bias_needed = found.needed_by_cascade[k];
  }
  if (settings.view.motion.any()) {
    b.see(asked);
    m.flicker = trace_flicker({*b.stages, b.renderer, loaded, view, truth, techniques, cascaded ? &m.cascades : nullptr,
                               m.ladder[Rung::shown]});
    m.record.metrics.merge(measure_flicker(*m.flicker));
  }
  if (!placements.empty() && !nothing_judged(m.record))
    b.add_placements(m.record, maps, placements, std::move(of_placements), view, asked, checks);
  for (size_t k = 0; k < maps.size(); ++k)
    m.maps.push_back(
        {techniques[k], maps[k].lookup.probe, std::move(maps[k].stored), maps[k].lookup.exact_depth,
         [&b, &scene, &kept, all_techniques, key = asked.keys.map, which = static_cast<int>(k)](int first, int count) {
           return b.renderer.read_rows(*b.drawn(kept, scene, *all_techniques, key).map, first, count, which);
         }});
  return m;
}

}  // namespace noonmark
