#include "compare/ladder/measure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "compare/ladder/numbers.h"
#include "compare/ladder/shadow_edges.h"
#include "compare/ladder/step_blocks.h"
#include "compare/ladder/wrong_patch.h"

namespace noonmark {
namespace {

// Whether the receiver lies in a gap, a lit strip between an occluder and its shadow: Peter Panning where the truth is
// dark. With a filter, a receiver that is itself lit can have a tap with Peter Panning too. Such a receiver has no
// occluder and so no distance to it.
bool in_gap(const Ladder& ladder, size_t i) {
  // A lookup that compares no depths lifts nearly all of a shadow a little; a gap is where it looks lit.
  const float lifted = ladder[Cause::peter_panning][i];
  return is_counted(ladder, i) && (ladder.of_comparisons() ? lifted != 0 : lifted >= 0.5f) && ladder.truth()[i] == 0;
}

// The gap along a receiver that lies in one: the light's way from P to the occluder, projected onto the surface. An
// occluder that is farther away than the bias can reach makes no gap. At the edge of its shadow a steep receiver can
// still be lit, because its depth changes by as much within the taps (law 1).
double gap_m(const MeasureInput& in, size_t i) {
  const LookedUpMap& map = in.map_of(i);
  const double cosine = std::clamp(static_cast<double>(map.probe.n_dot_l[i]), 0.0, 1.0);
  const double reach = panning_reach_m(in, i, map.frame.to_light(in.receivers.position[i]));
  const double distance = in.occluder_distance_m[i];
  // A dark receiver without an occluder is a contradiction. It makes the metric not finite, so it is noticed.
  return distance > reach && std::isfinite(distance) ? 0 : distance * std::sqrt(1 - cosine * cosine);
}

bool is_aliased(const Ladder& ladder, size_t i) {
  return ladder[Cause::aliasing_dark][i] != 0 || ladder[Cause::aliasing_light][i] != 0;
}

// Converts a bias in window depth to metres of the map's depth measure, before `depth_m`.
double bias_m(const MapTile& tile, double bias, double depth_m) {
  return depth_m - tile.depth_of_window(tile.window_depth(depth_m) - bias);
}

}  // namespace

double panning_reach_m(const MeasureInput& in, size_t i, glm::dvec3 light) {
  const auto& [frame, probe, bias, edge_distance] = in.map_of(i);
  // A variance floor has no such reach.
  if (bias.polygon_offset() || in.casters_moved || !in.ladder.of_comparisons())
    return std::numeric_limits<double>::infinity();
  const double cosine = std::clamp(static_cast<double>(probe.n_dot_l[i]), 0.0, 1.0);
  const MapTile tile = frame.tile_at(light);
  const double w = tile.texel_m(light);
  // How far from P, across its ray, the centre of a tap's texel can lie. Flat map: texels along both axes. Cube map:
  // metres of the world, and half a texel's diagonal.
  double across = probe.pattern.reach_texels() * w * std::numbers::sqrt2;
  if (probe.pattern.in_world) {
    across = w * std::numbers::sqrt2 / 2;
    double longest = 0;
    for (int t = 0; t < probe.taps(); ++t)
      longest = std::max(longest, static_cast<double>(glm::length(probe.offset(i, t))));
    across += longest;
  }
  // The offset along the normal. Along the light it reaches offset / cosine.
  const glm::dvec3 normal(in.receivers.normal[i]);
  const double offset = glm::dot(bias.moved_m(frame, in.receivers.position[i], normal), normal);
  const double depth = tile.depth_m(light), distance = glm::length(light);
  const LightRays rays = frame.light().rays();
  const double along_ray = rays.start_at_light() ? distance / depth : 1;  // metres of the ray for a metre of depth
  return bias_m(tile, bias.at(probe, i), depth) * along_ray + rays.rise_m(across, cosine, distance) + offset / cosine;
}

Image<uint8_t> peter_panning_mask(const Ladder& ladder) {
  Image<uint8_t> mask(ladder.flags.width, ladder.flags.height);
  for (size_t i = 0; i < mask.size(); ++i) mask[i] = in_gap(ladder, i);
  return mask;
}

double error_of(const Ladder& ladder) {
  double error = 0, counted = 0;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    error += std::abs(static_cast<double>(ladder.shown()[i]) - ladder.truth()[i]);
    ++counted;
  }
  return counted == 0 ? std::numeric_limits<double>::quiet_NaN() : error / counted;
}

std::vector<double> parts_of_error(const Ladder& ladder) {
  std::vector<double> parts(ladder.causes.size());
  double counted = 0;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    ++counted;
    const double error = static_cast<double>(ladder.shown()[i]) - ladder.soft_truth()[i];
    if (error == 0) continue;
    for (size_t c = 0; c < parts.size(); ++c) parts[c] += std::copysign(1.0, error) * ladder.causes[c].step[i];
  }
  for (double& part : parts) part /= counted;
  return parts;
}

std::map<std::string, double> measure_ladder(const MeasureInput& in) {
  const Ladder& ladder = in.ladder;
  uint64_t receivers = 0, facing = 0, base = 0, lit = 0, outside = 0, wrong = 0, aliased = 0, undecided = 0;
  double doubt = 0, error_soft = 0, aliasing_squares = 0, panning_lit = 0, gap = 0, edge_max = 0, edge_sum = 0;
  std::vector<double> size(ladder.causes.size()), largest(size.size());
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    receivers += in.receivers.primitive[i] != no_primitive;
    if (!(ladder.flags[i] & flag_facing)) continue;
    ++facing;
    if (ladder.flags[i] & flag_ambiguous) continue;
    ++base;
    lit += ladder.truth()[i] != 0;
    outside += (ladder.flags[i] & flag_outside) != 0;
    undecided += (ladder.flags[i] & flag_undecided) != 0;
    doubt += ladder.doubt[i];
    const double hard = static_cast<double>(ladder.shown()[i]) - ladder.truth()[i];
    error_soft += std::abs(static_cast<double>(ladder.shown()[i]) - ladder.soft_truth()[i]);
    wrong += hard != 0;
  }

  const StepBlocks steps(ladder);
  for (size_t c = 0; c < size.size(); ++c)
    steps.each(c, [&](size_t i) {
      if (!is_counted(ladder, i)) return;
      const double step = std::abs(static_cast<double>(ladder.causes[c].step[i]));
      size[c] += step;
      raise(largest[c], step);
    });
  steps.each(static_cast<size_t>(Cause::peter_panning), [&](size_t i) {
    if (!is_counted(ladder, i)) return;
    if (ladder.truth()[i] != 0) panning_lit += std::abs(static_cast<double>(ladder[Cause::peter_panning][i]));
    if (in_gap(ladder, i)) raise(gap, gap_m(in, i));
  });
  for (size_t block = 0; block < steps.blocks(); ++block) {
    if (!steps.any(block, static_cast<size_t>(Cause::aliasing_dark)) &&
        !steps.any(block, static_cast<size_t>(Cause::aliasing_light)))
      continue;
    for (size_t i = steps.first(block); i < steps.end(block); ++i) {
      if (!is_counted(ladder, i) || !is_aliased(ladder, i)) continue;
      const double aliasing = static_cast<double>(ladder[Cause::aliasing_dark][i]) + ladder[Cause::aliasing_light][i];
      aliasing_squares += aliasing * aliasing;
      ++aliased;
      const float distance = in.map_of(i).edge_distance_texels[i];
      raise(edge_max, distance);
      edge_sum += distance;
    }
  }

  const EdgeDisplacements edges = edge_displacements(ladder, in.receivers, in.surfaces);
  // Without a counted receiver nothing was measured, and no metric may look like a perfect result.
  const auto measured = [&](double value) { return base == 0 ? std::numeric_limits<double>::quiet_NaN() : value; };
  const auto share = [&](double sum) { return measured(sum / static_cast<double>(base)); };
  std::map<std::string, double> metrics = {
      {"error", error_of(ladder)},
      {"error_soft", share(error_soft)},
      {"wrong", share(static_cast<double>(wrong))},
      {"wrong_patch", measured(largest_wrong_patch(ladder) / static_cast<double>(ladder.flags.size()))},
      {"aliasing_rms", std::sqrt(share(aliasing_squares))},
      {"peter_panning_lit", share(panning_lit)},
      {"undecided_taps", share(doubt)},
      {"peter_panning_gap_m", measured(gap)},
      {"edge_displacement_texels", measured(edge_max)},
      {"edge_displacement_mean_texels", measured(aliased == 0 ? 0 : edge_sum / static_cast<double>(aliased))},
      {"edge_displacement_pixels", measured(edges.largest)},
      {"edge_displacement_mean_pixels", measured(edges.mean)},
      {"edge_displacement_p95_pixels", measured(edges.p95)},
      {"receivers", static_cast<double>(receivers)},
      {"facing", static_cast<double>(facing)},
      {"counted", static_cast<double>(base)},
      {"attached", static_cast<double>(receivers - facing)},
      {"lit", share(static_cast<double>(lit))},
      {"ambiguous", facing == 0 ? std::numeric_limits<double>::quiet_NaN()
                                : static_cast<double>(facing - base) / static_cast<double>(facing)},
      {"outside", share(static_cast<double>(outside))},
      {"ambiguous_receivers", static_cast<double>(facing - base)},
      {"outside_receivers", static_cast<double>(outside)},
      {"undecided_receivers", static_cast<double>(undecided)},
      {"residual", ladder.residual},
      {"tap_residual", ladder.tap_residual},
  };
  for (const CauseRow& row : cause_rows)
    if (ladder.books(row))
      metrics.emplace(row.name, sum_of(row, [&](Cause cause) { return share(size[static_cast<size_t>(cause)]); }));
  for (const Cause cause : {Cause::leak, Cause::over_darkening})
    if (ladder.books(*find_cause(cause)))
      metrics[std::string(cause_name(cause)) + "_largest"] = measured(largest[static_cast<size_t>(cause)]);
  for (size_t c = ladder.built_in(); c < size.size(); ++c) metrics[ladder.causes[c].name] = share(size[c]);
  return metrics;
}

PointRecord::Worst worst_pixel(const Ladder& ladder) {
  PointRecord::Worst worst;
  for (int y = 0; y < ladder.flags.height; ++y) {
    for (int x = 0; x < ladder.flags.width; ++x) {
      const size_t i = ladder.flags.index(x, y);
      if (!is_counted(ladder, i)) continue;
      const double error = std::abs(static_cast<double>(ladder.shown()[i]) - ladder.truth()[i]);
      if (worst.x < 0 || !(error <= worst.error)) {
        worst = {x, y, error, std::string(ladder.cause_of(i))};
        if (std::isnan(error)) return worst;
      }
    }
  }
  return worst;
}

std::vector<PointRecord::WorstOf> worst_pixels(const MeasureInput& in) {
  const Ladder& ladder = in.ladder;
  using PartOfPixel = std::function<double(size_t)>;
  std::vector<std::pair<PointRecord::WorstOf, PartOfPixel>> all;
  const auto add = [&](const std::string& metric, PartOfPixel part) {
    all.push_back({{metric, -1, -1, 0}, std::move(part)});
  };
  const auto step = [&](Cause cause, size_t i) { return std::abs(static_cast<double>(ladder[cause][i])); };
  const auto soft = [&](size_t i) { return std::abs(static_cast<double>(ladder.shown()[i]) - ladder.soft_truth()[i]); };
  for (size_t c = 1; c < ladder.causes.size(); ++c)
    add(ladder.causes[c].name,
        [&image = ladder.causes[c].step](size_t i) { return std::abs(static_cast<double>(image[i])); });
  add("error_soft", soft);
  for (const CauseRow& row : cause_rows)
    if (!row.cause)
      add(std::string(row.name), [&](size_t i) { return sum_of(row, [&](Cause cause) { return step(cause, i); }); });
  add("peter_panning_lit", [&](size_t i) { return ladder.truth()[i] != 0 ? step(Cause::peter_panning, i) : 0; });
  add("undecided_taps", [&](size_t i) { return static_cast<double>(ladder.doubt[i]); });
  add("peter_panning_gap_m", [&](size_t i) { return in_gap(ladder, i) ? gap_m(in, i) : 0; });
  add("edge_displacement_texels",
      [&](size_t i) { return is_aliased(ladder, i) ? static_cast<double>(in.map_of(i).edge_distance_texels[i]) : 0; });

  const auto width = static_cast<size_t>(std::max(1, ladder.flags.width));
  const StepBlocks steps(ladder);
  bool stepped = false;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (i == steps.first(StepBlocks::block_of(i))) stepped = steps.any(StepBlocks::block_of(i));
    if (!is_counted(ladder, i)) continue;
    // Almost all pixels are right: none of the parts above can be other than 0 there.
    if (soft(i) == 0 && ladder.doubt[i] == 0 &&
        (!stepped || std::all_of(ladder.causes.begin(), ladder.causes.end(),
                                 [i](const auto& cause) { return cause.step[i] == 0; })))
      continue;
    for (auto& [worst, part] : all) {
      const double here = std::isnan(worst.size) ? 0 : part(i);
      if (here <= worst.size || std::isnan(worst.size)) continue;  // a NaN is the worst
      worst.x = static_cast<int>(i % width), worst.y = static_cast<int>(i / width);
      worst.size = here;
    }
  }
  std::vector<PointRecord::WorstOf> found;
  for (auto& [worst, part] : all)
    if (worst.x >= 0) found.push_back(std::move(worst));
  return found;
}

}  // namespace noonmark
