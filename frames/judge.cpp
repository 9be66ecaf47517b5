#include "frames/judge.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/suggestion.h"
#include "frames/alignment.h"
#include "frames/check_statistics.h"
#include "frames/frame_keys.h"
#include "frames/frame.h"
#include "scenes/number_ranges.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// The numbers of a frame that no file gave are those of one that a file could give.
void require_ranges(const Light& light, const JudgeRules& rules) {
  for (int axis = 0; axis < 3; ++axis) require_in_range("light.position", light.position_m[axis]);
  // Of a light with a direction the target lies beside the position, which may be at the end of its range.
  if (!(glm::distance(light.target_m, light.position_m) <= ranges::most_distance_m))
    throw Error(ErrorKind::usage, fmt::format("light.target is more than {:g} m from light.position; set it nearer",
                                              ranges::most_distance_m));
  require_in_range("light.cone_deg", light.cone_deg);
  require_in_range("light.angular_diameter_deg", light.angular_diameter_deg);
  require_in_range("light.radius", light.radius_m);
  require_in_range("edge.pixels", rules.edge_pixels);
  if (rules.edge_m) require_in_range("edge.distance", *rules.edge_m);
  if (rules.contact_m) require_in_range("contact.distance", *rules.contact_m);
}

// The frame of the light alone. A map is laid about the scene, because a frame has one; nothing reads it.
LightFrame light_frame_of(const Scene& scene, const Light& light) {
  Settings settings;
  settings.light = {.name = LightSettings().name,
                    .index = {},
                    .kind = light.kind == LightKind::directional ? LightChoice::directional
                            : light.kind == LightKind::spot      ? LightChoice::spot
                                                                 : LightChoice::point,
                    .position_m = light.position_m,
                    .target_m = light.target_m,
                    .azimuth_deg = {},
                    .elevation_deg = {},
                    .angular_diameter_deg = light.angular_diameter_deg,
                    .radius_m = light.radius_m,
                    .shape = light.shape,
                    .cone_deg = light.cone_deg};
  settings.map.fit = MapFit::tight;
  return make_light_frame(scene, settings);
}

double diagonal_m(const Scene& scene) {
  if (scene.positions.empty()) return 0;
  glm::vec3 low = scene.positions[0], high = low;
  for (const glm::vec3& p : scene.positions) low = glm::min(low, p), high = glm::max(high, p);
  return glm::length(glm::dvec3(high) - glm::dvec3(low));
}

void require_size(const GivenFrame& frame, int width, int height, const char* what) {
  if (width != frame.visibility.width || height != frame.visibility.height)
    throw Error(ErrorKind::file,
                fmt::format("{}: the visibility has {} x {} pixels, but the {} {} x {}; write both in one size",
                            frame.name, frame.visibility.width, frame.visibility.height, what, width, height));
}

raytrace::OnSurface find_receivers(const Scene& scene, const raytrace::Tracer& tracer, const GivenFrame& frame,
                                   const Image<uint32_t>& seen) {
  const int width = frame.visibility.width, height = frame.visibility.height;
  if (frame.receivers == GivenReceivers::none)
    return {resolve_receivers(scene, frame.view, seen), Image<float>(width, height, 0)};
  require_size(frame, frame.positions.width, frame.positions.height, "receivers have");
  Image<uint8_t> present(width, height, 0);
  for (size_t i = 0; i < present.size(); ++i) {
    const glm::dvec3 p = frame.positions[i];
    present[i] = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    if (present[i] && !is_in_world(p))
      throw Error(
          ErrorKind::file,
          fmt::format("{}: the receiver of the pixel x = {}, y = {} lies at ({:.4g}, {:.4g}, {:.4g}) m, and a "
                      "coordinate is at most {:g} m; check positions, depths and metres_per_unit",
                      frame.name, i % static_cast<size_t>(frame.positions.width),
                      i / static_cast<size_t>(frame.positions.width), p.x, p.y, p.z, ranges::coordinate_m.most));
  }
  return tracer.on_surface(frame.positions, present, frame.view);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Sets counted and error.
void compare_with_truth(const GivenFrame& frame, FrameVerdict& verdict) {
  for (size_t i = 0; i < verdict.counted.size(); ++i) {
    if (!verdict.truth.facing[i] || verdict.truth.ambiguous[i] || std::isnan(frame.visibility[i])) continue;
    verdict.counted[i] = 1;
    verdict.error[i] = std::abs(frame.visibility[i] - verdict.truth_at(i));
  }
}

// Takes those pixels out of the mask that are too light where only casters that the frame's map lacks keep the light away: in
// the scene without these casters the receiver is lit.
void classify_missing(const Scene& scene, const GivenFrame& frame, Image<uint8_t>& mask, FrameVerdict& verdict) {
  std::vector<uint8_t> lacks(scene.triangles.size(), 0);
  for (const std::string& name : frame.not_in_map) {
    bool found = false;
    std::vector<std::string_view> names;
    for (const Part& part : scene.parts) {
      names.push_back(part.name);
      if (part.name != name) continue;
      found = true;
      std::fill_n(lacks.begin() + part.first_triangle, part.triangle_count, uint8_t{1});
    }
    if (!found)
      throw Error(ErrorKind::file, fmt::format("{}: 'not_in_map': the scene has no node '{}'{}", frame.name, name,
                                               did_you_mean(name, names)));
  }
  Scene in_map;
  in_map.positions = scene.positions;
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t)
    if (!lacks[t]) in_map.triangles.push_back(scene.triangles[t]), kept.push_back(t);
  const Image<uint32_t> first = raytrace::Tracer(in_map).first_on_the_way(verdict.receivers, verdict.light, mask);
  for (size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i] || verdict.truth_at(i) > 0) continue;
    const uint32_t met = first[i] == no_primitive ? no_primitive : kept[first[i]];
    const glm::dvec3 p = verdict.receivers.position[i];
    // What the light meets at the receiver or behind it does not shadow it.
    if (met == no_primitive || met == verdict.receivers.primitive[i] ||
        !(way_to_plane(scene, met, p, verdict.light.direction_to_light(p)) > 0))
      verdict.classes[i] = FrameClass::missing, mask[i] = 0;
  }
}

void classify(const Scene& scene, const raytrace::Tracer& tracer, const GivenFrame& frame, const Image<float>& pixel_m,
              const JudgeRules& rules, FrameVerdict& verdict) {
  const int width = verdict.error.width, height = verdict.error.height;
  Image<uint8_t> hard(width, height, 0), falsely_lit(width, height, 0);
  for (size_t i = 0; i < hard.size(); ++i) {
    if (!(verdict.error[i] > 0)) continue;
    const float truth = verdict.truth_at(i);
    if (truth > 0 && truth < 1)
      verdict.classes[i] = FrameClass::penumbra;
    else
      hard[i] = 1;
  }
  if (!frame.not_in_map.empty()) classify_missing(scene, frame, hard, verdict);
  Image<float> reach(width, height, 0);
  for (size_t i = 0; i < reach.size(); ++i)
    reach[i] = static_cast<float>(rules.edge_m ? *rules.edge_m : rules.edge_pixels * pixel_m[i]);
  std::vector<double> used;
  for (size_t i = 0; i < reach.size(); ++i)
    if (verdict.counted[i]) used.push_back(reach[i]);
  verdict.edge_m = median(std::move(used));
  const Image<uint8_t> near_edge =
      tracer.edge_within(verdict.receivers, verdict.truth, verdict.light, hard, reach, pixel_m);
  for (size_t i = 0; i < hard.size(); ++i) {
    if (!hard[i]) continue;
    if (near_edge[i])
      verdict.classes[i] = FrameClass::edge;
    else if (verdict.truth_at(i) > 0)
      verdict.classes[i] = FrameClass::acne;
    else
      falsely_lit[i] = 1;
  }
  const Image<float> occluder_m = tracer.occluder_distance(verdict.receivers, verdict.light, falsely_lit);
  for (size_t i = 0; i < hard.size(); ++i)
    if (falsely_lit[i]) verdict.classes[i] = occluder_m[i] < verdict.contact_m ? FrameClass::contact : FrameClass::leak;
}

void measure(FrameVerdict& verdict) {
  double error = 0, wrong = 0, counted = 0, receivers = 0, facing = 0, ambiguous = 0, largest = -1;
  std::array<double, frame_classes.size() + 1> sizes{};
  for (size_t i = 0; i < verdict.error.size(); ++i) {
    receivers += verdict.receivers.primitive[i] != no_primitive;
    facing += verdict.truth.facing[i];
    ambiguous += verdict.truth.facing[i] && verdict.truth.ambiguous[i];
    if (!verdict.counted[i]) continue;
    const double size = verdict.error[i];
    counted += 1;
    error += size;
    wrong += size > 0.5;
    sizes[static_cast<size_t>(verdict.classes[i])] += size;
    if (size > largest) {
      largest = size;
      const auto width = static_cast<size_t>(verdict.error.width);
      verdict.worst = {static_cast<int>(i % width), static_cast<int>(i / width)};
    }
  }
  verdict.metrics = {{"receivers", receivers},
                     {"facing", facing},
                     {"counted", counted},
                     {"ambiguous", ambiguous / facing},
                     {"frame_error", error / counted},
                     {"frame_wrong", wrong / counted}};
  for (const FrameClassRow& row : frame_classes)
    verdict.metrics[std::string(row.metric)] = sizes[static_cast<size_t>(row.what)] / counted;
}

}  // namespace

bool FrameVerdict::refused() const {
  return std::any_of(checks.begin(), checks.end(),
                     [](const CheckResult& check) { return check.state == CheckState::failed && !check.accepted; });
}

FrameVerdict judge_frame(const Scene& scene, const raytrace::Tracer& tracer, const GivenFrame& frame,
                         const JudgeRules& rules) {
  for (const std::string& name : rules.accepted) require_check(name);
  require_ranges(frame.light, rules);
  const int width = frame.visibility.width, height = frame.visibility.height;
  require_frame_memory(frame.name, width, height);
  const Image<uint32_t> seen = tracer.seen_primitives(frame.view, width, height);
  raytrace::OnSurface found = find_receivers(scene, tracer, frame, seen);
  FrameVerdict verdict{.receivers = std::move(found.receivers),
                       .light = light_frame_of(scene, frame.light),
                       .truth = {},
                       .counted = Image<uint8_t>(width, height, 0),
                       .error = Image<float>(width, height, 0),
                       .classes = Image<FrameClass>(width, height, FrameClass::none),
                       .checks = {},
                       .metrics = {}};
  verdict.truth = tracer.receiver_truth(verdict.receivers, verdict.light, {frame.light, rules.standard_error});
  verdict.contact_m = rules.contact_m.value_or(JudgeRules::contact_share * diagonal_m(scene));
  compare_with_truth(frame, verdict);
  const Image<float> pixel_m = pixel_width_m(frame.view, verdict.receivers);
  verdict.checks = check_frame({scene, tracer, frame, seen, verdict.receivers, found.moved_m, verdict.truth,
                                verdict.counted, pixel_m, verdict.light});
  for (CheckResult& check : verdict.checks) check.accepted |= rules.accepted.contains(std::string(check.name));
  classify(scene, tracer, frame, pixel_m, rules, verdict);
  measure(verdict);
  if (verdict.metrics.at("counted") == 0 && !verdict.refused())
    throw Error(ErrorKind::file,
                fmt::format("{}: nothing can be judged: {:.0f} receivers, of which {:.0f} face the light, and none of "
                            "these has a visibility and a certain truth; check the light's direction and the picture",
                            frame.name, verdict.metrics.at("receivers"), verdict.metrics.at("facing")));
  return verdict;
}

}  // namespace noonmark
