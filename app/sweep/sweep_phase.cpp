#include "app/sweep/sweep_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/digest.h"
#include "base/error.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// Settings that choose a texel size or a constant bias, or that change nothing of an exact map's errors at all
// placements.
bool is_of_the_axes(std::string_view name, const Settings& settings) {
  for (std::string_view axis : {"map.resolution", "map.extent_m", "map.extent_scale", "map.fov_deg", "map.placements",
                                "map.shift_u_texels", "map.shift_v_texels", "map.cube_pass", "bias.constant"})
    if (name == axis) return true;
  if (name.starts_with("truth.")) return true;  // R0 alone, and how the truth is found
  const Bias bias(settings.bias);
  if (name == "map.format") return !bias.polygon_offset();
  if (name != "bias.unit") return false;
  // The unit of other parts is a part of the technique; that of the constant part is only how its amount is written.
  const BiasPart* const constant = &bias_part("constant");
  return std::all_of(bias.compared().begin(), bias.compared().end(),
                     [&](const ActivePart& active) { return active.part == constant; });
}

// "filter.kind = box": the settings of a point that are not those of the diagram; empty if it lies on the diagram.
std::string other_settings(const Settings& point, const Settings& of_diagram) {
  std::string text;
  for (const Setting& row : settings_table())
    if (const std::string value = row.get(point); value != row.get(of_diagram) && !is_of_the_axes(row.name, of_diagram))
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", row.name, value);
  return text;
}

// The picture of the diagram: that of the point, or smaller, because a diagram has the work of many points.
Settings picture_of(const Settings& point, int width_px) {
  Settings settings = point;
  ViewSettings& view = settings.view;
  if (width_px < view.width_px) {
    view.height_px =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(view.height_px) * width_px / view.width_px)));
    view.width_px = width_px;
  }
  return settings;
}

PhaseOptions options_of(const PhasePlan& plan) {
  PhaseOptions options;
  options.rows = plan.request.texel_sizes;
  options.placements = plan.request.placements;
  static_cast<CauseBounds&>(options) = plan;
  return options;
}

// The finest map that a command may ask for, so that each cell of the diagram can be rendered.
constexpr int most_texels = 16384;

// The map of the diagram, and its resolutions: from 90 to 8192, and wider where the points' texels are. Of the extents of
// the points it has the largest that needs no more than most_texels for the finest texel, because what lies outside the
// map is wrong at every texel size and every bias.
struct Range {
  Settings settings;
  int coarsest = 0, finest = 0;
};
Range range_of(const std::vector<Settings>& points, const std::vector<PhasePlace>& places) {
  double fine = places.front().texel_m, coarse = fine;
  for (const PhasePlace& place : places) {
    fine = std::min(fine, place.texel_m);
    coarse = std::max(coarse, place.texel_m);
  }
  const auto width_m = [&](size_t i) { return places[i].texel_m * points[i].map.resolution; };
  std::optional<size_t> widest;
  for (size_t i = 0; i < points.size(); ++i)
    if (width_m(i) <= most_texels * fine * (1 + 1e-9) && (!widest || width_m(i) > width_m(*widest))) widest = i;
  const size_t chosen = widest.value_or(0);
  const auto texels = [&](double texel_m) { return std::clamp(width_m(chosen) / texel_m, 4.0, double{most_texels}); };
  return {points[chosen], std::min(90, static_cast<int>(texels(coarse))),
          std::max(8192, static_cast<int>(std::ceil(texels(fine) * (1 - 1e-9))))};
}

// The end of PhaseDiagram::made_from: everything that the rows depend on, but not the bounds.
std::string measured_text(const Settings& settings, const PhaseOptions& options, const std::string& scene) {
  struct AllMembers : CauseBounds {
    int rows, coarsest, finest, placements, biases_per_octave;
    bool usable_only;  // never: a report shows all rows
  };
  static_assert(sizeof(PhaseOptions) == sizeof(AllMembers), "every member but the bounds must stand in the text");
  std::string text =
      fmt::format("measured\nscene = {}\nrows = {}\ncoarsest = {}\nfinest = {}\nS = {}\nbiases_per_octave = {}\n",
                  scene, options.rows, options.coarsest, options.finest, options.placements, options.biases_per_octave);
  // Each row has its own resolution, and all have the placements of the options.
  for (const auto& [name, value] : settings_map(settings))
    if (name != "map.resolution" && name != "map.placements") text += fmt::format("{} = {}\n", name, value);
  return text;
}

bool can_have_one(const Settings& point, const Scene& scene) {
  try {
    phase_settings(point, scene);
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    return false;
  }
}

// The first point that can have a diagram, of those with the first point's scene; otherwise the first point, for which
// phase_settings() says why.
const Settings& point_of_diagram(const PhasePlan& plan, const Scene& scene) {
  const std::string key = settings_key(plan.points.front(), {Stage::scene});
  const auto found = std::find_if(plan.points.begin(), plan.points.end(), [&](const Settings& point) {
    return settings_key(point, {Stage::scene}) == key && can_have_one(point, scene);
  });
  return found == plan.points.end() ? plan.points.front() : *found;
}

}  // namespace

std::string PhasePlan::name() const {
  return part.empty() ? "the phase diagram" : fmt::format("the phase diagram of part '{}'", part);
}

std::string PhasePlan::made_from() const {
  const auto& [enabled, acne, peter_panning, placements, texel_sizes, width_px] =
      request;  // must name every member, otherwise it does not compile; the bounds are below
  Digest digest;
  digest.text(scene);
  for (const Settings& point : points)
    for (const auto& [name, value] : settings_map(point)) digest.text(name), digest.text(value);
  return fmt::format(
      "placements = {}\ntexel_sizes = {}\nwidth_px = {}\nacne_bound = {}\npeter_panning_bound = {}\npoints = {} from "
      "{}\n",
      placements, texel_sizes, width_px, acne_bound, peter_panning_bound, digest.hex(), first);
}

std::vector<PhasePlan> phase_plans(const Experiment& experiment, std::span<const Settings> points) {
  std::vector<PhasePlan> plans;
  int64_t number = 0, first = 0;
  const auto add = [&](const Experiment& part) {
    const int64_t count = point_count(part);
    if (part.phase.enabled) {
      const auto of_part = points.subspan(static_cast<size_t>(first), static_cast<size_t>(count));
      plans.push_back({{part.phase.acne_bound.value_or(part.curve.acne_bound),
                        part.phase.peter_panning_bound.value_or(part.curve.peter_panning_bound)},
                       number,
                       part.part,
                       part.phase,
                       first,
                       {of_part.begin(), of_part.end()},
                       ""});
    }
    ++number;
    first += count;
  };
  if (experiment.parts.empty()) add(experiment);
  for (const Experiment& part : experiment.parts) add(part);
  return plans;
}

void require_room_for(Workbench& bench, const PhasePlan& plan) {
  const Scene& scene = bench.scene(plan.points.front().scene);
  const Settings& point = point_of_diagram(plan, scene);
  if (!can_have_one(point, scene)) return;
  Settings coarse = picture_of(point, plan.request.width_px);
  coarse.map.resolution = 1;  // no map is drawn, and none is kept
  coarse.map.placements = plan.request.placements;
  require_memory(bench.memory(coarse, false, false), bench.memory_of_program(false), plan.name());
}

PhaseDiagram make_phase(Workbench& bench, const PhasePlan& plan, const std::vector<PhaseDiagram>& earlier,
                        const RowDone& row_done) {
  const Scene& scene = bench.scene(plan.points.front().scene);
  const Settings& chosen = point_of_diagram(plan, scene);
  std::vector<PhasePoint> points;
  std::vector<Settings> members;
  for (size_t i = 0; i < plan.points.size(); ++i) {
    PhasePoint point;
    point.point = plan.first + static_cast<int64_t>(i);
    point.left_out = other_settings(plan.points[i], chosen);
    if (point.left_out.empty()) members.push_back(plan.points[i]);
    points.push_back(std::move(point));
  }
  PhaseDiagram diagram;
  std::string measured;
  try {
    phase_settings(chosen, scene);  // before the points' places, which a point light does not have
    const std::vector<PhasePlace> places = bench.places(picture_of(chosen, plan.request.width_px), members);
    size_t at = 0;
    for (PhasePoint& point : points)
      if (point.left_out.empty()) {
        point.texel_m = places[at].texel_m;
        point.bias_m = places[at++].bias_m;
      }
    const Range range = range_of(members, places);
    const Settings settings = phase_settings(picture_of(range.settings, plan.request.width_px), scene);
    PhaseOptions options = options_of(plan);
    options.coarsest = range.coarsest;
    options.finest = range.finest;
    measured = measured_text(settings, options, plan.scene);
    const auto same = std::find_if(earlier.begin(), earlier.end(), [&](const PhaseDiagram& one) {
      return one.refused.empty() && one.made_from.ends_with(measured);
    });
    diagram = bench.phase(settings, options, same == earlier.end() ? nullptr : &*same, row_done);
    describe_phase(diagram, settings, scene);
    diagram.points = std::move(points);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    diagram = {};
    diagram.refused = error.what();
  }
  diagram.part = plan.part;
  diagram.made_from = plan.made_from() + measured;
  return diagram;
}

}  // namespace noonmark
