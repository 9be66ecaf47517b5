// The metrics compared with values that were calculated by hand.
#include "compare/ladder/measure.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "base/error.h"
#include "compare/ladder/law_metrics.h"
#include "compare/ladder/numbers.h"
#include "compare/ladder/step_blocks.h"
#include "compare/results/metrics.h"
#include "scenes/receivers.h"
#include "tests/compare/ladder/measured_picture.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/words.h"

namespace noonmark {
namespace {

// A picture of many blocks: the sums leave out those without steps, and no step.
TEST(StepBlocks, HaveAllStepsOfACause) {
  Picture p(67, 53);
  const auto pixels = static_cast<int>(p.ladder.flags.size());
  Image<float>& acne = p.ladder[Cause::acne];
  acne[0] = 0.5f;
  acne[static_cast<size_t>(pixels - 1)] = -0.25f;
  acne[static_cast<size_t>(pixels / 2)] = std::numeric_limits<float>::quiet_NaN();
  p.ladder[Cause::peter_panning][700] = -0.0f;
  const StepBlocks steps(p.ladder);
  ASSERT_GT(steps.blocks(), 5u);
  std::set<size_t> seen;
  size_t last = 0, visited = 0;
  steps.each(static_cast<size_t>(Cause::acne), [&](size_t i) {
    EXPECT_TRUE(visited++ == 0 || i == last + 1 || i == steps.first(StepBlocks::block_of(i)));
    EXPECT_TRUE(visited == 1 || i > last);
    last = i;
    if (acne[i] != 0) seen.insert(i);
  });
  EXPECT_EQ(seen, (std::set<size_t>{0, static_cast<size_t>(pixels / 2), static_cast<size_t>(pixels - 1)}));
  EXPECT_LT(visited, p.ladder.flags.size());
  steps.each(static_cast<size_t>(Cause::peter_panning), [](size_t i) { ADD_FAILURE() << i; });
  size_t stepped = 0;
  for (size_t block = 0; block < steps.blocks(); ++block) stepped += steps.any(block);
  EXPECT_EQ(stepped, 3u);
}

TEST(StepBlocks, GiveTheSumsOfAllPixels) {
  Picture p(67, 53);
  std::mt19937 random(7);
  double acne = 0, aliasing = 0, squares = 0, panning = 0, edge = 0;
  for (size_t i = 0; i < p.ladder.flags.size(); ++i) {
    const auto set = [&](Cause cause) {
      return p.ladder[cause][i] = static_cast<float>(random() % 1000) / 1000 - 0.5f;
    };
    if (i % 1500 < 40 || i + 1 == p.ladder.flags.size()) acne += std::abs(static_cast<double>(set(Cause::acne)));
    if (i % 900 == 700) panning += std::abs(static_cast<double>(set(Cause::peter_panning)));
    if (i % 1100 < 3) {
      const double step = set(i % 2 ? Cause::aliasing_dark : Cause::aliasing_light);
      p.edge[i] = static_cast<float>(i % 17);
      aliasing += std::abs(step), squares += step * step, edge = std::max<double>(edge, p.edge[i]);
    }
  }
  const auto count = static_cast<double>(p.ladder.flags.size());
  const std::map<std::string, double> found = p.metrics();
  EXPECT_NEAR(found.at("acne"), acne / count, 1e-15);
  EXPECT_NEAR(found.at("peter_panning"), panning / count, 1e-15);
  EXPECT_NEAR(found.at("aliasing"), aliasing / count, 1e-15);
  EXPECT_NEAR(found.at("aliasing_rms"), std::sqrt(squares / count), 1e-15);
  EXPECT_GT(edge, 10);
  EXPECT_EQ(found.at("edge_displacement_texels"), edge);
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
      {"wrong_patch",
       3.0 / static_cast<double>(
                 p.ladder.flags.size())},  // (1, 1), (2, 1), (3, 1); at (0, 1) the picture shows one half, which is lit
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
      // Of the drawn edge's six pixels (0, 1), (1, 1) and (1, 2) are on the true edge, the others one beside it.
      {"edge_displacement_pixels", 1},
      {"edge_displacement_mean_pixels", 3 / 6.0},
      {"edge_displacement_p95_pixels", 1},
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

// A bound on one cause points to a pixel of that cause, and not to one that is more wrong by another.
TEST(WorstPixels, EachMetricHasItsOwn) {
  Picture p(4, 2);
  p.rungs(0, 0, {1, 1, 1, 0, 0, 0});
  p.step(0, 0, Cause::aliasing_dark, -1);
  p.edge.at(0, 0) = 0.5f;
  p.rungs(1, 0, {1, 1, 1, 1, 0.75f, 0.75f});
  p.step(1, 0, Cause::acne, -0.25f);
  p.rungs(3, 1, {1, 1, 1, 1, 0.5f, 0.5f});
  p.step(3, 1, Cause::acne, -0.5f);
  p.rungs(2, 1, {0, 0, 0, 1, 1, 1});
  p.step(2, 1, Cause::aliasing_light, 0.25f);
  p.edge.at(2, 1) = 2;
  p.rungs(0, 1, {1, 1, 1, 1, 0, 0});
  p.step(0, 1, Cause::acne, -1);
  p.ladder.flags.at(0, 1) |= flag_ambiguous;  // not counted
  const auto at = [&](const std::string& metric) {
    for (const PointRecord::WorstOf& worst : p.worst())
      if (worst.metric == metric) return worst;
    return PointRecord::WorstOf{};
  };
  EXPECT_EQ(worst_pixel(p.ladder).x, 0) << "the aliased one is the most wrong";
  const auto expect = [&](const std::string& metric, int x, int y, double size) {
    EXPECT_EQ(at(metric).x, x) << metric;
    EXPECT_EQ(at(metric).y, y) << metric;
    EXPECT_EQ(at(metric).size, size) << metric;
  };
  expect("acne", 3, 1, 0.5);
  expect("aliasing_dark", 0, 0, 1);
  expect("aliasing_light", 2, 1, 0.25);
  expect("aliasing", 0, 0, 1);
  expect("edge_displacement_texels", 2, 1, 2);
  EXPECT_EQ(at("peter_panning").x, -1) << "no pixel has any";
  EXPECT_EQ(at("filter").x, -1);
  p.step(1, 1, Cause::acne, nan_float);  // worse than any number
  EXPECT_EQ(at("acne").x, 1);
  EXPECT_TRUE(std::isnan(at("acne").size));
}

TEST(Measure, GivesTheMostThatOneReceiverLeaksAndLoses) {
  Picture p(4, 2, cause_count);
  p.step(0, 0, Cause::leak, 0.125f);
  p.step(1, 0, Cause::leak, 0.25f);
  p.step(2, 0, Cause::leak, 0.75f);
  p.ladder.flags.at(2, 0) |= flag_ambiguous;  // not counted
  p.step(0, 1, Cause::over_darkening, -0.5f);
  p.step(1, 1, Cause::over_darkening, -0.375f);
  attach(p, 3, 1);
  p.step(3, 1, Cause::over_darkening, -1);
  EXPECT_EQ(p.metric("leak_largest"), 0.25);
  EXPECT_EQ(p.metric("over_darkening_largest"), 0.5);
  const Picture none(0, 0, cause_count);
  EXPECT_TRUE(std::isnan(none.metric("leak_largest")));
  EXPECT_FALSE(Picture(1, 1).metrics().contains("leak_largest")) << "comparisons have no leak";
}

TEST(Measure, EdgeDisplacementIsFromAliasedPixelsOnly) {
  Picture p(5, 4);
  p.step(0, 0, Cause::aliasing_light, 1);
  p.edge.at(0, 0) = 0.5f;
  p.step(4, 3, Cause::aliasing_dark, -1);
  p.edge.at(4, 3) = 2;
  EXPECT_EQ(p.metric("edge_displacement_texels"), 2);
  EXPECT_EQ(p.metric("edge_displacement_mean_texels"), 1.25);
  p.edge.at(0, 0) = nan_float;
  EXPECT_TRUE(std::isnan(p.metric("edge_displacement_texels")));
  EXPECT_TRUE(std::isnan(p.metric("edge_displacement_mean_texels")));
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
  p.ladder[Rung::shown].at(1, 1) = infinity_f;
  expect(2, 1, "none");
  p.ladder[Rung::shown].at(2, 1) = 1;
  expect(1, 1, "none");
  p.ladder[Rung::shown].at(0, 0) = nan_float;
  expect(0, 0, "none");
  attach(p, 0, 0);
  expect(1, 1, "none");
}

TEST(MetricsTable, NamesWhatIsMeasured) {
  const std::set<std::string> times = {"map_ms",    "map_low_ms",    "map_high_ms",     // measure/pass_times.h
                                       "lookup_ms", "lookup_low_ms", "lookup_high_ms",  //
                                       "shadow_ms", "shadow_low_ms", "shadow_high_ms"};
  const auto is_time = [&](const Metric& metric) {
    return times.contains(std::string(metric.name)) || metric.name.starts_with("prefilter_");
  };
  const std::set<std::string_view> units = {"fraction", "m",     "m2",    "depth", "texels", "pixels",
                                            "deg",      "count", "bytes", "ms",    ""};
  std::set<std::string> names;
  for (const Metric& metric : metrics_table()) {
    if (!metric.optional()) {  // tests/acceptance/placements_test.cpp and motion_test.cpp measure the others
      EXPECT_TRUE(names.insert(std::string(metric.name)).second) << metric.name << " twice";
    }
    EXPECT_TRUE(units.contains(metric.unit)) << metric.unit;
    EXPECT_EQ(metric.unit == "ms", is_time(metric)) << metric.name;
    EXPECT_TRUE(metric.help.ends_with('.') && metric.help.size() > 10) << metric.name;
    EXPECT_EQ(&find_metric(metric.name), &metric);
  }
  std::set<std::string> measured = times;
  for (const std::string& name :
       test::words_of("shaded_rmse flip clipped culled scene_behind texel_work traffic_bytes map_bytes map_texels "
                      "map_triangles lookup_fetches lookup_texels lookup_operations map_used map_seen undersampled "
                      "perspective_aliasing perspective_aliasing_p95 truth_by_cells truth_by_rays truth_by_scan "
                      "nearest_receiver_m farthest_receiver_m"))
    measured.insert(name);  // likewise
  const Picture picture(1, 1);
  for (const auto& [name, value] : picture.metrics()) measured.insert(name);
  const Scene nothing;
  const Camera camera;
  for (const auto& [name, value] : measure_laws(
           {picture.ladder, nothing, picture.receivers, camera, picture.frame, DepthFormat::d24, picture.probe}))
    measured.insert(name);
  // Metrics of compare/judge/soundness.h, which has its own test.
  for (const char* name : {"contract", "rounding_excess", "address_error_texels", "reference_error_m",
                           "map_error_quanta", "map_excess", "map_bits"})
    measured.insert(name);
  EXPECT_EQ(names, measured);
  EXPECT_EQ(find_metric("residual").unit, "");
  EXPECT_EQ(find_metric("tap_residual").unit, "");
}

// A metric that is made from a row ("error_worst" from "error") has a name that no other row makes.
TEST(MetricsTable, ReadsWhatFollowsAnAt) {
  size_t made = 0;
  for (const Metric& row : metric_rows())
    for (const std::string& name : also_names(row)) {
      const Metric* const also = metric_named(stored_name(name));
      ASSERT_TRUE(also) << name;
      EXPECT_TRUE(also->is(Metric::made) && also->unit == row.unit) << name;
      ++made;
    }
  EXPECT_EQ(made, 3u * 15 + 2 * 4);
  EXPECT_EQ(metrics_table().size(), metric_rows().size() + made);
  EXPECT_EQ(stored_name("error@worst"), "error_worst");
  EXPECT_EQ(stored_name("map_ms@low"), "map_low_ms");
  EXPECT_EQ(stored_name("window_min_m@worst"), "window_min_worst_m");
  EXPECT_EQ(stored_name("window_width_depth@worst"), "window_width_worst_depth");
  EXPECT_EQ(stored_name("aliasing*@worst"), "aliasing*_worst");
  EXPECT_EQ(stored_name("error_worst"), "error_worst");
}

TEST(MetricsTable, SuggestsTheNearestName) {
  expect_refused(ErrorKind::usage, {"did you mean 'peter_panning'?"}, [&] { find_metric("peter_paning"); });
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
