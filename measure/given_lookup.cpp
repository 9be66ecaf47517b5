#include "measure/given_lookup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "compare/judge/soundness.h"
#include "compare/ladder/measure.h"
#include "measure/stages.h"
#include "scenes/surfaces.h"

namespace noonmark {
namespace {

// The inverse of MapTile::window_depth.
double depth_m(const LightFrame& frame, double window_depth) {
  const double near = frame.near_m, range = frame.far_m - frame.near_m;
  return frame.uniform() ? near + window_depth * range : frame.far_m * near / (frame.far_m - window_depth * range);
}

// Reorders the values. share: from 0 to 1.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// A unit of the polygon offset of a map of floats is 2^-23 of the power of two below a triangle's largest depth. That of the
// map's middle depth.
double float_step(const MapDepths& exact) {
  std::vector<double> depths(exact.depth.begin(), exact.depth.end());
  int exponent = 0;
  std::frexp(quantile(depths, 0.5), &exponent);
  return std::ldexp(1.0, exponent - 1 - 23);
}

// The metric map_bits, as the format that it stands for.
DepthFormat format_of_bits(double bits) {
  return bits == 16 ? DepthFormat::d16 : bits == 24 ? DepthFormat::d24 : DepthFormat::d32f;
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
};

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
  Climbed climbed = impl_->stages.climb_strips(renderer, lookup, view, truth, shown, technique, nullptr);
  add_rung(climbed.ladder, point.frame);
  GivenClimb made;
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
  std::vector<double> off, depths;
  for (size_t texel = 0; texel < lookup.exact_depth.depth.size(); ++texel) {
    const double exact = depth_m(technique.frame, lookup.exact_depth[texel]);
    depths.push_back(exact);
    off.push_back(std::abs(depth_m(technique.frame, shown.stored[texel]) - exact));
  }
  made.map_off_m = quantile(off, 0.5);
  made.depth_spread_m = quantile(depths, 0.95) - quantile(depths, 0.05);
  // Floats are declared where nothing is, so then the depths themselves say which format they were drawn in.
  const DepthFormat declared = technique.settings.map.format;
  const auto unit_of = [&](DepthFormat format) {
    return format == DepthFormat::d32f ? float_step(lookup.exact_depth) : renderer.polygon_offset_unit(format);
  };
  made.offset = map_offset(point.depth, lookup.exact_depth,
                           declared == DepthFormat::d32f ? format_of_bits(made.metrics.at("map_bits")) : declared);
  made.precision_with_offset = made.metrics.at("precision");
  if (made.offset.in_map()) {
    made.offset_unit = unit_of(made.offset.format);
    made.declared_unit = unit_of(declared);
    // What the declaration would be, looked up in the exact map that it gives.
    Settings with = technique.settings;
    with.map.format = made.offset.format;
    with.bias["polygon_factor"] += made.offset.factor;
    with.bias["polygon_units"] =
        (with.bias["polygon_units"] * made.declared_unit + made.offset.constant) / made.offset_unit;
    const Technique declaring(with, technique.frame);
    const LookupStage again = impl_->stages.prepare_lookup(renderer, impl_->tracer, view, truth, declaring);
    const gl::ShadowMap moved = renderer.upload_map(again.exact_depth, with.map);
    const Image<float> r4 = mixed_results(impl_->stages.look_up(renderer, moved, {&declaring, 1}), nullptr);
    double differ = 0, counted = 0;
    for (size_t i = 0; i < r4.size(); ++i)
      if (is_counted(made.ladder, i)) {
        differ += std::abs(static_cast<double>(made.ladder[Rung::shown][i]) - r4[i]);
        counted += 1;
      }
    made.precision_with_offset = differ / counted;
  }
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
  if (!techniques.front().cascade) return mixed_results(results, nullptr);
  const ChosenCascades chosen = renderer.choose_cascades(techniques.front());
  return mixed_results(results, &chosen);
}

}  // namespace noonmark
