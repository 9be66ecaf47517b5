// Law 8: without an occluder there is no error but acne.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/laws/support.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::acceptance {
namespace {

float step(const Measurement& m, Cause cause, size_t i) { return m.ladder[cause][i]; }

// Law 8 holds at every setting. These are random settings that a sweep could use.
Settings any_settings(const std::string& scene) {
  const auto one_of = [](std::vector<std::string> values) { return *rc::gen::elementOf(values); };
  const auto between = [](int from, int to) { return *rc::gen::inRange(from, to + 1); };
  Settings s = with({{"map.format", one_of({"16", "24", "32f"})},
                     {"map.wrap", one_of({"repeat", "clamp_to_edge", "clamp_to_border"})},
                     {"map.cull", one_of({"none", "back", "front"})},
                     {"map.lit_beyond_far", one_of({"true", "false"})},
                     {"map.resolution", std::to_string(between(1, 300))},
                     {"map.extent_scale", text(between(2, 30) / 10.0)},
                     {"map.shift_u_texels", text(between(-10, 10) / 10.0)},
                     {"map.shift_v_texels", text(between(-10, 10) / 10.0)},
                     {"filter.kind", "box"},
                     {"filter.size", one_of({"1", "3", "7"})},
                     {"bias.unit", one_of({"m", "texel", "depth"})},
                     {"bias.constant", text(between(0, 1) * std::pow(10.0, between(-6, 1)))},
                     {"bias.slope", text(between(0, 1) * std::pow(10.0, between(-6, 1)))},
                     {"bias.slope_floor", text(between(0, 1) * std::pow(10.0, between(-6, 1)))},
                     {"scene.theta_deg", std::to_string(between(0, 89))},
                     {"scene.phi_deg", std::to_string(between(-180, 180))},
                     {"scene.mesh", one_of({"as_built", "one_mesh"})}},
                    small(scene, 64, 48));
  return s;
}

// The rasteriser snaps vertices to a fraction of a pixel. So at the outline of a closed solid, a pixel's centre may
// miss the faces that are turned to the camera and meet the inside of a face that is turned away. Such a receiver is
// inside the solid, and dark.
bool seen_from_inside(const Measurement& m, size_t i) {
  const glm::uvec3 t = m.scene.triangles[m.receivers.primitive[i]];
  const glm::dvec3 a = m.scene.positions[t.x], b = m.scene.positions[t.y], c = m.scene.positions[t.z];
  return glm::dot(glm::cross(b - a, c - a), glm::dvec3(m.receivers.normal[i])) < 0;
}

void expect_nothing_but_acne(Workbench& bench, const Settings& settings, bool closed) {
  const Measurement m = bench.measure(settings, std::nullopt);
  RC_PRE(metric(m, "counted") > 0);  // the fitted camera may see the dark side only
  uint64_t broken = 0, false_truths = 0;
  for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
    if (!(m.ladder.flags[i] & flag_facing) || (m.ladder.flags[i] & flag_ambiguous)) continue;
    if (closed && seen_from_inside(m, i)) continue;
    false_truths += m.ladder.truth()[i] != 1;
    for (Cause cause : {Cause::filter, Cause::aliasing_dark, Cause::aliasing_light, Cause::peter_panning})
      broken += step(m, cause, i) != 0;
  }
  if (broken > 0 || false_truths > 0)
    for (const Setting& row : settings_table()) RC_LOG() << row.name << " = " << row.get(settings) << "\n";
  RC_ASSERT(broken == 0u);
  RC_ASSERT(false_truths == 0u);
}

Workbench& shared_bench() {  // one context for all the cases of a property
  static Workbench bench(gl::DebugMode::fatal);
  return bench;
}

RC_GTEST_PROP(Law8, APlaneASphereABowlFromAboveHaveAcneOnly, ()) {
  const auto scene = *rc::gen::weightedElement<std::string>({{6, "plane"}, {1, "sphere"}, {1, "bowl"}});
  expect_nothing_but_acne(shared_bench(), any_settings(scene), false);
}

// A lone box of any size and rotation under any light. It is loaded from a file, and the camera and the map are fitted
// to it.
RC_GTEST_PROP(Law8, ALoneBoxHasAcneOnly, ()) {
  const auto real = [](double from, double to) { return from + (to - from) * *rc::gen::inRange(0, 1001) / 1000.0; };
  std::vector<float> positions;
  const glm::dvec3 half(real(0.05, 1), real(0.05, 1), real(0.05, 1));
  const glm::dmat4 turned = glm::rotate(glm::rotate(glm::dmat4(1), real(0, 6), glm::dvec3(0, 1, 0)), real(0, 6),
                                        glm::normalize(glm::dvec3(1, real(-1, 1), real(-1, 1))));
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const glm::dvec4 at = turned * glm::dvec4(sign * half, 1);
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(at[axis]));
  }
  const std::vector<uint16_t> indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                         2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  test::json document = test::square();
  document["buffers"] = test::json::array();
  document["bufferViews"] = test::json::array();
  document["accessors"] = test::json::array();
  test::add_accessor(document, test::raw(positions), 5126, "VEC3", 8);
  test::add_accessor(document, test::raw(indices), 5123, "SCALAR", 36);
  test::json low(3), high(3);
  for (size_t axis = 0; axis < 3; ++axis) {
    float least = positions[axis], most = least;
    for (size_t i = axis; i < positions.size(); i += 3)
      least = std::min(least, positions[i]), most = std::max(most, positions[i]);
    document["accessors"][0]["min"][axis] = least;
    document["accessors"][0]["max"][axis] = most;
  }
  const TemporaryFolder folder;
  Settings settings = any_settings(folder.write("box.gltf", document.dump()));
  settings.light.position_m = glm::dvec3(real(-5, 5), real(2, 6), real(-5, 5));
  settings.light.target_m = glm::dvec3(0);
  expect_nothing_but_acne(shared_bench(), settings, true);
}

}  // namespace
}  // namespace noonmark::acceptance
