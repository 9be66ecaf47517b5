// The metrics compared with values that were calculated by hand.
#include "compare/ladder/measure.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "compare/ladder/law_metrics.h"
#include "compare/store/metrics.h"
#include "scenes/error.h"
#include "scenes/receivers.h"
#include "tests/support/bias_of.h"

namespace noonmark {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan_float = std::numeric_limits<float>::quiet_NaN();

// A picture whose receivers all face the light, are lit and are right.
struct Picture {
  explicit Picture(int width, int height) {
    ladder = empty_ladder(width, height);
    for (Ladder::RungImage& rung : ladder.rungs) rung.lit = Image<float>(width, height, 1);
    ladder.cause = Image<uint8_t>(width, height, 0);
    ladder.flags = Image<uint8_t>(width, height, flag_facing);
    ladder.doubt = Image<float>(width, height, 0);
    receivers = {Image<glm::vec3>(width, height, glm::vec3(0, 0, -2)),
                 Image<glm::vec3>(width, height, glm::vec3(0, 0, 1)), Image<uint32_t>(width, height, 0)};
    edge = occluder = Image<float>(width, height, nan_float);  // must not be read for pixels that are right
    probe.n_dot_l = probe.bias_unit = probe.tan_theta = Image<float>(width, height, 1);
    probe.pattern.offsets = {glm::vec3(0)};
    frame.extent_m = 5;
    frame.resolution = 10;
    frame.far_m = 10;
  }
  void rungs(int x, int y, std::array<float, 6> r) {
    for (size_t n = 0; n < 6; ++n) ladder.rungs[n].lit.at(x, y) = r[n];
  }
  void step(int x, int y, Cause cause, float size) {
    ladder[cause].at(x, y) = size;
    ladder.cause.at(x, y) = static_cast<uint8_t>(cause);
  }
  std::map<std::string, double> metrics() const {
    return measure_ladder({ladder, receivers, frame, probe, bias, edge, occluder});
  }
  double metric(const char* name) const { return metrics().at(name); }

  Ladder ladder;
  ReceiverImage receivers;
  LookupProbe probe;
  Image<float> edge, occluder;
  LightFrame frame;                        // texels of 0.5 m
  Bias bias = bias_of({{"constant", 1}});  // 1 of the map's 10 m: nearly every occluder is within reach
};

void attach(Picture& p, int x, int y) {
  p.ladder.flags.at(x, y) = 0;
  for (Ladder::RungImage& rung : p.ladder.rungs) rung.lit.at(x, y) = 0;
}

TEST(Measure, GivesSharesOfTheCountedReceivers) {
  Picture p(4, 3);
  p.receivers.primitive.at(0, 0) = no_primitive;  // background
  attach(p, 0, 0);
  attach(p, 1, 0);  // a receiver that faces away
  p.ladder.flags.at(2, 0) |= flag_ambiguous;
  p.rungs(2, 0, {0, 1, 1, 1, 0, 0});
  p.step(2, 0, Cause::acne, -1);
  p.ladder.flags.at(3, 0) |= flag_ambiguous;
  // Nine counted receivers are left.
  p.ladder.flags.at(3, 0) &= static_cast<uint8_t>(~flag_ambiguous);
  p.rungs(0, 1, {0.5f, 1, 0.75f, 1, 0.25f, 0.5f});
  p.step(0, 1, Cause::light_size, 0.5f);
  p.step(0, 1, Cause::filter, -0.25f);
  p.step(0, 1, Cause::displacement, 0.125f);
  p.step(0, 1, Cause::acne, -0.75f);
  p.step(0, 1, Cause::aliasing_light, 0.25f);
  p.step(0, 1, Cause::aliasing_dark, -0.125f);
  p.edge.at(0, 1) = 1.5f;
  p.step(0, 1, Cause::precision, 0.25f);
  p.step(2, 2, Cause::peter_panning, 0.25f);  // at a lit receiver
  p.step(1, 1, Cause::peter_panning, 0.25f);  // at a dark one
  p.occluder.at(1, 1) = 100;                  // beyond the reach of the bias, so no gap
  p.rungs(1, 1, {0, 0, 0, 0, 1, 1});
  p.step(1, 1, Cause::coverage_light, 1);
  p.ladder.flags.at(1, 1) |= flag_outside;
  p.rungs(2, 1, {1, 1, 1, 0, 0, 0});
  p.step(2, 1, Cause::aliasing_dark, -1);
  p.edge.at(2, 1) = 0.5f;
  p.rungs(3, 1, {1, 1, 1, 1, 0, 0});
  p.step(3, 1, Cause::coverage_dark, -1);
  p.ladder.flags.at(3, 1) |= flag_outside;
  p.ladder.residual = 2e-7;
  p.ladder.tap_residual = 3e-7;
  p.ladder.flags.at(2, 1) |= flag_undecided;
  p.ladder.doubt.at(2, 1) = 0.5f;
  p.ladder[Cause::undecided].at(2, 1) = -0.125f;

  const double base = 9;
  const std::map<std::string, double> expected = {
      {"error", (0.5 + 1 + 1 + 1) / base},
      {"error_soft", (0 + 1 + 1 + 1) / base},
      {"wrong", 4 / base},
      {"light_size", 0.5 / base},
      {"filter", 0.25 / base},
      {"displacement", 0.125 / base},
      {"aliasing", 1.375 / base},
      {"aliasing_dark", 1.125 / base},
      {"aliasing_light", 0.25 / base},
      {"aliasing_rms", std::sqrt((0.125 * 0.125 + 1) / base)},
      {"acne", 0.75 / base},
      {"peter_panning", 0.5 / base},
      {"peter_panning_lit", 0.25 / base},
      {"coverage", 2 / base},
      {"coverage_dark", 1 / base},
      {"coverage_light", 1 / base},
      {"precision", 0.25 / base},
      {"undecided", 0.125 / base},
      {"undecided_taps", 0.5 / base},
      {"undecided_receivers", 1},
      {"peter_panning_gap_m", 0},
      {"edge_displacement_texels", 1.5},
      {"edge_displacement_mean_texels", 1},
      {"edge_displacement_pixels", std::sqrt(2.0) - std::sqrt(2.0) + 1},  // from (2, 1) to the dark (1, 1)
      {"receivers", 11},
      {"facing", 10},
      {"counted", base},
      {"attached", 1},
      {"lit", 8 / base},
      {"ambiguous", 0.1},
      {"outside", 2 / base},
      {"ambiguous_receivers", 1},
      {"outside_receivers", 2},
      {"residual", 2e-7},
      {"tap_residual", 3e-7},
  };
  const std::map<std::string, double> found = p.metrics();
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [name, value] : expected) EXPECT_DOUBLE_EQ(found.at(name), value) << name;
}

TEST(Measure, GapIsTheLightsWayAlongTheReceiver) {
  Picture p(3, 1);
  // theta is 30 and 60 degrees: distances of 2 m and 1 m along the light are gaps of 1 m and 0.866 m.
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(0, 0) = std::sqrt(0.75f);
  p.occluder.at(0, 0) = 2;
  p.rungs(1, 0, {0, 0, 0, 0, 1, 1});
  p.step(1, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(1, 0) = 0.5f;
  p.occluder.at(1, 0) = 1;
  constexpr double cosine_rounding = 1e-6;  // the sine is computed from the float cosine
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 1, cosine_rounding);
  p.occluder.at(0, 0) = 0.5f;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), std::sqrt(0.75), cosine_rounding);
  p.probe.n_dot_l.at(1, 0) = 1 + 0x1p-23f;  // a cosine above 1, caused by rounding, must not give NaN
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 0.25, cosine_rounding);
}

TEST(Measure, GapEndsWhereTheBiasCannotReach) {
  Picture p(1, 1);
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(0, 0) = std::sqrt(0.5f);  // 45 degrees: a texel of 0.5 m adds at most 0.5 / sqrt(2) m of depth
  p.bias = bias_of({{"constant", 0.1}});       // of the map's 10 m: 1 m
  p.occluder.at(0, 0) = 1.3f;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 1.3 * std::sqrt(0.5), 1e-6);
  p.occluder.at(0, 0) = 1.4f;  // for example a steep receiver at the edge of a distant shadow
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
}

// An offset d along the normal moves the place looked up by d / cos(theta) along the light.
TEST(Measure, GapEndsWhereTheNormalOffsetCannotReach) {
  Picture p(1, 1);
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(0, 0) = 0.5f;  // 60 degrees: a texel of 0.5 m adds at most 0.5 / sqrt(2) m times tan(theta)
  p.bias = bias_of({{"normal_offset", 1.5}});
  const float reach = 0.75f / 0.5f + static_cast<float>(0.5 * std::sqrt(0.5) * std::sqrt(3.0));
  p.occluder.at(0, 0) = reach - 0.01f;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), (reach - 0.01) * std::sqrt(0.75), 1e-6);
  p.occluder.at(0, 0) = reach + 0.01f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
}

// The reach of a bias under a spot light ends where the depth on the same ray is less by the bias.
TEST(Measure, GapUnderASpotLightEndsWhereTheDepthDoes) {
  Picture p(1, 1);
  p.frame = LightFrame{};
  p.frame.kind = LightKind::spot;
  p.frame.near_m = 0.5;
  p.frame.far_m = 20;
  p.frame.tan_half_fov = 0.5;
  p.frame.resolution = 1000;
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.receivers.position[0] = {3, 0, -6};
  const double bias = 0.02, z = 6;
  p.bias = bias_of({{"constant", bias}});
  // The receiver is perpendicular to its ray, so within a texel its depth hardly changes.
  double low = p.frame.near_m, high = z;  // bisection for the depth that is less by the bias
  while (high - low > 1e-12)
    (p.frame.tile(0).window_depth((low + high) / 2) > p.frame.tile(0).window_depth(z) - bias ? high : low) =
        (low + high) / 2;
  const double reach = (z - low) * std::sqrt(45.0) / z;
  EXPECT_NEAR(panning_reach_m({p.ladder, p.receivers, p.frame, p.probe, p.bias, p.edge, p.occluder}, 0,
                              p.frame.to_light(p.receivers.position[0])),
              reach, 1e-5);  // the bias rounded to float; half a texel to the side, the plane is 1e-7 of 6.7 m nearer
  EXPECT_GT(z * std::sqrt(45.0) / z - reach, 1) << "the case must be far from linear";
  p.probe.n_dot_l[0] = 0.8f;
  p.occluder[0] = static_cast<float>(reach) + 0.001f;  // a texel of 6 mm, at 37 degrees, adds 3 mm
  EXPECT_GT(p.metric("peter_panning_gap_m"), 0);
  p.occluder[0] = static_cast<float>(reach) + 0.004f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
}

// Under a point light the offsets of the taps are in metres, and rays diverge. The reach includes how much farther the
// plane is along a ray that is turned by the offset. The test computes this intersection.
TEST(Measure, GapUnderAPointLightEndsWhereTheTapsDo) {
  Picture p(1, 1);
  p.frame = LightFrame{};
  p.frame.kind = LightKind::point;
  p.frame.far_m = 20;
  p.frame.resolution = 1 << 14;
  p.probe.pattern.offsets = {glm::vec3(0.3f, 0, 0.4f)};
  p.probe.pattern.in_world = true;
  p.bias = bias_of({{"constant", 0.01}});  // of the map's 20 m: 0.2 m
  p.receivers.position[0] = {0, 0, -4};
  p.probe.n_dot_l[0] = 0.6f;
  const double theta = std::acos(0.6f), turned = theta + std::asin((0.5 + 0.5 * std::sqrt(2.0) * 8 / (1 << 14)) / 4);
  // P = (0, 0, -4), the plane's normal is (0.8, 0, 0.6), and the ray turns to the side where the plane is farther away.
  const double met = 4 * 0.6 / std::cos(turned);
  EXPECT_NEAR(panning_reach_m({p.ladder, p.receivers, p.frame, p.probe, p.bias, p.edge, p.occluder}, 0, {0, 0, -4}),
              0.2 + met - 4, 1e-5);  // rounding of float cosines
  p.probe.n_dot_l[0] = 0.05f;        // 87 degrees: a ray that is turned by 7 degrees misses the plane
  EXPECT_EQ(panning_reach_m({p.ladder, p.receivers, p.frame, p.probe, p.bias, p.edge, p.occluder}, 0, {0, 0, -4}),
            std::numeric_limits<double>::infinity());
}

TEST(Measure, APolygonOffsetReachesAnywhere) {
  Picture p(1, 1);
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.bias = bias_of({{"polygon_factor", 1}, {"polygon_units", 1}});
  p.probe.n_dot_l[0] = 0.6f;
  p.occluder[0] = 100;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 80, 1e-4);
}

TEST(Measure, GapIsOverReceiversInShadow) {
  Picture p(4, 1);
  // With a filter, Peter Panning can occur at a lit receiver beside the edge. Nothing is between it and the light.
  p.rungs(0, 0, {1, 1, 0.5f, 0.5f, 0.75f, 0.75f});
  p.step(0, 0, Cause::peter_panning, 0.25f);
  p.occluder.at(0, 0) = infinity;
  p.probe.n_dot_l.at(0, 0) = 0.5f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
  p.probe.n_dot_l.at(0, 0) = 1;  // 0 * infinity
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
  EXPECT_EQ(p.metric("peter_panning"), 0.0625);  // Peter Panning is still counted
  p.rungs(1, 0, {0, 0, 0.5f, 0.5f, 0.75f, 0.75f});
  p.step(1, 0, Cause::peter_panning, 0.25f);
  p.occluder.at(1, 0) = 2;
  p.probe.n_dot_l.at(1, 0) = 0;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 2);
  p.rungs(2, 0, {0, 0, 0, 0, 1, 1});  // ambiguous: left out
  p.step(2, 0, Cause::peter_panning, 1);
  p.ladder.flags.at(2, 0) |= flag_ambiguous;
  p.occluder.at(2, 0) = 100;
  p.probe.n_dot_l.at(2, 0) = 0;
  p.rungs(3, 0, {0, 0, 0, 0, 0, 0});  // in shadow, which is right
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 2);
  EXPECT_EQ(peter_panning_mask(p.ladder).pixels, (std::vector<uint8_t>{0, 1, 0, 0}));
  // A dark receiver's distance that is not finite is a defect that must show.
  p.occluder.at(1, 0) = infinity;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), infinity);
  p.occluder.at(1, 0) = nan_float;
  EXPECT_TRUE(std::isnan(p.metric("peter_panning_gap_m")));
}

TEST(Measure, EdgeDisplacementIsFromAliasedPixelsOnly) {
  Picture p(5, 4);
  // A shadow of two columns that is wrongly lit in one pixel, and a lit pixel far away that is wrongly dark.
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 2; ++x) p.rungs(x, y, {0, 0, 0, 0, 0, 0});
  p.rungs(0, 0, {0, 0, 0, 1, 1, 1});
  p.step(0, 0, Cause::aliasing_light, 1);
  p.edge.at(0, 0) = 0.5f;
  EXPECT_EQ(p.metric("edge_displacement_pixels"), 2);  // to (2, 0)
  p.rungs(4, 3, {1, 1, 1, 0, 0, 0});
  p.step(4, 3, Cause::aliasing_dark, -1);
  p.edge.at(4, 3) = 2;
  EXPECT_EQ(p.metric("edge_displacement_pixels"), 3);  // to (1, 3)
  EXPECT_EQ(p.metric("edge_displacement_texels"), 2);
  EXPECT_EQ(p.metric("edge_displacement_mean_texels"), 1.25);
  // Receivers that face away do not count as dark. So the two dark columns are not in the picture any more.
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 2; ++x)
      if (x + y > 0) attach(p, x, y);
  attach(p, 2, 0);
  EXPECT_NEAR(p.metric("edge_displacement_pixels"), 5, 1e-6);  // (4, 3) to (0, 0), the one dark receiver left
  p.edge.at(0, 0) = nan_float;
  EXPECT_TRUE(std::isnan(p.metric("edge_displacement_texels")));
  EXPECT_TRUE(std::isnan(p.metric("edge_displacement_mean_texels")));
}

TEST(Measure, LeavesOutPixelsWhoseTruthThePictureDoesNotShow) {
  Picture p(3, 2);  // all are lit and one is wrongly dark, so no dark receiver is in view
  p.rungs(1, 1, {1, 1, 1, 0, 0, 0});
  p.step(1, 1, Cause::aliasing_dark, -1);
  p.edge.at(1, 1) = 1;
  EXPECT_EQ(p.metric("edge_displacement_pixels"), 0);
  EXPECT_EQ(p.metric("edge_displacement_texels"), 1);
}

TEST(Measure, SaysNaNWhereNothingWasCounted) {
  Picture none(2, 1), ambiguous(2, 1), empty(0, 0);
  for (int x = 0; x < 2; ++x) attach(none, x, 0);
  for (uint8_t& flags : ambiguous.ladder.flags.pixels) flags |= flag_ambiguous;
  for (const Picture* p : {&none, &ambiguous, &empty}) {
    for (const auto& [name, value] : p->metrics()) {
      const bool is_count = find_metric(name).unit == "count" || find_metric(name).unit.empty();
      if (name == "ambiguous" && p == &ambiguous)
        EXPECT_EQ(value, 1);
      else
        EXPECT_EQ(std::isnan(value), !is_count) << name;
    }
    EXPECT_EQ(worst_pixel(p->ladder).x, -1);
    EXPECT_EQ(worst_pixel(p->ladder).y, -1);
  }
}

TEST(WorstPixel, IsTheFirstOfTheLargestErrors) {
  Picture p(3, 2);
  EXPECT_EQ(worst_pixel(p.ladder).x, 0);  // if nothing is wrong: the first counted one
  EXPECT_EQ(worst_pixel(p.ladder).error, 0);
  EXPECT_EQ(worst_pixel(p.ladder).cause, "none");
  p.rungs(1, 0, {1, 1, 1, 1, 0.75f, 0.75f});
  p.step(1, 0, Cause::acne, -0.25f);
  p.rungs(2, 0, {0, 0, 0, 0, 0.5f, 0.5f});
  p.step(2, 0, Cause::peter_panning, 0.5f);
  p.rungs(0, 1, {1, 1, 1, 1, 0.5f, 0.5f});
  p.step(0, 1, Cause::acne, -0.5f);
  const auto expect = [&](int x, int y, std::string_view cause) {
    const PointRecord::Worst worst = worst_pixel(p.ladder);
    EXPECT_EQ(worst.x, x);
    EXPECT_EQ(worst.y, y);
    EXPECT_EQ(worst.cause, cause);
  };
  expect(2, 0, "peter_panning");
  EXPECT_EQ(worst_pixel(p.ladder).error, 0.5);
  p.ladder.flags.at(2, 0) |= flag_ambiguous;
  expect(0, 1, "acne");
  p.ladder[Rung::shown].at(2, 1) = nan_float;  // worse than any number
  expect(2, 1, "none");
  p.ladder[Rung::shown].at(1, 1) = infinity;
  expect(2, 1, "none");
  p.ladder[Rung::shown].at(2, 1) = 1;
  expect(1, 1, "none");
  p.ladder[Rung::shown].at(0, 0) = nan_float;
  expect(0, 0, "none");
  attach(p, 0, 0);
  expect(1, 1, "none");
}

TEST(MetricsTable, NamesWhatIsMeasured) {
  const std::set<std::string> times = {"map_ms", "lookup_ms", "shadow_ms"};  // the workbench measures these
  const std::set<std::string_view> units = {"fraction", "m",     "m2",    "depth", "texels", "pixels",
                                            "deg",      "count", "bytes", "ms",    ""};
  std::set<std::string> names;
  for (const Metric& metric : metrics_table()) {
    if (!metric.of_placements) {  // tests/acceptance/placements_test.cpp measures the others
      EXPECT_TRUE(names.insert(std::string(metric.name)).second) << metric.name << " twice";
    }
    EXPECT_TRUE(units.contains(metric.unit)) << metric.unit;
    EXPECT_EQ(metric.unit == "ms", times.contains(std::string(metric.name))) << metric.name;
    EXPECT_TRUE(metric.help.ends_with('.') && metric.help.size() > 10) << metric.name;
    EXPECT_EQ(&find_metric(metric.name), &metric);
  }
  std::set<std::string> measured = times;
  for (const char* name : {"shaded_rmse", "clipped", "culled", "scene_behind", "texel_work", "traffic_bytes", "map_bytes",
                           "map_texels", "map_triangles", "lookup_fetches", "lookup_texels", "lookup_operations"})
    measured.insert(name);  // likewise
  const Picture picture(1, 1);
  for (const auto& [name, value] : picture.metrics()) measured.insert(name);
  const Scene nothing;
  const Camera camera;
  for (const auto& [name, value] : measure_laws(
           {picture.ladder, nothing, picture.receivers, camera, picture.frame, DepthFormat::d24, picture.probe}))
    measured.insert(name);
  // Metrics of compare/judge/soundness.h, which has its own test.
  for (const char* name :
       {"contract", "rounding_excess", "address_error_texels", "reference_error_m", "map_error_quanta", "map_bits"})
    measured.insert(name);
  EXPECT_EQ(names, measured);
  EXPECT_EQ(find_metric("residual").unit, "");
  EXPECT_EQ(find_metric("tap_residual").unit, "");
}

TEST(MetricsTable, SuggestsTheNearestName) {
  try {
    find_metric("peter_paning");
    FAIL() << "found";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_NE(std::string(error.what()).find("did you mean 'peter_panning'?"), std::string::npos) << error.what();
  }
  EXPECT_THROW(find_metric(""), Error);
}

// A picture from another renderer, as a rung on top of the ladder. It is judged instead of R5, and its difference to R5
// has its own cause.
TEST(Measure, OfAPictureFromElsewhereOnTopOfTheLadder) {
  Picture p(3, 1);
  p.rungs(0, 0, {1, 1, 1, 1, 1, 1});  // right at R5
  p.rungs(1, 0, {1, 1, 1, 1, 0, 0});
  p.step(1, 0, Cause::acne, -1);
  p.rungs(2, 0, {1, 1, 1, 1, 0, 0});
  p.step(2, 0, Cause::acne, -1);
  Image<float> picture(3, 1, 0);
  picture.at(0, 0) = 0.75f;  // wrong only here
  picture.at(1, 0) = 1;      // right where R5 is wrong
  picture.at(2, 0) = 0.25f;  // less wrong than R5
  add_rung(p.ladder, {"engine", picture, "elsewhere", "Elsewhere", "From elsewhere."});
  EXPECT_EQ(p.ladder.shown().pixels, picture.pixels);
  EXPECT_EQ(p.ladder.cause_of(0), "elsewhere");
  EXPECT_EQ(p.ladder.cause_of(1), "none");
  EXPECT_EQ(p.ladder.cause_of(2), "acne");
  const std::map<std::string, double> m = p.metrics();
  EXPECT_DOUBLE_EQ(m.at("error"), (0.25 + 0 + 0.75) / 3);
  EXPECT_DOUBLE_EQ(m.at("elsewhere"), (0.25 + 1 + 0.25) / 3);
  EXPECT_DOUBLE_EQ(m.at("acne"), 2.0 / 3) << "the acne of the rung below it must stay";
  const auto refused = [&](const char* rung, const Image<float>& of_rung, const char* cause) {
    EXPECT_THROW(add_rung(p.ladder, {rung, of_rung, cause, "", ""}), std::logic_error) << rung << " " << cause;
  };
  refused("engine", picture, "again");
  refused("other", picture, "elsewhere");
  refused("other", picture, "acne");
  refused("other", picture, "error");               // a metric
  refused("other", picture, "window_width_depth");  // a quantity of the curve
  refused("other", picture, "Not a column");
  refused("other", Image<float>(2, 1, 0), "again");
}

}  // namespace
}  // namespace noonmark
