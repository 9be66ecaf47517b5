#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/extra.h"
#include "measure/point_record.h"
#include "technique/cascades.h"

namespace noonmark {
namespace {

// Of each map the seam to the next; the last has none.
std::vector<Seam> seams_of(std::span<const ClimbedMap> maps, const MapChoice& choice) {
  std::vector<Seam> seams(maps.size());
  for (size_t k = 0; k + 1 < maps.size(); ++k) {
    Image<uint8_t> here = choice.seam;
    for (size_t i = 0; i < here.size(); ++i) here[i] = here[i] && choice.of[i] == k;
    seams[k] = seam_of(maps[k].climbed.ladder, maps[k + 1].climbed.ladder, here);
  }
  return seams;
}

// The ladder of the whole picture; those of the maps are gone then.
Ladder joined_ladder(std::span<ClimbedMap> maps) {
  Ladder all = std::move(maps.front().climbed.ladder);
  for (ClimbedMap& map : maps.subspan(1)) {
    join(all, map.climbed.ladder, map.truth.receivers.share);
    map.climbed.ladder = Ladder();
  }
  return all;
}

// Compares what a shader has chosen with the choice in double.
void check_choice(ChoiceStage& made, const CascadePlace& place, const ViewStage& seen) {
  MapChoice& choice = made.chosen;
  for (size_t i = 0; i < choice.of.size(); ++i) {
    if (choice.of[i] == no_map) continue;
    const glm::vec3 at = seen.receivers.position[i];
    const CascadeChoice found{choice.of[i], choice.share(i, choice.of[i] + 1)};
    raise(made.excess, choice_excess(place, seen.camera.eye_m, at, found));
    if (made.excess == infinity) {  // there is no such cascade, or no such weight
      const CascadeChoice exact = choose_cascade(place, seen.camera.eye_m, at);
      choice.of[i] = static_cast<uint8_t>(exact.cascade);
      if (choice.blends()) choice.next[i] = static_cast<float>(exact.next);
    }
  }
}

}  // namespace

TruthStage truth_of_map(const TruthStage& all, const MapChoice& choice, int map) {
  TruthStage one = all;
  one.receivers.answers = {};
  one.receivers.share = Image<double>(choice.of.width, choice.of.height, 0);
  for (size_t i = 0; i < choice.of.size(); ++i) {
    one.receivers.share[i] = choice.share(i, map);
    const bool at_seam = choice.seam[i] && choice.of[i] + 1 == map;
    if (one.receivers.share[i] == 0 && !at_seam) one.receivers.facing[i] = 0;
  }
  return one;
}

PointMaps Bench::maps_of(const Asked& asked, const Looked& looked) {
  const Settings& settings = asked.technique.settings;
  const std::optional<ViewSlice> visible = visible_depths(settings, looked.view.receivers, looked.view.camera);
  auto techniques =
      std::make_shared<const std::vector<Technique>>(techniques_of(*asked.loaded.scene, settings, visible));
  maps.each.resize(techniques->size());
  const Technique& first = techniques->front();
  const ChoiceStage& choice = chosen.get(asked.keys.view + asked.keys.lookup, [&] {
    ChoiceStage made{renderer.choose_maps(first)};
    if (first.cascade) check_choice(made, *first.cascade, looked.view);
    return made;
  });
  std::vector<const TruthStage*> truths;
  for (size_t k = 0; k < techniques->size(); ++k)
    truths.push_back(choice.chosen.one_map() ? &looked.truth
                                             : &maps.each[k].truth.get(asked.keys.truth + asked.keys.lookup, [&] {
                                                 return truth_of_map(looked.truth, choice.chosen, static_cast<int>(k));
                                               }));
  return {std::move(techniques), choice, std::move(truths)};
}

ShownMaps Bench::show_maps(const Asked& asked, const ViewStage& seen, KeptMaps& kept, const PointMaps& of,
                           MetricSet metrics, bool keep_fetched, Checks checks) {
  const SceneStage& loaded = asked.loaded;
  if (!kept.exact.has(asked.keys.lookup)) kept.exact.forget();
  std::vector<AskedMap> of_each;
  for (size_t k = 0; k < of.count(); ++k) {
    Remembered<LookupStage>& lookup = kept.each[k].lookup;
    if (!lookup.has(asked.keys.lookup)) free_large_maps(kept);
    of_each.push_back(
        {lookup.get(
             asked.keys.lookup,
             [&] { return stages->prepare_lookup(renderer, *loaded.tracer, seen, *of.truths[k], of.techniques()[k]); }),
         *of.truths[k]});
  }
  MapStage& map = drawn(kept, *loaded.scene, of.techniques(), asked.keys.map);
  // A search does not read it, and it costs a pass over the map.
  if (metrics == MetricSet::all && !map.used) map.used = renderer.used_texels(*map.map);
  std::optional<gl::ShadowMap>& exact =
      kept.exact.get(asked.keys.lookup, [] { return std::optional<gl::ShadowMap>(); });
  return stages->show_maps(renderer, map, exact, of_each, of.techniques(), of.choice.chosen, keep_fetched, checks);
}

std::vector<ClimbedMap> Bench::climb(const Asked& asked, const ViewStage& seen, const PointMaps& of, Extras& extras,
                                     MetricSet metrics, Checks checks) {
  see(asked);
  ShownMaps shown = show_maps(asked, seen, maps, of, metrics, extras.reads_fetched, checks);
  std::vector<ClimbedMap> climbed;
  for (size_t k = 0; k < of.count(); ++k) {
    const Technique& technique = of.techniques()[k];
    LookupStage& lookup = *maps.each[k].lookup.value();
    // What is not needed again is freed before the point's numbers are computed, because it is large.
    ShownStage one = shown.take(of.choice.chosen, k);
    if (k + 1 == of.count()) shown = {};
    for (const auto& extra : extras.each) extra->begin(k, lookup, one);
    climbed.push_back({lookup,
                       technique,
                       *of.truths[k],
                       {},
                       stages->climb_strips(renderer, lookup, seen, *of.truths[k], one, technique, extras.counted,
                                            [&](const LookupEvidence& evidence, PixelRange strip) {
                                              for (const auto& extra : extras.each) extra->add(evidence, strip);
                                            })});
    climbed.back().stored = std::move(one.stored);
    for (const auto& extra : extras.each) extra->end(climbed.back().climbed);
  }
  free_large_picture(seen.receivers);
  return climbed;
}

std::vector<ReceiverSection> Workbench::sections(const Measurement& m, std::span<const glm::ivec2> pixels) {
  Bench& b = *bench_;
  const Bench::Asked asked = b.begin(m.technique.settings);
  const Bench::Looked looked = b.look(asked);
  std::vector<std::optional<ReceiverSection>> found(pixels.size());
  const glm::ivec2 size(m.receivers.width(), m.receivers.height());
  const PointMaps maps = b.maps_of(asked, looked);
  for (size_t n = 0; n < m.maps.size(); ++n) {
    const MeasuredMap& map = m.maps[n];
    const TruthStage& truth = *maps.truths[n];
    LookupStage& lookup = b.maps.each[n].lookup.get(asked.keys.lookup, [&] {
      return b.stages->prepare_lookup(b.renderer, *asked.loaded.tracer, looked.view, truth, map.technique);
    });
    const auto cut = [&](const LookupEvidence& evidence, PixelRange strip) {
      for (size_t k = 0; k < pixels.size(); ++k) {
        const glm::ivec2 pixel = pixels[k];
        // section_of() says what is wrong with a pixel outside the picture.
        const bool outside = !inside_map(pixel, size);
        const size_t i = outside ? 0 : m.receivers.primitive.index(pixel.x, pixel.y);
        const double share = m.choice.share(i, static_cast<int>(n));
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

Measurement Workbench::measure(const Settings& settings, const std::optional<CurveOptions>& curve, MetricSet metrics,
                               Checks checks) {
  Bench& b = *bench_;
  const Bench::Asked asked = b.begin(settings);
  const Bench::Looked looked = b.look(asked);
  const SceneStage& loaded = asked.loaded;
  const ViewStage& view = looked.view;  // named, because clang 14 lets no lambda capture a structured binding
  const PointMaps of = b.maps_of(asked, looked);
  const MapChoice& choice = of.choice.chosen;
  Extras extras = extras_of({b, asked, looked, of, checks}, curve, metrics);
  std::vector<ClimbedMap> maps = b.climb(asked, view, of, extras, metrics, checks);

  const std::vector<Seam> seams = seams_of(maps, choice);
  Measurement m{{}, asked.technique, joined_ladder(maps), view.camera, *loaded.scene, view.receivers, {}, choice, {}};
  std::vector<LookedUpMap> looked_up_maps;
  for (const ClimbedMap& map : maps) looked_up_maps.push_back(looked_up(map));
  m.record =
      record_of({asked.technique, m.ladder, loaded, view, looked.truth, std::move(looked_up_maps), choice, metrics});
  add_maps(m.record, maps, m.ladder, seams, of.choice, loaded, view, checks);
  add_texels(m.record, maps, *b.maps.drawn.value(), looked.truth, metrics);
  for (const auto& extra : extras.each) extra->put(m);
  for (size_t k = 0; k < maps.size(); ++k)
    m.maps.push_back({of.techniques()[k], maps[k].lookup.probe, std::move(maps[k].stored), maps[k].lookup.exact_depth,
                      [&b, &scene = *loaded.scene, all = of.all, key = asked.keys.map, k](int first, int count) {
                        return b.renderer.read_rows(*b.drawn(b.maps, scene, *all, key).map, first, count,
                                                    static_cast<int>(k));
                      }});
  return m;
}

}  // namespace noonmark
