#include "measure/given_lookup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "compare/judge/map_distance.h"
#include "compare/judge/soundness.h"
#include "compare/ladder/measure.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "measure/stages.h"
#include "scenes/surfaces.h"
#include "technique/depth_format.h"

namespace noonmark {
namespace {

// A unit of the polygon offset of a map of floats is 2^-23 of the power of two below a triangle's largest depth. That of the
// middle depth of what the map shows.
double float_step(const MapDepths& exact) {
  std::vector<float> depths = exact.depth;
  std::erase_if(depths, [](float depth) { return depth >= 1; });
  if (depths.empty()) return 0x1p-24;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  int exponent = 0;
  std::frexp(static_cast<double>(*middle), &exponent);
  return std::ldexp(1.0, exponent - 1 - 23);
}

// Of the roundings on the way from a receiver to the depth that is compared, in each of two renderers: a row of the matrix, its
// four products and their sums, the division, the change from clip space, the bias. Each is at most 2^-24 of the lengths in it.
constexpr double roundings = 2 * 8 * 0x1p-24;
// Two samplers whose weights have 8 bits along each of two axes.
constexpr double sampler_step = 2 * 0x1p-8;
// The angle between normals that a file may mean to be the same: it may store them in bytes (KHR_mesh_quantization).
constexpr double normal_step = 1.0 / 127;
// As of the checks of a delivery: with fewer receivers there is too little to go on.
constexpr double enough_receivers = 100;

// Of the handed map, over the texels of the exact one. unmoved: the exact map without the offset that is in `exact`. What the
// offset moves to the end of the map it says nothing of, and that is far off. The technique must outlive the distance.
MapDistance map_distance(const GivenPoint& point, const Technique& technique, const MapDepths& exact,
                         const MapDepths& unmoved) {
  MapDistance apart(technique.frame, technique.settings.map.format);
  for (int y = 0; y < point.depth.height; ++y)
    exact.texels->each_in_row(y, [&](int x, size_t index) {
      const bool says_nothing = exact[index] >= 1 && unmoved.at({x, y}) < 1;
      apart.add({x, y}, exact[index], says_nothing ? MapDepths::unknown : point.depth.at(x, y));
    });
  return apart;
}

// Whether the vertices of a triangle have normals of their own.
bool is_smooth(const Scene& scene, uint32_t triangle) {
  const glm::uvec3 t = scene.triangles[triangle];
  const glm::dvec3 a = scene.positions[t.x],
                   way = glm::cross(glm::dvec3(scene.positions[t.y]) - a, glm::dvec3(scene.positions[t.z]) - a);
  for (int i = 0; i < 3; ++i)
    if (t[i] < scene.vertex_normals.size() &&
        glm::length(glm::cross(glm::dvec3(scene.vertex_normals[t[i]]), way)) > normal_step * glm::length(way))
      return true;
  return false;
}

}  // namespace

struct GivenLookup::Impl {
  Impl(const Scene& of, const raytrace::Tracer& its) : scene(of), tracer(its), surfaces(surfaces_of(of)) {
    renderer.load_scene(scene);
  }
  const Scene& scene;
  const raytrace::Tracer& tracer;
  std::vector<uint32_t> surfaces;
  gl::Renderer renderer{gl::DebugMode::log};
  Pipeline stages;

  void allow_rounding(const GivenPoint& point, GivenClimb& made);
  void explain_by_offset(const GivenPoint& point, const ViewStage& view, const TruthStage& truth,
                         const MapDepths& exact_depth, GivenClimb& made);
};

// Each receiver is looked up at the corners of a box about it, along the light's axes. It is far smaller than a texel, so a tap
// reads at the corners each texel that it reads in the box, with the least and the largest depth that it is compared with.
void GivenLookup::Impl::allow_rounding(const GivenPoint& point, GivenClimb& made) {
  const Ladder& ladder = made.ladder;
  const Technique& technique = point.technique;
  const LightFrame& frame = technique.frame;
  const gl::ShadowMap map = renderer.upload_map(point.depth, technique.settings.map);
  Image<float> least = ladder[Rung::shown], most = least;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 to(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    ReceiverImage moved = point.receivers;
    for (size_t i = 0; i < moved.primitive.size(); ++i) {
      if (!(ladder.flags[i] & flag_facing)) continue;
      const glm::dvec3 at(moved.position[i]), light = frame.to_light(at);
      const double off_m = roundings * (glm::length(at) + glm::length(frame.origin_m) + frame.far_m) +
                           (point.moved_m.size() ? static_cast<double>(point.moved_m[i]) : 0.0);
      const double step_m = depth_step(technique.settings.map.format, 0.5f) / frame.window_depth_slope(light);
      moved.position[i] = glm::vec3(at + to.x * off_m * frame.right + to.y * off_m * frame.up +
                                    to.z * (off_m + step_m) * frame.forward);
    }
    renderer.load_receivers(moved, point.eye_m);
    const Image<float> seen = mixed_results(stages.look_up(renderer, map, {&technique, 1}), only_map);
    for (size_t i = 0; i < seen.size(); ++i) {
      least[i] = std::min(least[i], seen[i]);
      most[i] = std::max(most[i], seen[i]);
    }
  }
  renderer.load_receivers(point.receivers, point.eye_m);
  const bool reads_normal = technique.bias.reads_normal();
  double asked = 0, beyond = 0, left_out = 0;
  for (size_t i = 0; i < least.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    if (reads_normal && is_smooth(scene, point.receivers.primitive[i])) {
      ++left_out;
      continue;
    }
    const double shown = ladder.shown()[i];
    ++asked;
    beyond += shown < least[i] - sampler_step - point.step || shown > most[i] + sampler_step + point.step;
  }
  if (asked >= enough_receivers) made.beyond_rounding = beyond / asked;
  made.interpolated = left_out / (asked + left_out);
}

// What the map holds beside the declared offset, and how far the maps differ if the exact map had it too.
void GivenLookup::Impl::explain_by_offset(const GivenPoint& point, const ViewStage& view, const TruthStage& truth,
                                          const MapDepths& exact_depth, GivenClimb& made) {
  const Technique& technique = point.technique;
  made.precision_with_offset = made.maps_differ;
  // Depths that do not tell their format are taken for floats, and may be of 24 bits all the same: then an offset has one size
  // at all depths.
  std::vector<DepthFormat> formats = {technique.settings.map.format};
  if (formats.front() == DepthFormat::d32f) formats.push_back(DepthFormat::d24);
  for (const DepthFormat format : formats) {
    const MapOffset offset = map_offset(point.depth, exact_depth, format);
    if (format == formats.front()) made.offset = offset;
    if (!offset.in_map()) continue;
    const double unit = format == DepthFormat::d32f ? float_step(exact_depth) : renderer.polygon_offset_unit(format);
    // What the declaration would be, looked up in the exact map that it gives.
    Settings with = technique.settings;
    with.map.format = format;
    with.bias["polygon_factor"] += offset.factor;
    with.bias["polygon_units"] += offset.constant / unit;
    const Technique declaring(with, technique.frame);
    const LookupStage again = stages.prepare_lookup(renderer, tracer, view, truth, declaring);
    if (map_distance(point, declaring, again.exact_depth, exact_depth).excess() > 1) continue;
    const gl::ShadowMap moved = renderer.upload_map(again.exact_depth, with.map);
    const Image<float> r4 = mixed_results(stages.look_up(renderer, moved, {&declaring, 1}), only_map);
    double differ = 0, counted = 0;
    for (size_t i = 0; i < r4.size(); ++i)
      if (is_counted(made.ladder, i)) {
        if (point.missing.size() == 0 || !point.missing[i])
          differ += std::abs(static_cast<double>(made.ladder[Rung::shown][i]) - r4[i]);
        counted += 1;
      }
    if (made.offset_unit != 0 && !(differ / counted < made.precision_with_offset)) continue;
    made.offset = offset, made.offset_unit = unit, made.precision_with_offset = differ / counted;
  }
}

GivenLookup::GivenLookup(const Scene& scene, const raytrace::Tracer& tracer)
    : impl_(std::make_unique<Impl>(scene, tracer)) {}
GivenLookup::~GivenLookup() = default;

GivenClimb GivenLookup::climb(const GivenPoint& point) {
  gl::Renderer& renderer = impl_->renderer;
  const Technique& technique = point.technique;
  ViewStage view{.camera = {}, .receivers = point.receivers, .metrics = {}};
  view.camera.eye_m = point.eye_m;
  TruthStage truth;
  truth.receivers = point.truth;
  renderer.load_receivers(view.receivers, point.eye_m);
  LookupStage lookup = impl_->stages.prepare_lookup(renderer, impl_->tracer, view, truth, technique);
  MapStage map;
  map.map.emplace(renderer.upload_map(point.depth, technique.settings.map));
  const ShownStage shown = impl_->stages.show(renderer, map, lookup, truth, technique);
  Climbed climbed =
      impl_->stages.climb_strips(renderer, lookup, view, truth, shown, technique, curve_part(technique.settings));
  GivenClimb made;
  const MapDistance apart = map_distance(point, technique, lookup.exact_depth, lookup.exact_depth);
  if (climbed.counts) {
    const BiasScale scale = bias_scale(technique.frame, view.receivers, truth.receivers, technique.settings.bias.unit);
    made.curve = summarise(*climbed.counts, scale, {});
    made.depth_per_unit = scale.depth_per_unit;
  }
  made.map_off_m = apart.off_m(), made.depth_spread_m = apart.spread_m();
  made.is_scenes_map = apart.excess() <= 1;
  if (point.missing.size() > 0)
    rebook(climbed.ladder, Cause::precision,
           {std::string(frame_missing), "Missing caster (the frame's map lacks it)",
            std::string(find_metric(frame_missing).help), spare_colors[2], "R5"},
           point.missing);
  if (!made.is_scenes_map)
    rebook(climbed.ladder, Cause::precision,
           {std::string(frame_map), "Map (it is not the scene's)", std::string(find_metric(frame_map).help),
            spare_colors[1], "R5"});
  add_rung(climbed.ladder, point.frame);
  made.ladder = std::move(climbed.ladder);
  const Image<float> occluders =
      impl_->tracer.occluder_distance(view.receivers, technique.frame, peter_panning_mask(made.ladder));
  made.metrics = measure_ladder({made.ladder,
                                 view.receivers,
                                 {{technique.frame, lookup.probe, technique.bias, lookup.edge_distance_texels}},
                                 occluders,
                                 technique.moves_casters(),
                                 impl_->surfaces});
  made.metrics.insert(climbed.soundness.begin(), climbed.soundness.end());
  made.maps_differ = made.metrics.at(made.is_scenes_map ? "precision" : std::string(frame_map));
  made.metrics["map_excess"] = 0;  // another renderer's map, whatever it holds, is no contradiction
  impl_->allow_rounding(point, made);
  impl_->explain_by_offset(point, view, truth, lookup.exact_depth, made);
  PointRecord record;
  record.metrics = made.metrics;
  if (const std::vector<Unsound> unsound = find_unsound({&record, 1}); !unsound.empty())
    throw Error(ErrorKind::defect,
                fmt::format("the lookup of the given map contradicts itself ({})", value_text(unsound.front())));
  return made;
}

Image<float> GivenLookup::visibility(const ReceiverImage& receivers, glm::dvec3 eye_m,
                                     std::span<const Technique> techniques) {
  gl::Renderer& renderer = impl_->renderer;
  renderer.load_receivers(receivers, eye_m);
  const MapStage map = impl_->stages.draw_maps(renderer, impl_->scene, techniques);
  const MapResults results = impl_->stages.look_up(renderer, *map.map, techniques);
  return mixed_results(results, renderer.choose_maps(techniques.front()));
}

namespace {

// Rasterisers move vertices to a grid of 1/16 of a texel or finer along each axis. The slope along each is at most m.
constexpr double most_moved_by_grid = 2.0 / 16;
// The rows of a renderer's matrix are right to some 1e-6 (frames/map_frame.cpp).
constexpr double matrix_error = 1e-6;
// As of the other checks of a delivery: with fewer there is too little to go on.
constexpr size_t enough = 100;

double step_of(DepthFormat format) { return format == DepthFormat::d16 ? 1.0 / 65535 : 0x1p-24; }

// The steepest slope of the plane that the map shows about a texel, in depth per texel. Empty at the map's border, where the
// map is empty, and where the slopes on both sides of the texel are those of two surfaces: they differ by more than `rounding`,
// and by more than the grid's share of them.
std::optional<double> slope_at(const Image<float>& map, glm::ivec2 t, double rounding) {
  if (t.x < 1 || t.y < 1 || t.x + 1 >= map.width || t.y + 1 >= map.height) return std::nullopt;
  const double here = map.at(t.x, t.y);
  const auto along = [&](double before, double after) -> std::optional<double> {
    if (before >= 1 || after >= 1) return std::nullopt;
    const double middle = std::abs(after - before) / 2;
    if (std::abs(before + after - 2 * here) > 4 * rounding + most_moved_by_grid * middle) return std::nullopt;
    return middle;
  };
  if (here >= 1) return std::nullopt;
  const auto x = along(map.at(t.x - 1, t.y), map.at(t.x + 1, t.y)),
             y = along(map.at(t.x, t.y - 1), map.at(t.x, t.y + 1));
  if (!x || !y) return std::nullopt;
  return std::max(*x, *y);
}

struct Texel {
  double slope, off, least;  // least: what moves it without an offset
};

// A rasteriser's grid moves each triangle by itself, by a share of its own slope. Texels of one slope are mostly those of one
// surface, which has a difference from the line of its own. The line turns about the slope that has most texels, to
// meet these: how far its height at m = 0 moves then. With two slopes every line meets both, so the grid's most is taken.
double unsure_constant(std::vector<Texel> texels, const MapOffset& line) {
  constexpr size_t enough_of_slope = 20;
  constexpr double apart = 0.25;  // of the larger slope; nearer ones tell little of how the line turns
  std::sort(texels.begin(), texels.end(), [](const Texel& a, const Texel& b) { return a.slope < b.slope; });
  struct Surface {
    double slope, off;  // medians; off: from the line
    size_t texels;
  };
  std::vector<Surface> surfaces;
  for (size_t first = 0, end = 0; first < texels.size(); first = end) {
    while (end < texels.size() && texels[end].slope <= (1 + apart / 2) * texels[first].slope + step_of(line.format))
      ++end;
    if (end - first < enough_of_slope) continue;
    std::vector<double> off;
    for (size_t i = first; i < end; ++i)
      off.push_back(std::abs(texels[i].off - line.factor * texels[i].slope - line.constant));
    const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
    std::nth_element(off.begin(), middle, off.end());
    surfaces.push_back({texels[(first + end) / 2].slope, *middle, end - first});
  }
  const auto most = std::max_element(surfaces.begin(), surfaces.end(),
                                     [](const Surface& a, const Surface& b) { return a.texels < b.texels; });
  if (most == surfaces.end()) return 0;
  size_t others = 0;
  double unsure = 0;
  for (const Surface& one : surfaces) {
    const double between = std::abs(one.slope - most->slope);
    if (between < apart * std::max(one.slope, most->slope)) continue;
    ++others;
    unsure = std::max(unsure, one.off * most->slope / between);
  }
  return others < 2 ? most_moved_by_grid * most->slope : unsure;
}

}  // namespace

bool MapOffset::in_map() const {
  return texels >= enough &&
         (std::abs(factor) > most_moved_by_grid || std::abs(constant) > step_of(format) + matrix_error + unsure);
}

MapOffset map_offset(const Image<float>& given, const MapDepths& exact, DepthFormat format) {
  MapOffset found{.format = format};
  std::vector<Texel> texels;
  const double step = step_of(found.format);
  for (int y = 0; y < given.height; ++y)
    exact.texels->each_in_row(y, [&](int x, size_t index) {
      const auto slope = slope_at(given, {x, y}, step);
      if (slope && exact[index] < 1)
        texels.push_back(
            {*slope, static_cast<double>(given.at(x, y)) - exact[index], step + most_moved_by_grid * *slope});
    });
  found.texels = texels.size();
  if (found.texels < enough) return found;
  // Iteratively reweighted least squares. A difference below what moves a texel anyway has no more weight than one of that size.
  for (int round = 0; round < 50; ++round) {
    double n = 0, sm = 0, smm = 0, sd = 0, smd = 0;
    for (const Texel& t : texels) {
      const double off = std::abs(t.off - found.factor * t.slope - found.constant) / t.least;
      const double weight = 1 / (std::max(off, 1.0) * t.least * t.least);
      n += weight, sm += weight * t.slope, smm += weight * t.slope * t.slope;
      sd += weight * t.off, smd += weight * t.slope * t.off;
    }
    const double apart = n * smm - sm * sm;
    // Where all slopes are within a step of each other, factor and constant cannot be told, and the constant is all of the
    // offset.
    const bool told = apart > n * n * step * step;
    const double factor = told ? (n * smd - sm * sd) / apart : 0, constant = (sd - factor * sm) / n;
    const bool settled = std::abs(factor - found.factor) < 1e-6 && std::abs(constant - found.constant) < step * 1e-3;
    found.factor = factor, found.constant = constant;
    if (settled) break;
  }
  found.unsure = unsure_constant(std::move(texels), found);
  return found;
}

}  // namespace noonmark
