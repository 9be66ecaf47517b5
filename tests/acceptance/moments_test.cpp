// Lookups in maps of moments, measured: the ladder against an independent one, its causes, and what OpenGL made of each stage.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "base/error.h"
#include "compare/ladder/measure.h"
#include "compare/ladder/parameter_values.h"
#include "technique/cost.h"
#include "technique/lookups.h"
#include "technique/map_address.h"
#include "technique/setting_rules.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

// The bench must outlive what is read of the measurement's maps.
Measurement of_moments(Workbench& bench, const Settings& settings) { return bench.measure(settings, std::nullopt); }

class MomentCase : public testing::TestWithParam<SceneCase> {
 protected:
  Settings settings() const { return with(GetParam().settings, with_moments({{"scene.name", GetParam().scene}})); }
};

TEST_P(MomentCase, HasASoundLadderWhoseCausesStandOnWrongPixelsOnly) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = of_moments(bench, settings());
  for (const char* stage : {"contract", "contract_store", "contract_blur", "contract_fetch", "contract_lit"})
    EXPECT_EQ(metric(m, stage), 0) << stage;
  const bool bound = find_lookup(settings().lookup.kind).bound;
  EXPECT_EQ(m.record.metrics.contains("below_comparison"), bound);
  if (bound) {
    EXPECT_LE(metric(m, "below_comparison"), 1e-9);
  }
  EXPECT_LE(metric(m, "residual"), rounding_of_steps);
  EXPECT_LE(metric(m, "tap_residual"), rounding_of_steps);
  EXPECT_LE(metric(m, "rounding_excess"), 1);
  EXPECT_EQ(metric(m, "acne"), 0);
  const Ladder& ladder = m.ladder;
  ASSERT_EQ(ladder.causes.size(), static_cast<size_t>(cause_count));
  size_t wrong = 0, right = 0;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    // What lies between the taps at the places looked up and R4 has one sign and sums to it: nothing cancels.
    double sum = 0, size = 0;
    for (const Cause cause : {Cause::aliasing_dark, Cause::aliasing_light, Cause::peter_panning, Cause::coverage_dark,
                              Cause::coverage_light, Cause::leak, Cause::over_darkening, Cause::reduction}) {
      const double step = ladder[cause][i];
      sum += step, size += std::abs(step);
      const CauseEffect effect = find_cause(cause)->effect;
      if (effect == CauseEffect::darkens) {
        EXPECT_LE(step, 0) << cause_name(cause) << " " << i;
      } else if (effect == CauseEffect::lightens) {
        EXPECT_GE(step, 0) << cause_name(cause) << " " << i;
      }
    }
    EXPECT_NEAR(std::abs(sum), size, 1e-6) << i;
    const double change =
        static_cast<double>(ladder[Rung::on_exact_map][i]) - ladder[Rung::filtered][i] - ladder[Cause::displacement][i];
    EXPECT_LE(size, std::abs(change) + 1e-6 + ladder.doubt[i]) << i;
    (std::abs(change) < 1e-7 ? right : wrong) += 1;
    // A leak stands where the depths themselves are darker than the result, over-darkening where they are lighter.
    if (ladder[Cause::leak][i] > 0) {
      EXPECT_LT(ladder[Rung::snapped][i], 1) << i;
    }
    if (ladder[Cause::over_darkening][i] < 0) {
      EXPECT_GT(ladder[Rung::snapped][i], 0) << i;
    }
  }
  EXPECT_GT(wrong, 100u);
  EXPECT_GT(right, 50u);
}

INSTANTIATE_TEST_SUITE_P(
    , MomentCase,
    testing::Values(
        SceneCase{"Vsm", "cube-room", {}}, SceneCase{"VsmReduced", "cube-room", {{"lookup.reduction", "0.2"}}},
        SceneCase{"VsmAsThreeReduces",
                  "cube-room",
                  {{"lookup.reduction", "0.3"}, {"lookup.reduction_span", "0.65"}, {"map.moments", "16f"}}},
        SceneCase{"VsmFloor", "cube-room", {{"lookup.v_min", "1e-4"}, {"bias.constant", "0.001"}}},
        SceneCase{"VsmUnblurred", "cube-room", {{"filter.kind", "none"}, {"map.moments", "16"}}},
        SceneCase{"VsmGaussian", "cube-room", {{"filter.kind", "gaussian"}, {"filter.size", "7"}}},
        SceneCase{"VsmRepeated", "cube-room", {{"map.wrap", "repeat"}}},
        SceneCase{"VsmClamped", "cube-room", {{"map.wrap", "clamp_to_edge"}, {"map.format", "16"}}},
        SceneCase{"VsmOffset", "cube-room", {{"bias.normal_offset", "0.05"}}},
        SceneCase{"VsmSpot", "spot-room", {{"map.extent_m", "auto"}}},
        SceneCase{"VsmHalved", "cube-room", {{"lookup.level", "1"}}},
        SceneCase{"VsmHalvedThriceAndClamped",
                  "cube-room",
                  {{"lookup.level", "3"}, {"map.wrap", "clamp_to_edge"}, {"map.extent_m", "2"}}},
        SceneCase{"MsmHalvedTwiceUnderASpot",
                  "spot-room",
                  {{"lookup.kind", "msm"}, {"lookup.level", "2"}, {"filter.kind", "none"}, {"map.extent_m", "auto"}}},
        SceneCase{"EsmHalvedInHalfFloats",
                  "cube-room",
                  {{"lookup.kind", "esm"},
                   {"lookup.exponent", "11"},
                   {"lookup.level", "1"},
                   {"filter.kind", "gaussian"},
                   {"map.wrap", "repeat"},
                   {"map.moments", "16f"}}},
        SceneCase{"Esm", "cube-room", {{"lookup.kind", "esm"}}},
        SceneCase{"EsmHalf", "cube-room", {{"lookup.kind", "esm"}, {"lookup.exponent", "11"}, {"map.moments", "16f"}}},
        SceneCase{"Evsm2", "pillars", {{"lookup.kind", "evsm2"}, {"map.extent_m", "auto"}}},
        SceneCase{"Evsm4", "pillars", {{"lookup.kind", "evsm4"}, {"lookup.floor", "1e-4"}, {"map.extent_m", "auto"}}},
        SceneCase{"Msm", "cube-room", {{"lookup.kind", "msm"}}},
        SceneCase{"MsmOf2017",
                  "cube-room",
                  {{"lookup.kind", "msm"},
                   {"lookup.moments", "2017"},
                   {"lookup.moment_bias", "6e-5"},
                   {"map.moments", "16"}}},
        SceneCase{
            "MsmOf2015", "cube-room", {{"lookup.kind", "msm"}, {"lookup.moments", "2015"}, {"map.moments", "16"}}},
        SceneCase{"MsmHausdorff", "cube-room", {{"lookup.kind", "msm_hausdorff"}}},
        SceneCase{"BabylonEsm",
                  "cube-room",
                  {{"lookup.kind", "babylon_esm"}, {"lookup.exponent", "50"}, {"bias.constant", "0.02"}}},
        SceneCase{"BabylonEsmHalf",
                  "cube-room",
                  {{"lookup.kind", "babylon_esm"}, {"lookup.exponent", "50"}, {"map.moments", "16f"}}},
        SceneCase{"BabylonCloseEsm",
                  "cube-room",
                  {{"lookup.kind", "babylon_close_esm"}, {"lookup.exponent", "87"}, {"map.moments", "16"}}},
        SceneCase{"ThreeVsm", "cube-room", {{"lookup.kind", "three_vsm"}, {"filter.kind", "none"}}},
        SceneCase{"ThreeVsmAsShown",
                  "cube-room",
                  {{"lookup.kind", "three_vsm"},
                   {"filter.kind", "none"},
                   {"lookup.radius", "4"},
                   {"lookup.reduction", "0.3"},
                   {"lookup.reduction_span", "0.65"},
                   {"map.moments", "16f"},
                   {"bias.constant", "0.002"}}},
        SceneCase{"ThreeVsmRepeated",
                  "cube-room",
                  {{"lookup.kind", "three_vsm"},
                   {"filter.kind", "none"},
                   {"lookup.radius", "2.5"},
                   {"lookup.samples", "5"},
                   {"map.wrap", "repeat"}}}),
    [](const auto& test) { return test.param.name; });

// R4 from the exact map, blurred and blended as OpenGL defines it, in double and texel by texel.
class BlurredMap {
 public:
  BlurredMap(const MeasuredMap& map, const Settings& s)
      : depth_(map.exact),
        wrap_(s.map.wrap),
        size_(s.filter.whole("size")),
        block_(1 << s.lookup.whole("level")),
        texels_(depth_.size() / block_) {}

  // (mean, mean of the squares) of a texel, as the sampler finds it.
  glm::dvec2 at(glm::ivec2 texel) const {
    const glm::ivec2 read = wrapped(texel, texels_, wrap_);
    return read.x < 0 ? glm::dvec2(1) : blurred(read);
  }
  glm::dvec2 fetched(glm::vec2 map_texels) const {
    const glm::dvec2 at_centre = glm::dvec2(map_texels) / static_cast<double>(block_) - 0.5;
    const glm::ivec2 corner(glm::floor(at_centre));
    const glm::dvec2 s = glm::dvec2(at_centre) - glm::dvec2(corner);
    return glm::mix(glm::mix(at(corner), at(corner + glm::ivec2(1, 0)), s.x),
                    glm::mix(at(corner + glm::ivec2(0, 1)), at(corner + 1), s.x), s.y);
  }

 private:
  glm::dvec2 blurred(glm::ivec2 middle) const {
    glm::dvec2 sum(0);
    for (int v = -size_ / 2; v <= size_ / 2; ++v)
      for (int u = -size_ / 2; u <= size_ / 2; ++u) {
        const glm::ivec2 read = wrapped(middle + glm::ivec2(u, v), texels_, wrap_);
        sum += read.x < 0 ? glm::dvec2(1) : mean_of_block(read);
      }
    return sum / static_cast<double>(size_ * size_);
  }
  // Of the texels of the map that a texel of the level covers.
  glm::dvec2 mean_of_block(glm::ivec2 texel) const {
    glm::dvec2 sum(0);
    for (int y = 0; y < block_; ++y)
      for (int x = 0; x < block_; ++x) {
        const glm::ivec2 read = block_ * texel + glm::ivec2(x, y);
        EXPECT_TRUE(depth_.texels->has(read));  // what is not in the set has a depth of 1
        const auto depth = static_cast<double>(depth_.at(read));
        sum += glm::dvec2(depth, depth * depth);
      }
    return sum / static_cast<double>(block_ * block_);
  }

  const MapDepths& depth_;
  Wrap wrap_;
  int size_, block_;
  glm::ivec2 texels_;
};

TEST(MomentLadder, IsThatOfTheBlurredMapAlsoAcrossItsBorder) {
  Workbench bench(gl::DebugMode::fatal);
  for (const auto& [wrap, level, extent_m] :
       {std::tuple("clamp_to_border", "0", "8"), std::tuple("clamp_to_edge", "0", "8"), std::tuple("repeat", "0", "8"),
        std::tuple("clamp_to_border", "2", "8"), std::tuple("clamp_to_edge", "1", "2"),
        std::tuple("repeat", "3", "2")}) {
    const Settings s = with_moments(
        {{"map.wrap", wrap}, {"lookup.level", level}, {"map.extent_m", extent_m}, {"map.lit_beyond_far", "false"}});
    const Measurement m = of_moments(bench, s);
    const BlurredMap map(m.maps.front(), s);
    size_t compared = 0, at_border = 0;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      if (!(m.ladder.flags[i] & flag_facing)) continue;
      const LookupProbe& probe = m.maps.front().probe;
      const glm::dvec2 b = map.fetched(probe.map_texels[i]);
      const double d = static_cast<double>(probe.reference[i]), variance = std::max(b.y - b.x * b.x, 1e-7);
      const double lit = d <= b.x ? 1 : variance / (variance + (d - b.x) * (d - b.x));
      // The variance from moments in double has 2^-53 of a square; a float keeps 2^-24 of the result.
      const double gap = std::max(std::abs(d - b.x), 1e-9);
      EXPECT_NEAR(m.ladder[Rung::on_exact_map][i], lit, 1e-6 + 1e-15 / (gap * gap)) << wrap << " " << level << " " << i;
      ++compared;
      const glm::vec2 edge = glm::min(probe.map_texels[i], 128.0f - probe.map_texels[i]);
      at_border += std::abs(std::min(edge.x, edge.y)) < 1;
    }
    EXPECT_GT(compared, 5000u);
    EXPECT_GT(at_border, 30u) << wrap;
  }
}

// Each level halves the map that is blurred.
TEST(MomentLevel, BlursMoreAndCostsLess) {
  Workbench bench(gl::DebugMode::fatal);
  std::map<int, double> filter;
  std::map<int, FrameCost> cost;
  for (const int level : {0, 1, 2, 3}) {
    const Settings s = with_moments({{"lookup.level", std::to_string(level)}, {"map.resolution", "256"}});
    const Measurement m = of_moments(bench, s);
    filter[level] = metric(m, "filter");
    const LightFrame& frame = m.maps.front().technique.frame;
    cost[level] = frame_cost(s, 1, frame.texels(), 0, 1);
    EXPECT_EQ(frame.texel_block, 1 << level);
  }
  for (const int level : {1, 2, 3}) {
    EXPECT_GT(filter[level], 1.3 * filter[level - 1]) << level;
    EXPECT_LT(cost[level].texel_work, cost[level - 1].texel_work) << level;
    EXPECT_LT(cost[level].map_bytes, cost[level - 1].map_bytes) << level;
  }
}

// A setting of the level is a setting of the blur: a bench that measured another level before gives the same numbers.
TEST(MomentLevel, IsMeasuredAnewAfterAnotherOne) {
  Workbench used(gl::DebugMode::fatal);
  for (const char* level : {"0", "2", "1"}) {
    // So that another level is also another map.
    const Settings s = with_moments({{"lookup.level", level},
                                     {"map.snap", "true"},
                                     {"map.fit", "sphere"},
                                     {"map.reach_m", "25"},
                                     {"map.extent_m", "auto"}});
    Workbench fresh(gl::DebugMode::fatal);
    const std::map<std::string, double> again = of_moments(used, s).record.metrics;
    for (const auto& [name, value] : of_moments(fresh, s).record.metrics)
      if (!name.starts_with("truth_by_")) {
        EXPECT_EQ(again.at(name), value) << level << " " << name;
      }
  }
}

// Light-bleed reduction is arithmetic on the result, so it needs no other lookup.
TEST(MomentLadder, ReducesAfterTheLookup) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement whole = of_moments(bench, with_moments());
  const Measurement reduced = of_moments(bench, with_moments({{"lookup.reduction", "0.25"}}));
  for (size_t i = 0; i < whole.ladder.flags.size(); ++i) {
    const float shown = whole.ladder.shown()[i];
    EXPECT_EQ(reduced.ladder.shown()[i], std::clamp((shown - 0.25f) / 0.75f, 0.0f, 1.0f)) << i;
  }
  EXPECT_LT(metric(reduced, "leak"), metric(whole, "leak"));
  EXPECT_GT(metric(reduced, "reduction"), 0);
  EXPECT_EQ(metric(whole, "reduction"), 0);
}

// A floor lights what is near its caster, as a bias does.
TEST(MomentLadder, BooksWhatAFloorLiftsAsPeterPanning) {
  Workbench bench(gl::DebugMode::fatal);
  EXPECT_EQ(metric(of_moments(bench, with_moments({{"lookup.v_min", "0"}})), "peter_panning"), 0);
  const double low = metric(of_moments(bench, with_moments({{"lookup.v_min", "1e-3"}})), "peter_panning");
  EXPECT_GT(low, 1e-5);
  EXPECT_GT(metric(of_moments(bench, with_moments({{"lookup.v_min", "1e-2"}})), "peter_panning"), 2 * low);
}

// Where the map ends its border is lit, whatever casts a shadow there.
TEST(MomentLadder, BooksWhatLiesOutsideTheMapAsCoverage) {
  Workbench bench(gl::DebugMode::fatal);
  EXPECT_GT(metric(of_moments(bench, with_moments({{"map.extent_m", "2"}})), "coverage_light"), 0.005);
}

// llvmpipe divides and rounds as the host does: without exponentials the lookup is the host's arithmetic, bit for bit.
class MomentFormula : public testing::TestWithParam<const char*> {};
TEST_P(MomentFormula, IsLitAsTheHostComputesFromTheSameMoments) {
  Workbench bench(gl::DebugMode::fatal);
  if (!bench.device().software) GTEST_SKIP() << "a GPU may divide with an error";
  const Settings s = with_moments({{"lookup.kind", GetParam()}});
  const Measurement m = of_moments(bench, s);
  const Technique technique(m.scene, s);
  gl::Renderer renderer(gl::DebugMode::fatal);
  renderer.load_scene(m.scene);
  renderer.load_receivers(m.receivers, m.camera.eye_m);
  const gl::ShadowMap map = renderer.render_map(technique);
  const MomentEvidence moments = renderer.read_moments(map, {&technique, 1}, *m.maps.front().exact.texels);
  const Image<float> lit = renderer.lookup(map, technique);
  size_t partly = 0;
  for (size_t i = 0; i < lit.size(); ++i) {
    const LookupProbe& probe = m.maps.front().probe;
    if (!(m.ladder.flags[i] & flag_facing) || probe.reference[i] > 1) continue;
    EXPECT_EQ(lit[i], technique.moments->lit(moments.fetched[i], probe.reference[i])) << i;
    partly += lit[i] > 0.1f && lit[i] < 0.9f;
  }
  EXPECT_GT(partly, 100u);
}
INSTANTIATE_TEST_SUITE_P(, MomentFormula, testing::Values("vsm", "msm", "msm_hausdorff"),
                         [](const auto& test) { return std::string(test.param); });

// Cascades, and a motion: the lookup is another, and all else is as of any lookup.
TEST(MomentLadder, HasCascadesAndFlickers) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement cascades = of_moments(bench, with({{"lookup.kind", "vsm"},
                                                       {"filter.kind", "box"},
                                                       {"cascades.count", "3"},
                                                       {"cascades.blend", "0.2"},
                                                       {"map.resolution", "128"},
                                                       {"map.fit", "sphere"}},
                                                      small("pillars", 200, 120)));
  for (const char* stage : {"contract_store", "contract_blur", "contract_fetch", "contract_lit"})
    EXPECT_EQ(metric(cascades, stage), 0) << stage;
  EXPECT_LE(metric(cascades, "below_comparison"), 1e-9);
  EXPECT_LE(metric(cascades, "residual"), rounding_of_steps);
  EXPECT_GT(metric(cascades, "over_darkening") + metric(cascades, "leak"), 0);
  EXPECT_EQ(cascades.record.cascades.size(), 3u);

  const Measurement moved =
      of_moments(bench, with_moments({{"motion.move_m", "0.1,0,0"}, {"map.fit", "view"}, {"map.extent_m", "auto"}}));
  EXPECT_GT(metric(moved, "flicker"), 0);
}

// With taps on the texels and a receiver at a texel's centre three.js's passes are a variance shadow map; between them its
// fetches blend deviations, so it has less variance and so less light. Both are of one map, and compare alike.
TEST(LookAlikes, OfThreeJsIsNearlyAVarianceShadowMapOfTheSameTexels) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement three = of_moments(
      bench,
      with_moments(
          {{"lookup.kind", "three_vsm"}, {"filter.kind", "none"}, {"lookup.radius", "2"}, {"lookup.samples", "5"}}));
  const Measurement vsm = of_moments(bench, with_moments());
  EXPECT_NEAR(metric(three, "filter"), metric(vsm, "filter"), 1e-7);
  EXPECT_NEAR(metric(three, "error"), metric(vsm, "error"), 0.1 * metric(vsm, "error"));
  size_t darker = 0, lighter = 0;
  for (size_t i = 0; i < three.ladder.flags.size(); ++i) {
    EXPECT_NEAR(three.ladder[Rung::snapped][i], vsm.ladder[Rung::snapped][i], 1e-6f) << i;
    const float difference = three.ladder[Rung::on_exact_map][i] - vsm.ladder[Rung::on_exact_map][i];
    darker += difference<-1e-6f, lighter += difference> 1e-6f;
  }
  EXPECT_GT(darker, 100u);
  EXPECT_EQ(lighter, 0u);
}

// Babylon.js's exponential shadow map stores e^(-c z): a wall is dark in its own shadow map, and a bias b lights it by
// 1 - e^(-c b). Its close form stores the depth, so it is lit there.
TEST(LookAlikes, OfBabylonAreDarkWhereTheyCastAndLitWhereTheMapIsEmpty) {
  Workbench bench(gl::DebugMode::fatal);
  const auto lit = [&](const char* kind, const char* bias) {
    const Measurement m = of_moments(bench, with_moments({{"scene.name", "plane"},
                                                          {"lookup.kind", kind},
                                                          {"lookup.exponent", "50"},
                                                          {"bias.constant", bias},
                                                          {"filter.kind", "none"},
                                                          {"map.extent_m", "auto"},
                                                          {"map.resolution", "2048"}}));
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i)
      if (is_counted(m.ladder, i) && m.ladder[Rung::truth][i] == 1 && ++count) sum += m.ladder.shown()[i];
    EXPECT_GT(count, 1000u);
    return sum / static_cast<double>(count);
  };
  EXPECT_LT(lit("babylon_esm", "0"), 0.02);
  EXPECT_NEAR(lit("babylon_esm", "0.01"), 1 - std::exp(-0.5), 0.02);
  EXPECT_GT(lit("babylon_close_esm", "0"), 0.98);
}

// The curve over the reduction is what measuring each reduction gives, also where the map's edge crosses the picture.
TEST(MomentCurve, HasTheNumbersOfMeasuringEachReduction) {
  Workbench bench(gl::DebugMode::fatal);
  for (const std::vector<Assignment>& set : {std::vector<Assignment>{{"lookup.v_min", "1e-4"}},
                                             {{"lookup.kind", "evsm4"}, {"bias.constant", "0.002"}},
                                             {{"map.extent_m", "2"}, {"map.wrap", "clamp_to_edge"}}}) {
    const Settings settings = with(set, with_moments());
    const std::vector<LookupCurvePoint> curve = bench.measure(settings, CurveOptions{}).record.lookup_curve;
    ASSERT_EQ(curve.size(), 100u);
    for (const size_t percent : {0u, 7u, 40u, 90u}) {
      Settings one = settings;
      one.lookup["reduction"] = static_cast<double>(percent) / 100;
      const Measurement m = bench.measure(one, std::nullopt);
      EXPECT_TRUE(m.record.lookup_curve.empty());
      const LookupCurvePoint& at = curve[percent];
      EXPECT_EQ(at.parameter, "lookup.reduction");
      EXPECT_NEAR(at.value, one.lookup["reduction"], 1e-15);
      constexpr double of_images = 0x1p-24;  // the ladder's images are floats
      EXPECT_NEAR(at.error, error_on_exact_map(m.ladder), of_images) << percent;
      EXPECT_NEAR(at.leak, metric(m, "leak"), of_images) << percent;
      EXPECT_NEAR(at.over_darkening, metric(m, "over_darkening"), of_images) << percent;
      EXPECT_NEAR(at.peter_panning, metric(m, "peter_panning"), of_images) << percent;
      EXPECT_NEAR(at.reduction, metric(m, "reduction"), of_images) << percent;
      EXPECT_NEAR(at.aliasing_dark, metric(m, "aliasing_dark"), of_images) << percent;
      EXPECT_NEAR(at.aliasing_light, metric(m, "aliasing_light"), of_images) << percent;
      EXPECT_NEAR(at.coverage, metric(m, "coverage_dark") + metric(m, "coverage_light"), of_images) << percent;
      // The shader divides in floats.
      EXPECT_NEAR(at.shown_error, metric(m, "error"), 4 * of_images) << percent;
      EXPECT_NEAR(at.shown_error_soft, metric(m, "error_soft"), 4 * of_images) << percent;
    }
  }
}

// Another number of the lookup: the curve is what measuring each value gives, with OpenGL's rounding too. Of several formulas, with
// half floats, where the map's edge crosses the picture, and of two cascades with a bias in texels.
TEST(MomentCurve, HasTheNumbersOfMeasuringEachValueOfAnotherSetting) {
  Workbench bench(gl::DebugMode::fatal);
  struct Case {
    const char* over;
    std::vector<double> values;
    std::vector<Assignment> set;
  };
  for (const Case& one :
       {Case{"lookup.v_min", {0, 1e-6, 1e-3}, {{"map.moments", "16f"}}},
        {"lookup.v_min", {1e-7, 1e-3}, {{"lookup.kind", "three_vsm"}, {"filter.kind", "none"}}},
        {"lookup.floor", {0, 1e-3, 0.1}, {{"lookup.kind", "evsm4"}, {"lookup.reduction", "0.2"}}},
        {"lookup.moment_bias", {0, 1e-5, 0.01}, {{"lookup.kind", "msm"}, {"map.moments", "16f"}}},
        {"bias.constant", {0, 1e-3, 0.01}, {{"lookup.kind", "esm"}, {"map.extent_m", "2"}}},
        {"bias.constant",
         {0, 0.5, 4},
         {{"bias.unit", "texel"}, {"map.fit", "view"}, {"map.extent_m", "auto"}, {"cascades.count", "2"}}}}) {
    const Settings settings = with(one.set, with_moments());
    CurveOptions options;
    options.over = {one.over, one.values};
    const std::vector<LookupCurvePoint> curve = bench.measure(settings, options).record.over_curve;
    std::vector<double> values;
    for (const LookupCurvePoint& at : curve) {
      SCOPED_TRACE(fmt::format("{} = {}", one.over, at.value));
      EXPECT_EQ(at.parameter, one.over);
      values.push_back(at.value);
      const Measurement m = bench.measure(with_value(settings, one.over, at.value), std::nullopt);
      constexpr double of_images = 0x1p-24;  // the ladder's images are floats
      EXPECT_NEAR(at.error, error_on_exact_map(m.ladder), of_images);
      EXPECT_NEAR(at.leak, metric(m, "leak"), of_images);
      EXPECT_NEAR(at.over_darkening, metric(m, "over_darkening"), of_images);
      EXPECT_NEAR(at.peter_panning, metric(m, "peter_panning"), of_images);
      EXPECT_NEAR(at.reduction, metric(m, "reduction"), of_images);
      // A device may divide with other roundings than the host, within the contract of the lookup (contract_lit).
      EXPECT_NEAR(at.shown_error, metric(m, "error"), 1e-6);
      EXPECT_NEAR(at.shown_error_soft, metric(m, "error_soft"), 1e-6);
      EXPECT_NEAR(at.aliasing_dark, metric(m, "aliasing_dark"), of_images);
      EXPECT_NEAR(at.aliasing_light, metric(m, "aliasing_light"), of_images);
    }
    EXPECT_EQ(values, values_of(options.over, settings)) << "and the value as set";
    EXPECT_GE(values.size(), one.values.size());
  }
}

TEST(MomentCurve, OverAnotherSettingIsOfPointsThatReadIt) {
  const Settings vsm = with_moments();
  EXPECT_TRUE(has_curve_over(vsm, "lookup.v_min"));
  EXPECT_TRUE(has_curve_over(vsm, "bias.constant"));
  EXPECT_FALSE(has_curve_over(vsm, "lookup.floor"));
  EXPECT_FALSE(has_curve_over(vsm, ""));
  EXPECT_FALSE(has_curve_over(Settings(), "bias.constant")) << "a comparison has the bias curve";
  EXPECT_TRUE(has_reduction_curve(vsm));
  EXPECT_FALSE(has_reduction_curve(Settings()));
  EXPECT_FALSE(has_reduction_curve(with({{"lookup.reduction", "0.3"}, {"lookup.reduction_span", "0.65"}}, vsm)));
  const Settings blended = with({{"cascades.count", "2"}, {"cascades.blend", "0.1"}}, vsm);
  EXPECT_FALSE(has_reduction_curve(blended));
  EXPECT_FALSE(has_curve_over(blended, "lookup.v_min"));
  EXPECT_EQ(usual_values("lookup.v_min", BiasUnit::depth).front(), 0);
  for (const std::string_view setting : curve_settings())
    for (const BiasUnit unit : {BiasUnit::depth, BiasUnit::m, BiasUnit::texel})
      for (const double value : usual_values(setting, unit)) {
        Settings set;
        EXPECT_NO_THROW(find_setting(setting).set(set, fmt::format("{}", value))) << setting << " " << value;
      }
}

// What OpenGL shows at a larger reduction follows from what it shows at a smaller one. At a smaller one it is not known how far
// below the reduction a bound was that became 0: the exact bound stands for it.
TEST(MomentCurve, HasTheErrorsThatAreShownAtOtherReductions) {
  Workbench bench(gl::DebugMode::fatal);
  Settings settings = with_moments({{"light.angular_diameter_deg", "4"}, {"lookup.reduction", "0.2"}});
  const PointRecord record = bench.measure(settings, CurveOptions{}).record;
  ASSERT_EQ(record.lookup_curve.size(), 100u);
  EXPECT_EQ(record.lookup_bounds, CauseBounds());
  constexpr double of_images = 0x1p-24;  // the ladder's images are floats, and the shader divides in them
  for (const size_t percent : {20u, 45u, 0u, 10u}) {
    settings.lookup["reduction"] = static_cast<double>(percent) / 100;
    const Measurement m = bench.measure(settings, std::nullopt);
    EXPECT_FALSE(m.record.lookup_bounds);
    const LookupCurvePoint& at = record.lookup_curve[percent];
    EXPECT_NE(metric(m, "error_soft"), metric(m, "error"));
    // Below 0.2 OpenGL's own rounding of the bounds that it turned to 0 is missing.
    const double allowed =
        percent >= 20 ? 4 * of_images : metric(m, "moment_precision") + metric(m, "precision") + 4 * of_images;
    EXPECT_NEAR(at.shown_error, metric(m, "error"), allowed) << percent;
    EXPECT_NEAR(at.shown_error_soft, metric(m, "error_soft"), allowed) << percent;
  }
}

TEST(MomentSettings, AreRefusedWhereALookupCannotReadThem) {
  const auto why = [](const std::vector<Assignment>& more) {
    try {
      validate(with_moments(more), LightKind::directional);
    } catch (const SettingConflict& conflict) {
      return conflict.setting() + ": " + conflict.what();
    }
    return std::string();
  };
  EXPECT_EQ(why({}), "");
  EXPECT_EQ(why({{"lookup.reduction", "0.35"}, {"lookup.reduction_span", "0.65"}}), "");
  // It stores e^(-c z), which is at most 1.
  EXPECT_EQ(why({{"lookup.kind", "babylon_esm"}, {"lookup.exponent", "50"}, {"map.moments", "16f"}}), "");
  for (const auto& [settings, says] : std::vector<std::pair<std::vector<Assignment>, std::string>>{
           {{{"filter.kind", "poisson"}},
            "lookup.kind: lookup.kind = vsm reads a map that is blurred before the lookup"},
           {{{"lookup.kind", "three_vsm"}}, "set filter.kind = none"},
           {{{"filter.kind", "hardware"}}, "take filter.kind none, box or gaussian"},
           {{{"filter.step_texels", "2"}}, "set filter.step_texels = 1"},
           {{{"bias.reference", "receiver_plane"}}, "set bias.reference = own_depth"},
           {{{"bias.polygon_units", "4"}}, "bias.polygon_units moves the casters"},
           {{{"lookup.kind", "evsm2"}, {"map.moments", "16"}}, "map.moments = 16 holds numbers from 0 to 1"},
           {{{"lookup.kind", "msm"}, {"map.moments", "16"}}, "with lookup.moments = plain; set lookup.moments = 2017"},
           {{{"lookup.reduction", "0.3"}, {"lookup.reduction_span", "0.75"}}, "(1 - 0.3) / 0.75 = 0.933"},
           {{{"lookup.kind", "evsm4"}, {"map.moments", "16f"}}, "so it goes up to 5.545"},
           {{{"lookup.kind", "esm"}, {"map.moments", "16f"}}, "so it goes up to 11.09"},
           {{{"lookup.kind", "evsm2"}, {"lookup.exponent", "50"}}, "above 44.36"}})
    EXPECT_NE(why(settings).find(says), std::string::npos) << why(settings);
  EXPECT_THROW(validate(with_moments(), LightKind::point), SettingConflict);
}

}  // namespace
}  // namespace noonmark::acceptance
