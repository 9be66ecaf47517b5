#include "measure/stages.h"

#include <algorithm>

#include "compare/ladder/moment_climb.h"
#include "compare/ladder/receiver_taps.h"
#include "scenes/camera_fit.h"
#include "scenes/library.h"
#include "scenes/scene_digest.h"
#include "scenes/surfaces.h"
#include "technique/casters.h"

namespace noonmark {
namespace {

double scene_behind(const Scene& scene, const Camera& camera) {
  const glm::dvec3 way = camera.target_m - camera.eye_m;
  const auto behind = std::count_if(scene.positions.begin(), scene.positions.end(), [&](const glm::vec3& p) {
    return glm::dot(glm::dvec3(p) - camera.eye_m, way) <= 0;
  });
  return static_cast<double>(behind) / static_cast<double>(scene.positions.size());
}

// Traces the truth of this strip's taps, which replaces that of another strip.
void bring_taps(gl::Renderer& renderer, LookupStage& lookup, const Technique& technique, PixelRange strip) {
  lookup.taps = {};  // freed before the next is made, because it is large
  if (!lookup.probe.holds(strip)) renderer.probe_strip(lookup.probe, technique, strip);
  lookup.taps = lookup.rays->trace_taps(lookup.probe, strip, lookup.edge_distance_texels, &lookup.tap_stage);
  if (lookup.strips.size() == 1) lookup.rays.reset();  // not needed again
}

LookupEvidence evidence_of(const LookupStage& l, const TruthStage& truth, const ShownStage& shown,
                           const Technique& technique) {
  return {truth.receivers,
          l.probe,
          l.taps,
          l.exact_depth,
          technique.settings.map,
          technique.bias,
          shown.r4,
          shown.r5,
          technique.moments ? &*technique.moments : nullptr};
}

bool is_kept(size_t map_texels) { return map_texels * sizeof(float) <= most_kept_map_bytes; }

// Frees the texture with which a cube is probed if it is large: the map has its size.
void keep_small_index(gl::Renderer& renderer, const LightFrame& frame) {
  const glm::ivec2 size = frame.map_size();
  if (!is_kept(static_cast<size_t>(size.x) * static_cast<size_t>(size.y))) renderer.forget_cube_index();
}

}  // namespace

void keep_small(gl::Renderer& renderer, std::optional<gl::ShadowMap>& map) {
  if (!map) return;
  bool kept = true;
  for (int k = 0; k < map->count(); ++k) kept = kept && is_kept(map->texels(k));
  if (kept) return;
  map.reset();  // its texture may be spare now, for the next map of its size and format
  renderer.release_deleted();
}

std::vector<PixelRange> strips_of(const Technique& technique, size_t kept_bytes) {
  const ViewSettings& view = technique.settings.view;
  const auto width = static_cast<size_t>(view.width_px), height = static_cast<size_t>(view.height_px);
  const size_t row_bytes = width * static_cast<size_t>(technique.taps.taps) * bytes_per_tap(technique.frame.kind);
  const size_t rows = row_bytes * height <= kept_bytes
                          ? height
                          : std::clamp<size_t>(kept_bytes / strips_in_kept_taps / row_bytes, 1, height);
  std::vector<PixelRange> strips;
  for (size_t row = 0; row < height; row += rows) strips.push_back({row * width, std::min(row + rows, height) * width});
  return strips;
}

void each_strip_of(gl::Renderer& renderer, LookupStage& lookup, const TruthStage& truth, const Technique& technique,
                   const EachStrip& each_strip) {
  each_strip_while(renderer, lookup, truth, technique, [&](const LookupEvidence& evidence, PixelRange strip) {
    each_strip(evidence, strip);
    return true;
  });
}

bool each_strip_while(gl::Renderer& renderer, LookupStage& lookup, const TruthStage& truth, const Technique& technique,
                      const WhileStrip& go_on) {
  const ShownStage nothing;
  const LookupEvidence evidence = evidence_of(lookup, truth, nothing, technique);
  bool on = true;
  for (const PixelRange& strip : lookup.strips) {
    if (lookup.rays) bring_taps(renderer, lookup, technique, strip);
    on = go_on(evidence, strip);
    if (!on) break;
  }
  keep_small_index(renderer, technique.frame);
  return on;
}

gl::Renderer::CastersOf casters_of(const Scene& scene, const Technique& technique) {
  if (!technique.moves_casters()) return {};
  return [&scene](const Technique& of) { return caster_positions(scene, of.frame, of.settings.map, of.bias); };
}

double polygon_offset_unit(gl::Renderer& renderer, const Technique& technique) {
  return technique.bias.polygon_offset() ? renderer.polygon_offset_unit(technique.settings.map.format) : 0;
}

SceneStage Pipeline::load_scene(gl::Renderer& renderer, const Settings& settings) {
  auto scene = std::make_unique<Scene>(make_scene(settings.scene));
  auto tracer = std::make_unique<raytrace::Tracer>(*scene, settings.truth.method);
  renderer.load_scene(*scene);
  std::string identity = scene_digest(*scene);
  const uint64_t open_edges = tracer->open_edges();
  std::vector<uint32_t> surfaces = surfaces_of(*scene);
  return {std::move(scene), std::move(identity), std::move(tracer), open_edges, std::move(surfaces)};
}

// Draws again without the parts that can hide surfaces, and only if something could be hidden.
ViewStage Pipeline::take_view(gl::Renderer& renderer, const Scene& scene, const ViewSettings& settings) {
  const Camera camera = effective_camera(scene, settings);
  const int width = settings.width_px, height = settings.height_px;
  const std::vector<uint32_t> unseen = unseen_backs(scene, camera);
  const Image<uint32_t> seen = renderer.render_primitives(camera, width, height, unseen);
  const auto pixels_more = [&](const Image<uint32_t>& more) {
    double count = 0;
    for (size_t i = 0; i < seen.size(); ++i) count += seen[i] == no_primitive && more[i] != no_primitive;
    return count;
  };
  double clipped = 0, culled = 0;
  if (std::find(seen.pixels.begin(), seen.pixels.end(), no_primitive) != seen.pixels.end()) {
    if (!unseen.empty()) culled = pixels_more(renderer.render_primitives(camera, width, height));
    const Camera fitted = with_fitted_depths(scene, camera, width, height);
    if (*camera.near_m > *fitted.near_m || *camera.far_m < *fitted.far_m)
      clipped = pixels_more(renderer.render_primitives(fitted, width, height, unseen));
  }
  return {camera,
          resolve_receivers(scene, camera, seen),
          {{"clipped", clipped}, {"culled", culled}, {"scene_behind", scene_behind(scene, camera)}}};
}

TruthStage Pipeline::trace_truth(const SceneStage& scene, const ViewStage& view, const Technique& technique) {
  TruthStage made;
  made.receivers = scene.tracer->receiver_truth(
      view.receivers, technique.frame,
      {effective_light(*scene.scene, technique.settings), technique.settings.truth.standard_error}, &made.hard,
      &made.soft);
  return made;
}

MapStage Pipeline::draw_maps(gl::Renderer& renderer, const Scene& scene, std::span<const Technique> techniques) {
  MapStage stage;
  stage.map.emplace(renderer.render_maps(techniques, nullptr, casters_of(scene, techniques.front())));
  return stage;
}

LookupStage Pipeline::prepare_lookup(gl::Renderer& renderer, const raytrace::Tracer& tracer, const ViewStage& view,
                                     const TruthStage& truth, const Technique& technique) {
  std::vector<PixelRange> strips = strips_of(technique, kept_bytes_);
  LookupProbe probe = renderer.probe(technique, gl::ProbeTaps::none);
  raytrace::LookupTracer rays = tracer.lookup(view.receivers, truth.receivers, technique.frame, technique.settings.map,
                                              technique.bias, polygon_offset_unit(renderer, technique));
  StageTime texel_stage;
  Image<uint8_t> shown = truth.receivers.facing, compared;
  if (truth.receivers.share.size() != 0) {
    compared = Image<uint8_t>(shown.width, shown.height, 0);
    for (size_t i = 0; i < shown.size(); ++i)
      if (shown[i] && truth.receivers.share[i] == 0) compared[i] = 1, shown[i] = 0;
  }
  for (const PixelRange& strip : strips) {
    renderer.probe_strip(probe, technique, strip);
    rays.ask(shown, probe, strip, &texel_stage);
  }
  const size_t seen_texels = rays.asked_texels();
  if (compared.size() != 0) rays.ask(compared, probe, {0, compared.size()}, &texel_stage);  // of a flat map
  keep_small_index(renderer, technique.frame);
  MapDepths depth = rays.trace_map(&texel_stage);
  const TruthAnswers answers = rays.texel_answers();
  return {.probe = std::move(probe),
          .exact_depth = std::move(depth),
          .strips = std::move(strips),
          .rays = std::move(rays),
          .taps = {},
          .edge_distance_texels = Image<float>(view.receivers.width(), view.receivers.height(), 0),
          .texel_stage = texel_stage,
          .tap_stage = {},
          .texel_answers = answers,
          .seen_texels = seen_texels};
}

MapResults Pipeline::look_up(gl::Renderer& renderer, const gl::ShadowMap& map, std::span<const Technique> techniques) {
  return renderer.lookup_maps(map, techniques);
}

ShownMaps Pipeline::show_maps(gl::Renderer& renderer, MapStage& map, std::optional<gl::ShadowMap>& exact_map,
                              std::span<const AskedMap> asked, std::span<const Technique> techniques,
                              const MapChoice& choice, bool keep_fetched, Checks checks) {
  const bool checked = checks == Checks::all;
  ShownMaps shown;
  shown.checks = checks;
  shown.moments.resize(asked.size());
  shown.ties.resize(asked.size());
  const ShownStage nothing;
  const auto check_stages = [&](const gl::ShadowMap& of, const MapResults& results, const auto& depths_of) {
    const bool kept = keep_fetched && &results == &shown.r5;
    for (size_t k = 0; (checked || kept) && k < asked.size() && techniques[k].moments; ++k) {
      const MapDepths& depths = depths_of(k);
      MomentEvidence moments = renderer.read_moments(of, techniques, *depths.texels, k);
      if (checked)
        shown.moments[k] += check_moments(evidence_of(asked[k].lookup, asked[k].truth, nothing, techniques[k]), depths,
                                          moments, result_in_map(results, choice, static_cast<int>(k)));
      if (kept) shown.fetched.push_back(std::move(moments.fetched));
    }
  };
  shown.r5 = look_up(renderer, *map.map, techniques);
  for (size_t k = 0; k < asked.size(); ++k)
    shown.stored.push_back(renderer.read_map(*map.map, asked[k].lookup.exact_depth.texels, static_cast<int>(k)));
  check_stages(*map.map, shown.r5, [&](size_t k) -> const MapDepths& { return shown.stored[k]; });
  keep_small(renderer, map.map);
  if (!checked && !techniques.front().moments) return shown;

  const auto upload = [&](const auto& depths_of) {
    std::vector<const MapDepths*> depths;
    for (size_t k = 0; k < asked.size(); ++k) depths.push_back(&depths_of(k));
    return renderer.upload_maps(depths, techniques);
  };
  const auto exact_of = [&](size_t k) -> const MapDepths& { return asked[k].lookup.exact_depth; };
  if (!exact_map) exact_map.emplace(upload(exact_of));
  shown.r4 = look_up(renderer, *exact_map, techniques);
  check_stages(*exact_map, shown.r4, exact_of);
  keep_small(renderer, exact_map);
  if (techniques.front().moments || checks == Checks::none) return shown;

  for (size_t k = 0; k < asked.size(); ++k)
    shown.ties[k] = tie_map(evidence_of(asked[k].lookup, asked[k].truth, nothing, techniques[k]));
  std::optional<gl::ShadowMap> tie_map_on_device(upload([&](size_t k) -> const MapDepths& { return shown.ties[k]; }));
  shown.tie_lookup = look_up(renderer, *tie_map_on_device, techniques);
  keep_small(renderer, tie_map_on_device);
  return shown;
}

ShownStage ShownMaps::take(const MapChoice& choice, size_t map) {
  const auto result = [&](const MapResults& of) {
    return of.own.size() ? result_in_map(of, choice, static_cast<int>(map)) : Image<float>();
  };
  return {checks,
          result(r5),
          result(r4),
          result(tie_lookup),
          std::move(stored[map]),
          std::move(ties[map]),
          moments[map],
          fetched.empty() ? Image<glm::vec4>() : std::move(fetched[map])};
}

ShownStage Pipeline::show(gl::Renderer& renderer, MapStage& map, LookupStage& lookup, const TruthStage& truth,
                          const Technique& technique) {
  std::optional<gl::ShadowMap> exact_map;
  const AskedMap asked{lookup, truth};
  ShownMaps shown = show_maps(renderer, map, exact_map, {&asked, 1}, {&technique, 1}, only_map);
  return shown.take(only_map, 0);
}

Climbed Pipeline::climb_strips(gl::Renderer& renderer, LookupStage& lookup, const ViewStage& view,
                               const TruthStage& truth, const ShownStage& shown, const Technique& technique,
                               const BiasPart* varied, const EachStrip& each_strip) {
  const LookupEvidence evidence = evidence_of(lookup, truth, shown, technique);
  std::optional<SoundnessCheck> soundness;
  const bool reads_tan = technique.bias.reads_tan();
  if (shown.checks == Checks::all) {
    const bool compared = lookup.checked_probe && lookup.checked_probe->second == reads_tan;
    soundness.emplace(SoundnessInput{evidence, shown.stored, shown.ties, shown.tie_lookup, view.receivers,
                                     technique.frame, view.camera.eye_m,
                                     compared ? &lookup.checked_probe->first : nullptr});
  }
  const bool has_steps = lookup.kept_steps && !lookup.kept_steps->empty();
  if (lookup.kept_steps && !has_steps) lookup.kept_steps->resize(truth.receivers.facing.size());
  Climbed climbed{empty_ladder(view.receivers.width(), view.receivers.height(),
                               technique.moments ? cause_count : compared_cause_count),
                  {},
                  {},
                  {},
                  {}};
  double below_comparison = 0;
  if (varied) climbed.counts.emplace(lookup.probe, *varied);
  if (lookup.rays) lookup.tap_stage = {};
  for (const PixelRange& strip : lookup.strips) {
    if (has_steps && !soundness) {
      MomentClimb climbing(evidence, strip, climbed.ladder, &*lookup.kept_steps);
      climbing.climb_again(strip);
      climbed.reductions.add(climbing.reductions());
      continue;
    }
    if (lookup.rays) bring_taps(renderer, lookup, technique, strip);
    climbed.tap_answers += lookup.taps.answers;
    const auto judge = [&](auto&... judges) {
      if (soundness)
        read_taps(evidence, strip, judges..., *soundness);
      else
        read_taps(evidence, strip, judges...);
    };
    if (technique.moments) {
      MomentClimb climbing(evidence, strip, climbed.ladder, lookup.kept_steps ? &*lookup.kept_steps : nullptr);
      judge(climbing);
      below_comparison = larger_residual(below_comparison, climbing.below_comparison());
      climbed.reductions.add(climbing.reductions());
      if (each_strip) each_strip(evidence, strip);
      continue;
    }
    Climb climbing(evidence, strip, climbed.ladder);
    if (climbed.counts) {
      BiasCounts::Adding counting(*climbed.counts, evidence, shown.stored);
      judge(climbing, counting);
    } else {
      judge(climbing);
    }
    if (each_strip) each_strip(evidence, strip);
  }
  keep_small_index(renderer, technique.frame);
  if (!soundness) return climbed;
  climbed.soundness = soundness->metrics();
  lookup.checked_probe.emplace(soundness->probe(), reads_tan);
  if (technique.moments) {
    climbed.soundness.merge(moment_contract_metrics(shown.moments));
    if (technique.moments->kind().bound) climbed.soundness["below_comparison"] = below_comparison;
  }
  return climbed;
}

}  // namespace noonmark
