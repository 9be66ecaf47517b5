// The laws of occluders: what a bias loses of a shadow, what front-face culling costs, and that nothing is lost where
// nothing shades.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/gltf_files.h"
#include "tests/laws_support.h"

namespace noonmark::acceptance {
namespace {

float step(const Measurement& m, Cause cause, size_t i) { return m.ladder[cause][i]; }

// Law 2. The map stores the occluder's lit face. Behind a wall of thickness t a floor receiver a distance x from the
// shadow-side foot, along the light's trace, has the wall's lit face t / cos(psi) + x further along the trace (psi: the
// trace's azimuth against the wall's normal), so (t / cos(psi) + x) / sin(theta) back along the light: lit while that
// is less than b. The gap is max(0, b sin(theta) - t / cos(psi)) long.
TEST(Law2, GivesTheGapBehindAWall) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* light : {"-4,4,0", "-4,4,-2", "-3,4,-3", "-2,1.5,0.8"}) {
    for (double t : {0.01, 0.1, 0.3}) {
      for (double b : {0.15, 0.5}) {
        const Measurement m = bench.measure(with({{"light.position_m", light},
                                                  {"light.target_m", "0,0,0"},
                                                  {"map.extent_m", "14"},
                                                  {"map.near_m", "-4"},
                                                  {"map.far_m", "14"},
                                                  {"scene.thickness_m", text(t)},
                                                  {"bias.constant", text(b)},
                                                  {"bias.unit", "m"},
                                                  {"map.format", "32f"},
                                                  {"map.resolution", "1024"},
                                                  {"view.eye_m", "3,2.5,1.5"},
                                                  {"view.target_m", "0.5,0,1.5"},
                                                  {"view.fov_deg", "20"}},
                                                 small("wall", 240, 180)),
                                            std::nullopt);
        const glm::dvec3 to_light = m.frame.direction_to_light();
        const glm::dvec2 trace = -glm::normalize(glm::dvec2(to_light.x, to_light.z));
        const double sine = std::sqrt(1 - to_light.y * to_light.y), cosine = to_light.y, cos_psi = trace.x;
        const double law = std::max(0.0, b * sine - t / cos_psi), texel = m.frame.texel_m() / cosine;
        double measured = 0;
        uint64_t behind = 0, dark_in_gap = 0;
        for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
          if (m.receivers.primitive[i] >= 2 || !(m.ladder.flags[i] & flag_facing)) continue;  // the floor
          const glm::dvec3 p(m.receivers.position[i]);
          const double along = (p.x - t) / trace.x;
          if (along < 0 || along > 1 || p.z - along * trace.y < 0.3 || p.z - along * trace.y > 2.7) continue;
          ++behind;
          if (step(m, Cause::peter_panning, i) != 0) measured = std::max(measured, along);
          dark_in_gap += along < law - texel && m.ladder[Rung::on_exact_map][i] == 0;
        }
        SCOPED_TRACE(testing::Message() << "light " << light << " t " << t << " b " << b);
        EXPECT_GT(behind, 1000u);
        EXPECT_EQ(dark_in_gap, 0u);
        // One texel on the receiver, to either side; and the picture's pixels, 6 mm of floor, end the gap early.
        EXPECT_LE(measured, law + texel);
        EXPECT_GE(measured, law - texel - 0.006);
        if (law == 0 && b * sine < t / cos_psi - texel) {
          EXPECT_EQ(measured, 0);
        }
      }
    }
  }
}

// Law 2 for plates: the shadow is lost when the lit face stands less than b cos(theta) above the receiver, whatever the
// plate's thickness. Its lit sides are lit faces too: what enters through them is lost with less height, so only
// receivers whose light enters through the top are asked.
TEST(Law2, LosesAPlateBelowTheHeightItNames) {
  Workbench bench(gl::DebugMode::fatal);
  const auto lost = [&](double bias_m, double share, const char* thickness) {
    const Settings probe = with({{"bias.constant", text(bias_m)},
                                 {"bias.unit", "m"},
                                 {"map.resolution", "1024"},
                                 {"map.format", "32f"},
                                 {"scene.thickness_m", thickness}},
                                small("plate", 640, 360));
    const double cosine = make_light_frame(make_scene(probe.scene), probe).direction_to_light().y;
    const Measurement m = bench.measure(with({{"scene.height_m", text(share * bias_m * cosine)}}, probe), std::nullopt);
    uint64_t dark = 0, panning = 0;
    for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
      if (m.receivers.primitive[i] >= 2 || !(m.ladder.flags[i] & flag_facing) || m.ladder.truth()[i] != 0) continue;
      const glm::dvec3 p(m.receivers.position[i]), l = m.frame.direction_to_light();
      const glm::dvec3 enters = p + share * bias_m * cosine / l.y * l;
      const double margin = m.frame.texel_m() / cosine;  // the texel's centre may lie beyond the rim
      if (std::abs(enters.x) > 0.8 - margin || std::abs(enters.z) > 0.6 - margin) continue;
      ++dark;
      panning += step(m, Cause::peter_panning, i) != 0;
    }
    EXPECT_GT(dark, 100u);
    return static_cast<double>(panning) / static_cast<double>(dark);
  };
  for (double bias : {0.15, 0.3}) {
    for (const char* thickness : {"0.01", "0.08"}) {
      EXPECT_GT(lost(bias, 0.9, thickness), 0.9) << thickness;  // all but the taps at its edges, which are aliasing
      EXPECT_EQ(lost(bias, 1.1, thickness), 0) << thickness;
    }
  }
}

// Law 8 holds at every setting: any of the following that a sweep could name.
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

// At the outline of a closed solid a pixel's centre may miss the faces that are turned to the camera, by the
// rasteriser's snapping of vertices to a fraction of a pixel, and meet the inside of one that is turned away. Such a
// receiver is inside the solid, and dark.
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

// A lone box of any size and turn under any light, as a file, with camera and map fitted to it.
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
  const test::TemporaryFolder folder;
  Settings settings = any_settings(folder.write("box.gltf", document.dump()));
  settings.light.position_m = glm::dvec3(real(-5, 5), real(2, 6), real(-5, 5));
  settings.light.target_m = glm::dvec3(0);
  expect_nothing_but_acne(shared_bench(), settings, true);
}

// Peter Panning lights what is dark; unfiltered, a lit receiver has one tap, and it is lit.
TEST(Law8, NoLitReceiverIsLitByPeterPanning) {
  Workbench bench(gl::DebugMode::fatal);
  for (const BuiltinScene& builtin : builtin_scenes())
    for (const char* bias : {"0", "0.005", "0.1"}) {
      const Measurement m =
          bench.measure(with({{"bias.constant", bias}}, small(std::string(builtin.name), 240, 160)), std::nullopt);
      EXPECT_EQ(metric(m, "peter_panning_lit"), 0) << builtin.name << " " << bias;
    }
}

// Law 10. With front faces culled the map stores the back of a closed solid: z_back(c) = z_front(c) + T(c), T the
// solid's thickness along the light at the texel's centre c. So a lit receiver is falsely dark exactly where
// T(c) < z_P - z_front(c), and never where T >= k w A tan(theta). Over a slab's top, away from its rim, T = t /
// cos(theta) and z_P - z_front(c) = w tan(theta) U with U uniform in [-1/2, 1/2] (its slope runs along the texels, A =
// 1): the share 1/2 - T / (w tan(theta)) is dark.
TEST(Law10, NeedsThicknessWhereFrontFacesAreCulled) {
  Workbench bench(gl::DebugMode::fatal);
  for (double share : {0.0005, 0.25, 0.5, 0.75, 1.01, 3.0}) {
    const Settings base = with({{"map.cull", "front"},
                                {"map.format", "32f"},
                                {"map.resolution", "160"},
                                {"bias.constant", "0"},
                                {"scene.height_m", "1"}},
                               small("plate", 640, 360));
    const Scene scene = make_scene(base.scene);
    const LightFrame frame = make_light_frame(scene, base);
    const double cosine = frame.direction_to_light().y, tangent = std::sqrt(1 - cosine * cosine) / cosine;
    const double w = frame.texel_m(), needed = w / 2 * tangent * cosine;  // the slab's own thickness
    const Measurement m =
        bench.measure(with({{"scene.thickness_m", text(std::max(share * needed, 1e-4))}}, base), std::nullopt);
    uint64_t top = 0, dark = 0, rim_dark = 0;
    const double margin = std::numbers::sqrt2 * w / cosine;  // a texel's diagonal, on the slab
    for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
      if (m.receivers.primitive[i] < 2 || !(m.receivers.normal[i].y > 0.99f)) continue;
      const glm::vec3 p = m.receivers.position[i];
      const bool acne = step(m, Cause::acne, i) != 0;
      if (std::abs(p.x) > 0.8 - margin || std::abs(p.z) > 0.6 - margin) {
        rim_dark += acne;
        continue;
      }
      ++top;
      dark += acne;
      EXPECT_EQ(m.ladder.truth()[i], 1);
    }
    ASSERT_GT(top, 3000u);
    const double law = std::max(0.0, (1 - std::max(share, 1e-4 / needed)) / 2);
    SCOPED_TRACE(testing::Message() << "share " << share << " law " << law);
    // The pixels' places within texels are not random: their share is met within a part in fifty.
    EXPECT_NEAR(static_cast<double>(dark) / static_cast<double>(top), law, law > 0 ? 0.02 : 0);
    // At the rim the solid is thinner along the light, however thick the slab.
    EXPECT_GT(rim_dark, 0u);
  }
}

// Law 10's price: where a culled solid touches the floor, the map stores its far side, no higher than the floor, and a
// receiver in its shadow is lit by a texel just inside the contact, without any bias. With front faces drawn, no bias
// lights nothing.
TEST(Law10, LeaksAtContacts) {
  Workbench bench(gl::DebugMode::fatal);
  const auto leak = [&](const char* cull) {
    return metric(bench.measure(with({{"map.cull", cull},
                                      {"map.format", "32f"},
                                      {"bias.constant", "0"},
                                      {"map.resolution", "256"},
                                      {"view.eye_m", "1.2,0.8,1.5"},
                                      {"view.target_m", "0.1,0,1.5"},
                                      {"view.fov_deg", "16"}},
                                     small("wall", 480, 270)),
                                std::nullopt),
                  "peter_panning");
  };
  EXPECT_GT(leak("front"), 0);
  EXPECT_EQ(leak("none"), 0);
  EXPECT_EQ(leak("back"), 0);
}

}  // namespace
}  // namespace noonmark::acceptance
