// Cascades that are blended into the next one, and their seams: the point is the mix of what its maps give when each is
// measured by itself over all receivers.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/ladder/measure.h"
#include "compare/ladder/seams.h"
#include "technique/cascade_selections.h"
#include "technique/cascades.h"
#include "technique/cost.h"
#include "tests/acceptance/maps_apart.h"

namespace noonmark::acceptance {
namespace {

double mix(double here, double next, double share) { return (1 - share) * here + share * next; }

std::vector<Ladder> ladders_apart(MapsApart& apart, const Settings& s) {
  std::vector<Ladder> ladders;
  for (Technique alone : techniques_of(apart.scene(), s)) {
    alone.cascade.reset();
    ladders.push_back(apart.climb(alone, apart.truth_of(alone)));
  }
  return ladders;
}

class BlendedCase : public testing::TestWithParam<SceneCase> {
 protected:
  Settings settings() const {
    return with(GetParam().settings, street({{"scene.name", GetParam().scene},
                                             {"cascades.blend", "0.3"},
                                             {"map.resolution", "64"},
                                             {"bias.constant", "0.4"}}));
  }
};

// Every rung and every step is the mix of both maps', and no receiver is further off than in the worse of the two (law 32).
TEST_P(BlendedCase, IsTheMixOfItsTwoMaps) {
  const Settings s = settings();
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(s, std::nullopt);
  EXPECT_LE(metric(m, "cascade_choice_excess"), 1);
  EXPECT_LE(metric(m, "residual"), rounding_of_steps);
  EXPECT_EQ(metric(m, "contract"), 0);
  MapsApart apart(s);
  const std::vector<Ladder> ladders = ladders_apart(apart, s);
  double error = 0, counted = 0, band = 0, changed = 0;
  Seam seam;
  for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
    if (!is_counted(m.ladder, i)) continue;
    const size_t k = m.choice.of[i];
    const double share = m.choice.next[i];
    const Ladder &here = ladders[k], &next = ladders[std::min(k + 1, ladders.size() - 1)];
    double worst = 0;
    for (const Ladder* one : {&here, &next})
      worst = std::max(worst, std::abs(static_cast<double>(one->shown()[i]) - one->truth()[i]));
    for (size_t n = 0; n < here.rungs.size(); ++n)
      ASSERT_EQ(m.ladder.rungs[n].lit[i],
                static_cast<float>(mix(here.rungs[n].lit[i], share > 0 ? next.rungs[n].lit[i] : 0, share)));
    for (size_t c = 0; c < here.causes.size(); ++c)
      ASSERT_EQ(m.ladder.causes[c].step[i],
                static_cast<float>(mix(here.causes[c].step[i], share > 0 ? next.causes[c].step[i] : 0, share)));
    const double off = std::abs(static_cast<double>(m.ladder.shown()[i]) - m.ladder.truth()[i]);
    if (share > 0) {
      ASSERT_LE(off, worst + 0x1p-23);
      ++band;
      changed += here.shown()[i] != next.shown()[i];
    }
    ASSERT_EQ(m.ladder.cause[i] != 0, off != 0);
    error += off;
    ++counted;
    if (!m.choice.seam[i]) continue;
    ++seam.points;
    seam.jump += std::abs(static_cast<double>(next.shown()[i]) - here.shown()[i]);
  }
  EXPECT_GT(band, 500);
  EXPECT_GT(changed, 3) << "the two maps show the same everywhere: the test says nothing";
  EXPECT_DOUBLE_EQ(metric(m, "error"), error / counted);
  EXPECT_EQ(metric(m, "counted"), counted);
  ASSERT_GT(seam.points, 50);
  EXPECT_EQ(metric(m, "seam_points"), seam.points);
  EXPECT_DOUBLE_EQ(metric(m, "seam_jump"), seam.jump / seam.points);
  // The rows of the cascades add up to the point.
  double sum = 0;
  for (const PointRecord::Cascade& cascade : m.record.cascades)
    if (cascade.metrics.at("counted") > 0) sum += cascade.metrics.at("counted") * cascade.metrics.at("error");
  EXPECT_NEAR(sum, error, 1e-9 * error);
  // The band costs a second lookup.
  double lookups = 0;
  for (size_t i = 0; i < m.ladder.flags.size(); ++i)
    if (m.ladder.flags[i] & flag_facing) lookups += m.choice.next[i] > 0 ? 2 : 1;
  const FrameCost cost = frame_cost(s, 1, static_cast<int64_t>(metric(m, "map_texels")), static_cast<int64_t>(lookups),
                                    static_cast<int64_t>(m.scene.triangles.size()));
  EXPECT_EQ(metric(m, "texel_work"), static_cast<double>(cost.texel_work));
}

INSTANTIATE_TEST_SUITE_P(
    , BlendedCase,
    testing::Values(SceneCase{"Unfiltered", "street", {}},
                    SceneCase{"Box", "pillars", {{"filter.kind", "box"}, {"filter.size", "5"}}},
                    SceneCase{"Hardware", "facade", {{"filter.kind", "hardware"}, {"bias.slope", "1"}}},
                    SceneCase{"OfTheEnd", "pillars", {{"cascades.blend_of", "end"}}},
                    SceneCase{"Smooth", "street", {{"cascades.blend_shape", "smooth"}}},
                    SceneCase{"OfTheSquare",
                              "street",
                              {{"cascades.blend_of", "square"},
                               {"map.fit", "corner_square"},
                               {"view.near_m", "0.2"},
                               {"map.reach_m", "79"}}},
                    SceneCase{"ByMap", "pillars", {{"cascades.select", "map"}, {"map.fit", "view"}}},
                    SceneCase{"BySphere", "pillars", {{"cascades.select", "sphere"}}},
                    SceneCase{"NotCovered", "street", {{"map.fit", "view"}, {"cascades.cover_band", "false"}}},
                    SceneCase{"SnappedNormalOffset", "street", {{"bias.normal_offset", "0.02"}, {"map.snap", "true"}}}),
    [](const auto& test) { return test.param.name; });

// Seams are measured without a band too, at the same receivers, and change no other number.
TEST(Seams, AreWhatTheNextCascadeWouldShow) {
  const Settings s = street({{"filter.kind", "box"}, {"filter.size", "3"}, {"bias.constant", "0.4"}});
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(s, std::nullopt);
  EXPECT_EQ(metric(m, "contract"), 0);
  MapsApart apart(s);
  const std::vector<Ladder> ladders = ladders_apart(apart, s);
  const std::vector<Technique> cascades = techniques_of(apart.scene(), s);
  const CascadePlace& place = *cascades.front().cascade;
  std::map<std::string, double> expected;
  double points = 0;
  std::array<double, 4> jumps{}, of_each{};
  for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
    const size_t k = m.choice.of[i];
    if (!is_counted(m.ladder, i) || k >= 3) continue;
    const double at =
        place.selection->place_in_double(place, static_cast<int>(k), m.camera.eye_m, m.receivers.position[i]);
    if (std::abs(at - seam_from) < 1e-5) continue;  // float may choose otherwise
    ASSERT_EQ(m.choice.seam[i] != 0, at > static_cast<double>(seam_from)) << at;
    if (!m.choice.seam[i]) continue;
    ++points;
    ++of_each[k];
    const Ladder &here = ladders[k], &next = ladders[k + 1];
    const double jump = static_cast<double>(next.shown()[i]) - here.shown()[i];
    jumps[k] += std::abs(jump);
    expected["seam_jump"] += std::abs(jump);
    double parts = 0;
    const auto part = [&](const char* name, std::vector<Cause> causes) {
      double step = 0;
      for (const Cause cause : causes) step += static_cast<double>(next[cause][i]) - here[cause][i];
      expected[name] += std::abs(step);
      parts += step;
    };
    part("seam_filter", {Cause::filter});
    part("seam_displacement", {Cause::displacement});
    part("seam_aliasing", {Cause::aliasing_dark, Cause::aliasing_light});
    part("seam_acne", {Cause::acne});
    part("seam_peter_panning", {Cause::peter_panning});
    part("seam_coverage", {Cause::coverage_dark, Cause::coverage_light});
    part("seam_undecided", {Cause::undecided});
    part("seam_precision", {Cause::precision});
    EXPECT_NEAR(parts, jump, rounding_of_steps) << "the causes are all that differs";
  }
  ASSERT_GT(points, 100);
  EXPECT_NEAR(metric(m, "seam_points"), points, 2);
  for (const auto& [name, sum] : expected) EXPECT_NEAR(metric(m, name), sum / points, 2 / points) << name;
  EXPECT_GT(metric(m, "seam_jump"), 0.002);
  EXPECT_GT(metric(m, "seam_acne"), 0.001);
  for (size_t k = 0; k < 3; ++k) {
    const auto& row = m.record.cascades[k].metrics;
    EXPECT_NEAR(row.at("seam_points"), of_each[k], 2);
    if (of_each[k] > 50) {
      EXPECT_NEAR(row.at("seam_jump"), jumps[k] / of_each[k], 2 / of_each[k]);
    }
  }
  EXPECT_EQ(m.record.cascades[3].metrics.at("seam_points"), 0) << "nothing follows the last";
  EXPECT_TRUE(std::isnan(m.record.cascades[3].metrics.at("seam_jump")));
}

// The curve is exact in a band too: a receiver's taps count by their map's share, and it is wrong if it is wrong in either.
TEST(BlendedCascades, HaveAnExactCurve) {
  for (const char* filter : {"none", "box", "hardware"}) {
    const Settings s = street({{"map.resolution", "128"},
                               {"cascades.blend", "0.4"},
                               {"filter.kind", filter},
                               {"light.angular_diameter_deg", "2"},
                               {"truth.standard_error", "0.05"}});
    Workbench bench(gl::DebugMode::fatal);
    CurveOptions options;
    for (const double bias : {0.0, 0.3, 1.0, 2.5, 6.0}) options.bias_depth.push_back(bias);
    const Measurement m = bench.measure(s, options);
    ASSERT_TRUE(m.record.curve);
    const BiasCurve curve = *m.record.curve;
    int wrong = 0;
    for (size_t n = 0; n < curve.bias_depth.size(); ++n) {
      Settings at = s;
      at.bias["constant"] = curve.bias_depth[n] * curve.texels_per_depth;
      const Measurement rendered = bench.measure(at, std::nullopt);
      // A mixed rung is rounded to float. Of hardware the exact weights are rounded in the sampler too.
      const double off = std::string(filter) == "hardware" ? 1e-6 : 0x1p-25;
      EXPECT_NEAR(curve.error[n], metric(rendered, "error"), off) << filter << n;
      EXPECT_NEAR(curve.error_soft[n], metric(rendered, "error_soft"), off) << filter << n;
      EXPECT_NEAR(curve.acne[n], metric(rendered, "acne"), off) << filter << n;
      EXPECT_NEAR(curve.peter_panning[n], metric(rendered, "peter_panning"), off) << filter << n;
      EXPECT_NEAR(curve.wrong[n], metric(rendered, "wrong"), 1e-4) << filter << n;
      wrong += curve.error[n] > 1e-4;
    }
    EXPECT_GT(wrong, 1) << "the curve says nothing";
  }
}

// All placements of all grids, measured one by one: each cascade counts at its own mean and worst, by its shares.
TEST(BlendedCascades, CountEachCascadeAtItsOwnWorstPlacement) {
  struct Case {
    const char *filter, *blend, *snap;
    double rounding;  // of the share of a blended receiver, a float
  };
  for (const auto& [filter, blend, snap, rounding] : {Case{"none", "0.4", "false", 1e-8},
                                                      {"hardware", "0.4", "false", 1e-8},
                                                      {"none", "0", "false", 1e-12},
                                                      {"none", "0", "true", 1e-12}}) {
    SCOPED_TRACE(std::string(filter) + " " + blend + " " + snap);
    const bool blended = std::string(blend) != "0";
    const Settings s = street({{"scene.name", "street"},
                               {"view.width_px", "160"},
                               {"view.height_px", "90"},
                               {"map.format", "32f"},
                               {"map.placements", "3"},
                               {"cascades.count", "3"},
                               {"cascades.blend", blend},
                               {"map.snap", snap},
                               {"filter.kind", filter},
                               {"bias.constant", "0.8"}});
    Workbench bench(gl::DebugMode::fatal);
    const Measurement m = bench.measure(s, CurveOptions{});
    EXPECT_EQ(metric(m, "placement_disagreements"), 0);
    EXPECT_EQ(metric(m, "contract"), 0);
    MapsApart apart(s);
    const Placements placements(3);
    double mean = 0, worst = 0, acne_worst = 0, counted = 0;
    for (const Technique& cascade : techniques_of(apart.scene(), s)) {
      const int k = cascade.cascade->index;
      double own_worst = 0, own_acne = 0;
      for (int p = 0; p < placements.count(); ++p) {
        Technique moved = cascade.at(placements.frame(cascade.frame, p));
        moved.cascade.reset();
        const Ladder ladder = apart.climb(moved, apart.truth_of(moved));
        double error = 0, acne = 0;
        for (size_t i = 0; i < ladder.flags.size(); ++i) {
          if (!is_counted(ladder, i)) continue;
          const double share = m.choice.share(i, k);
          if (p == 0) counted += share;
          error += share * std::abs(static_cast<double>(ladder[Rung::on_exact_map][i]) - ladder.truth()[i]);
          acne += share * std::abs(static_cast<double>(ladder[Cause::acne][i]));
        }
        mean += error / placements.count();
        own_worst = std::max(own_worst, error);
        own_acne = std::max(own_acne, acne);
      }
      worst += own_worst;
      acne_worst += own_acne;
    }
    EXPECT_NEAR(counted, metric(m, "counted"), 1e-9 * counted);
    EXPECT_GT(worst, 1.01 * mean) << "placements differ";
    EXPECT_NEAR(metric(m, "error_mean"), mean / counted, rounding);
    EXPECT_NEAR(metric(m, "error_worst"), worst / counted, rounding);
    EXPECT_NEAR(metric(m, "acne_worst"), acne_worst / counted, rounding);
    EXPECT_EQ(m.record.metrics.contains("wrong_worst"), !blended) << "a pixel of two maps has no sum over them";
    // The curve's band at the settings' own bias, which is one of its biases here.
    CurveOptions at_bias;
    at_bias.bias_depth = {0, s.bias["constant"] / m.record.curve->texels_per_depth};
    const Measurement again = bench.measure(s, at_bias);
    ASSERT_TRUE(again.record.curve && again.record.curve->error_band.worst.size() == 2);
    EXPECT_NEAR(again.record.curve->error_band.worst[1], worst / counted, std::max(rounding, 1e-9));
    EXPECT_NEAR(again.record.curve->error_band.mean[1], mean / counted, std::max(rounding, 1e-9));
    EXPECT_GE(*m.record.curve->acne_free_bias_worst_depth, *m.record.curve->acne_free_bias_depth);
  }
}

// A section in a band is of the map that more of the error comes from, and says what part of the pixel it has.
TEST(BlendedCascades, HaveSectionsOfTheMapThatErrs) {
  const Settings s =
      street({{"scene.name", "street"}, {"map.resolution", "64"}, {"bias.constant", "0.4"}, {"cascades.blend", "0.4"}});
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(s, std::nullopt);
  MapsApart apart(s);
  const std::vector<Ladder> ladders = ladders_apart(apart, s);
  std::vector<glm::ivec2> pixels;
  std::vector<int> cascades;
  std::vector<double> shares;
  for (const bool next_errs : {true, false})
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      const int k = m.choice.of[i];
      if (!is_counted(m.ladder, i) || !(m.choice.next[i] > 0)) continue;
      const auto errs = [&](int of) { return ladders[static_cast<size_t>(of)].shown()[i] != m.ladder.truth()[i]; };
      if (errs(k + 1) != next_errs || errs(k) == next_errs) continue;
      const int width = m.choice.of.width, at = static_cast<int>(i);
      pixels.emplace_back(at % width, at / width);
      cascades.push_back(next_errs ? k + 1 : k);
      shares.push_back(m.choice.share(i, cascades.back()));
      break;
    }
  ASSERT_EQ(pixels.size(), 2u);
  const std::vector<ReceiverSection> sections = bench.sections(m, pixels);
  for (size_t n = 0; n < pixels.size(); ++n) {
    EXPECT_EQ(sections[n].cascade, cascades[n] + 1);
    EXPECT_EQ(sections[n].share, shares[n]);
    EXPECT_NE(sections[n].shown, sections[n].truth) << "of this map alone";
  }
}

// A factor for each cascade is that cascade measured with a bias that many times as large; and the curve varies all of them.
TEST(ScaledCascades, HaveTheBiasOfTheirFactor) {
  const Settings s = street({{"cascades.bias_scales", "0.5,1,2,3"}, {"map.resolution", "128"}, {"bias.slope", "0.3"}});
  Workbench bench(gl::DebugMode::fatal);
  CurveOptions options;
  for (const double bias : {0.0, 0.4, 1.5, 4.0}) options.bias_depth.push_back(bias);
  const Measurement m = bench.measure(s, options);
  EXPECT_EQ(metric(m, "contract"), 0);
  EXPECT_LE(metric(m, "rounding_excess"), 1);
  MapsApart apart(s);
  for (size_t k = 0; k < 4; ++k) {
    const double factor = s.cascades.bias_scales[k];
    Settings own = with({{"cascades.bias_scales", "auto"}}, s);
    own.bias["constant"] *= factor;
    own.bias["slope"] *= factor;
    Technique alone = techniques_of(apart.scene(), own)[k];
    alone.cascade.reset();
    const Ladder ladder = apart.climb(alone, apart.truth_of(alone));
    size_t differ = 0, receivers = 0;
    for (size_t i = 0; i < ladder.flags.size(); ++i) {
      if (m.choice.of[i] != k || !is_counted(ladder, i)) continue;
      ++receivers;
      differ += m.ladder.shown()[i] != ladder.shown()[i];
    }
    // Two floats that are rounded in another order.
    EXPECT_LE(static_cast<double>(differ), 1e-3 * static_cast<double>(receivers)) << k;
  }
  for (size_t n = 0; n < m.record.curve->bias_depth.size(); ++n) {
    Settings at = s;
    at.bias["constant"] = m.record.curve->bias_depth[n] * m.record.curve->texels_per_depth;
    const double expected = m.record.curve->error[n];
    EXPECT_NEAR(expected, metric(Workbench(gl::DebugMode::fatal).measure(at, std::nullopt), "error"), 1e-9) << n;
  }
}

// Maps that are fitted to their slices alone do not hold the band in which they are blended in: its receivers are outside.
TEST(BlendedCascades, NeedMapsThatHoldTheBand) {
  const Settings covered = street({{"scene.name", "street"}, {"map.fit", "view"}, {"cascades.blend", "0.4"}});
  Workbench bench(gl::DebugMode::fatal);
  const auto outside = [&](const Settings& s) { return metric(bench.measure(s, std::nullopt), "outside"); };
  EXPECT_EQ(outside(covered), 0);
  EXPECT_GT(outside(with({{"cascades.cover_band", "false"}}, covered)), 0.01);
}

// Snapped maps that keep their size: what a moving camera changes is the choice alone, a little everywhere in the bands.
TEST(BlendedCascades, FlickerByTheirChoiceAlone) {
  const std::vector<Assignment> walk = {
      {"scene.name", "street"},       {"bias.constant", "0.4"},     {"map.snap", "true"},
      {"view.near_m", "0.3"},         {"map.reach_m", "60"},        {"map.format", "32f"},
      {"motion.move_m", "0.3,0,0.2"}, {"motion.turn_deg", "0,3,0"}, {"map.depth_range", "scene"}};
  Workbench bench(gl::DebugMode::fatal);
  const Measurement hard = bench.measure(street(walk), std::nullopt);
  const Measurement soft = bench.measure(with({{"cascades.blend", "0.3"}}, street(walk)), std::nullopt);
  for (const Measurement* m : {&hard, &soft}) {
    EXPECT_GT(metric(*m, "flicker_points"), 1000);
    EXPECT_EQ(metric(*m, "flicker_grid"), 0);
    EXPECT_EQ(metric(*m, "flicker_depth"), 0);
    EXPECT_GT(metric(*m, "flicker_cascade"), 0);
    EXPECT_NEAR(metric(*m, "flicker_cascade") + metric(*m, "flicker_coverage"), metric(*m, "flicker"), 1e-12);
  }
}

}  // namespace
}  // namespace noonmark::acceptance
