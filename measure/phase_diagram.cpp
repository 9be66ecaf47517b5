#include "measure/phase_diagram.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/shell_words.h"
#include "compare/judge/undecided.h"
#include "compare/ladder/law_bias.h"
#include "measure/placement_stage.h"
#include "technique/casters.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// P(p U1 + q U2 > c) for U1, U2 uniform in (-1/2, 1/2): the tail of a trapezoid.
double trapezoid_tail(double p, double q, double c) {
  if (p < q) std::swap(p, q);
  const double outer = (p + q) / 2, inner = (p - q) / 2;
  if (c >= outer) return 0;
  if (c <= -outer) return 1;
  if (c > inner) return (outer - c) * (outer - c) / (2 * p * q);
  if (c < -inner) return 1 - (outer + c) * (outer + c) / (2 * p * q);
  return 0.5 - c / p;
}

// A lit receiver's plane: metres of depth for a step of one texel's width along each axis of the texels.
struct LitPlane {
  glm::dvec2 slope;
  int variant = 0;
};

struct Planes {
  std::vector<LitPlane> lit;
  double counted = 0;
};

Planes planes_of(const LightFrame& frame, const ViewStage& view, const ReceiverTruth& truth,
                 const TapPattern& pattern) {
  Planes planes;
  for (size_t i = 0; i < truth.facing.size(); ++i) {
    if (!truth.facing[i] || truth.ambiguous[i]) continue;
    ++planes.counted;
    if (!truth.lit[i]) continue;
    const glm::dvec3 light = frame.to_light(view.receivers.position[i]);
    const glm::dvec2 per_texel = depth_gradient(frame, view.receivers.position[i], view.receivers.normal[i]);
    planes.lit.push_back({per_texel / (frame.window_depth_slope(light) * frame.texel_m(light)),
                          tap_variant(static_cast<uint32_t>(i), pattern.variants)});
  }
  return planes;
}

// The mean acne of all lit planes at a bias of c texels, over all placements: the texel's centre lies anywhere within
// half a texel of the tap, and the tap is dark if the plane rises by more than the bias up to there.
double acne_of(const Planes& planes, const TapPattern& pattern, double c) {
  const double dark = tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, planes.lit.size(), 4096), 0.0,
      [&](const tbb::blocked_range<size_t>& range, double sum) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
          const LitPlane& plane = planes.lit[i];
          for (int t = 0; t < pattern.taps; ++t)
            sum += trapezoid_tail(std::abs(plane.slope.x), std::abs(plane.slope.y),
                                  c + glm::dot(plane.slope, glm::dvec2(pattern.offset(plane.variant, t))));
        }
        return sum;
      },
      std::plus<>());
  return dark / (planes.counted * pattern.taps);
}

bool has_law(const Technique& technique) {
  const Bias& bias = technique.bias;
  return !bias.reference().plane && !bias.moves_lookup() && !technique.moves_casters() && !bias.polygon_offset() &&
         bias.compared().size() <= 1 && !technique.taps.bilinear();
}

void add_law(PhaseDiagram& diagram, const ViewStage& view, const TruthStage& truth, const Technique& technique) {
  diagram.law_at_bound = diagram.law_steepest = std::numeric_limits<double>::quiet_NaN();
  if (!has_law(technique)) return;
  const TapPattern& pattern = technique.taps;
  const Planes planes = planes_of(technique.frame, view, truth.receivers, pattern);
  if (planes.lit.empty()) return;
  double steepest = 0;
  for (const LitPlane& plane : planes.lit)
    for (int t = 0; t < pattern.taps; ++t)
      steepest = std::max(steepest, (std::abs(plane.slope.x) + std::abs(plane.slope.y)) / 2 -
                                        glm::dot(plane.slope, glm::dvec2(pattern.offset(plane.variant, t))));
  diagram.law_steepest = steepest;
  double low = 0, high = steepest;
  if (!(acne_of(planes, pattern, low) > diagram.acne_bound)) return;
  for (int halving = 0; halving < 40; ++halving)
    (acne_of(planes, pattern, (low + high) / 2) > diagram.acne_bound ? low : high) = (low + high) / 2;
  diagram.law_at_bound = high;
}

double median_texel_m(const LightFrame& frame, const ViewStage& view, const ReceiverTruth& truth) {
  std::vector<double> sizes;
  for (size_t i = 0; i < truth.facing.size(); ++i)
    if (truth.facing[i] && !truth.ambiguous[i])
      sizes.push_back(frame.texel_m(frame.to_light(view.receivers.position[i])));
  if (sizes.empty()) return frame.texel_m({0, 0, 1});
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

// Mean |R2 - R1|: the filter's blur, which depends on the texel size but on no bias.
double filter_share(const LookupProbe& probe, const TapTruth& taps, const ReceiverTruth& truth, PixelRange strip) {
  double sum = 0;
  for (size_t i = strip.first; i < strip.end; ++i) {
    if (!truth.facing[i] || truth.ambiguous[i]) continue;
    double lit = 0;
    for (int t = 0; t < probe.taps(); ++t)
      if (taps.bits(i, t) & tap_exact_lit) lit += probe.weight(i, t);
    sum += std::abs(lit - truth.lit[i]);
  }
  return sum;
}

PhaseRow row_of(const PlacementCounts& counts, size_t biases, double filter) {
  PhaseRow row;
  const int placements = counts.placements().count();
  const double whole = counts.taps();
  const auto over = [&](const auto& of, std::vector<double>& mean, std::vector<double>* worst) {
    for (size_t i = 0; i < biases; ++i) {
      double sum = 0, largest = 0;
      for (int p = 0; p < placements; ++p) {
        const double share = of(p, i) / whole;
        sum += share;
        largest = std::max(largest, share);
      }
      mean.push_back(sum / placements);
      if (worst) worst->push_back(largest);
    }
  };
  const auto caused = [&](Cause cause) {
    return [&counts, cause](int p, size_t i) { return counts.caused(cause, p, i); };
  };
  const auto both = [&](Cause a, Cause b) {
    return [&counts, a, b](int p, size_t i) { return counts.caused(a, p, i) + counts.caused(b, p, i); };
  };
  over([&](int p, size_t i) { return counts.wrong_taps(p, i); }, row.error, &row.error_worst);
  over(caused(Cause::acne), row.acne, &row.acne_worst);
  over(caused(Cause::peter_panning), row.peter_panning, &row.peter_panning_worst);
  over(both(Cause::aliasing_dark, Cause::aliasing_light), row.aliasing, nullptr);
  over(both(Cause::coverage_dark, Cause::coverage_light), row.coverage, nullptr);
  over(caused(Cause::undecided), row.undecided, nullptr);
  row.filter.assign(biases, filter);
  return row;
}

// The settings of a point of the diagram, as the words of a command; without texel size and bias.
std::string render_command(const Settings& settings) {
  const Settings defaults;
  std::string command = "noonmark render";
  for (const Setting& row : settings_table()) {
    const std::string value = row.get(settings);
    if (row.name == "map.resolution" || row.name == "bias.constant" || value == row.get(defaults)) continue;
    command += " --set " + shell_quoted(std::string(row.name) + "=" + value);
  }
  return command;
}

std::string technique_text(const Settings& settings) {
  std::string text = "constant bias in metres";
  const Settings defaults;
  for (const Setting& row : settings_table()) {
    const bool of_technique =
        row.name.starts_with("filter.") || row.name.starts_with("bias.") || row.name.starts_with("map.");
    if (!of_technique || row.name == "bias.unit" || row.name == "map.resolution" || row.name == "map.placements")
      continue;
    if (const std::string value = row.get(settings); value != row.get(defaults))
      text += fmt::format(", {} = {}", row.name, value);
  }
  return text;
}

// Throws Error(usage) if more receivers are ambiguous than one of the bounds lets be wrong.
void require_known(const ReceiverTruth& truth) {
  PointRecord record;
  double& facing = record.metrics["facing"];
  double& ambiguous = record.metrics["ambiguous"];
  for (size_t i = 0; i < truth.facing.size(); ++i) {
    facing += truth.facing[i];
    ambiguous += truth.facing[i] && truth.ambiguous[i];
  }
  ambiguous /= facing;
  if (hides_bounds(record))
    throw Error(ErrorKind::usage,
                fmt::format("it is not known which texels and biases are usable: {}", ambiguous_note(record)));
}

}  // namespace

Settings phase_settings(const Settings& given, const Scene& scene) {
  require_one_map(given, "a phase diagram");
  require_compared(given, "a phase diagram");
  Settings settings = given;
  const LightKind light = effective_light(scene, settings).kind;
  if (!kind_of_light(light).placements_form_lattice())
    throw Error(
        ErrorKind::usage,
        "a phase diagram needs a map whose grid of texels can be shifted, so that one set of rays answers for all "
        "placements; the placements of a point light's cube are turns, which share no texel, so set light.kind "
        "to directional or spot");
  const Bias bias(settings.bias);
  const BiasPart* constant = &bias_part("constant");
  const bool others = std::any_of(bias.compared().begin(), bias.compared().end(),
                                  [&](const ActivePart& active) { return active.part != constant; });
  if (!others) settings.bias.unit = BiasUnit::m;
  if (settings.bias.unit != BiasUnit::m)
    throw Error(
        ErrorKind::usage,
        "a phase diagram has its biases in metres; set bias.unit = m, and the other parts of the bias in metres");
  settings.bias["constant"] = 0;
  return settings;
}

PhaseDiagram measure_phase(gl::Renderer& renderer, const raytrace::Tracer& tracer, const Scene& scene,
                           const ViewStage& view, const TruthStage& truth, const Settings& given,
                           const PhaseOptions& options, const RowDone& row_done) {
  require_known(truth.receivers);
  PhaseDiagram diagram;
  diagram.width_px = view.receivers.width();
  diagram.height_px = view.receivers.height();
  diagram.placements = options.placements;
  static_cast<CauseBounds&>(diagram) = options;
  Settings settings = given;
  settings.map.placements = options.placements;
  const double steps = std::max(1, options.rows - 1);
  const auto resolution_of = [&](int row) {
    return static_cast<int>(
        std::lround(options.coarsest * std::pow(static_cast<double>(options.finest) / options.coarsest, row / steps)));
  };
  settings.map.resolution = resolution_of(options.rows - 1);
  const LightFrame finest = make_light_frame(scene, settings);
  diagram.range_m = finest.far_m - finest.near_m;
  // From a twentieth of the finest texel, below which acne hardly changes, to the map's whole range.
  const double least = median_texel_m(finest, view, truth.receivers) / 20;
  std::vector<float> edges;
  for (int k = 0;; ++k) {
    const double bias = least * std::exp2(static_cast<double>(k) / options.biases_per_octave);
    if (bias > diagram.range_m) break;
    edges.push_back(static_cast<float>(bias));
    diagram.bias_m.push_back(edges.back());
  }

  for (int k = 0; k < options.rows; ++k) {
    const int r = options.usable_only ? options.rows - 1 - k : k;
    settings.map.resolution = resolution_of(r);
    const Technique technique(scene, settings);
    const LookupProbe probe = renderer.probe(technique, gl::ProbeTaps::none);
    raytrace::LookupTracer rays = tracer.lookup(view.receivers, truth.receivers, technique.frame, settings.map,
                                                technique.bias, polygon_offset_unit(renderer, technique));
    LatticeStage stage(renderer, tracer, probe, view, truth, technique, {&bias_part("constant"), edges, {}});
    double blurred = 0;
    for (const PixelRange& strip : strips_of(technique, most_kept_tap_bytes)) {
      const TapTruth taps = rays.trace_places(probe, strip);
      stage.add(taps, strip);
      blurred += filter_share(probe, taps, truth.receivers, strip);
    }
    const PlacementCounts& counts = *stage.counts();
    if (counts.receivers() == 0)
      throw Error(ErrorKind::usage,
                  "no pixel of this view can be judged: none sees a surface that faces the light; "
                  "set the view (view.eye_m, view.target_m) or the light");
    PhaseRow row = row_of(counts, edges.size(), blurred / static_cast<double>(counts.receivers()));
    row.resolution = settings.map.resolution;
    row.texel_m = median_texel_m(technique.frame, view, truth.receivers);
    row.last_acne_m = counts.acne_free_from();
    diagram.rows.push_back(std::move(row));
    diagram.receivers = static_cast<double>(counts.receivers());
    if (r == 0 && !options.usable_only) add_law(diagram, view, truth, technique);
    row_done(k + 1);
    if (options.usable_only && diagram.usable(diagram.rows.back()).empty()) break;
  }
  if (options.usable_only) std::reverse(diagram.rows.begin(), diagram.rows.end());
  return diagram;
}

PhaseDiagram rejudged_phase(const PhaseDiagram& measured, const Scene& scene, const ViewStage& view,
                            const TruthStage& truth, const Settings& given, const PhaseOptions& options) {
  require_known(truth.receivers);
  PhaseDiagram diagram = measured;
  static_cast<CauseBounds&>(diagram) = options;
  Settings settings = given;
  settings.map.placements = options.placements;
  settings.map.resolution = diagram.rows.front().resolution;
  add_law(diagram, view, truth, Technique(scene, settings));
  return diagram;
}

void describe_phase(PhaseDiagram& diagram, const Settings& settings, const Scene& scene) {
  diagram.scene = scene.name;
  diagram.light = kind_of_light(effective_light(scene, settings).kind).name();
  diagram.technique = technique_text(settings);
  diagram.render = render_command(settings);
}

PhasePlace phase_place(const Scene& scene, const ViewStage& view, const TruthStage& truth, const Settings& settings) {
  const LightFrame frame = make_light_frame(scene, settings);
  const BiasScale scale = bias_scale(frame, view.receivers, truth.receivers, settings.bias.unit);
  return {median_texel_m(frame, view, truth.receivers),
          settings.bias["constant"] * scale.depth_per_unit * scale.m_per_depth};
}

}  // namespace noonmark
