// Distances between drawn and true shadow edges in pictures in which they can be counted.
#include "compare/ladder/shadow_edges.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/compare/ladder/measured_picture.h"

namespace noonmark {
namespace {

// Dark left of column `edge`.
Picture half_dark(int width, int height, int edge) {
  Picture p(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < edge; ++x) p.rungs(x, y, {0, 0, 0, 0, 0, 0});
  return p;
}

EdgeDisplacements of(const Picture& p, std::span<const uint32_t> surfaces = {}) {
  return edge_displacements(p.ladder, p.receivers, surfaces);
}

void expect(const EdgeDisplacements& found, double largest, double mean, double p95) {
  EXPECT_DOUBLE_EQ(found.largest, largest);
  EXPECT_NEAR(found.mean, mean, 1e-6);  // distances are floats
  EXPECT_DOUBLE_EQ(found.p95, p95);
}

// A straight edge that any cause moves by `by` pixels is displaced by `by` along its whole length. Near the picture's
// border the true edge could also be outside: there it is the distance to the border.
RC_GTEST_PROP(ShadowEdges, AreDisplacedByWhatMovesThem, ()) {
  const int width = 30, height = *rc::gen::inRange(1, 20), edge = 12, by = *rc::gen::inRange(-6, 7);
  const Cause cause =
      *rc::gen::element(Cause::displacement, Cause::aliasing_dark, Cause::aliasing_light, Cause::filter);
  Picture p = half_dark(width, height, edge);
  for (int y = 0; y < height; ++y)
    for (int x = std::min(edge, edge + by); x < std::max(edge, edge + by); ++x) p.step(x, y, cause, by > 0 ? -1 : 1);
  std::vector<double> expected;
  for (int y = 0; y < height; ++y)
    for (int side = 0; side < 2; ++side) expected.push_back(std::min({std::abs(by), y + 1, height - y}));
  std::sort(expected.begin(), expected.end());
  double mean = 0;
  for (const double d : expected) mean += d / static_cast<double>(expected.size());
  const auto rank = static_cast<size_t>(std::ceil(0.95 * static_cast<double>(expected.size()))) - 1;
  const EdgeDisplacements found = of(p);
  RC_ASSERT(found.largest == expected.back());
  RC_ASSERT(std::abs(found.mean - mean) < 1e-9);
  RC_ASSERT(found.p95 == expected[rank]);
}

TEST(ShadowEdges, OfOtherCausesAreNotDrawnOnes) {
  Picture p = half_dark(20, 20, 10);
  p.step(15, 10, Cause::acne, -1);
  p.step(5, 10, Cause::peter_panning, 1);
  p.step(15, 5, Cause::undecided, -1);
  p.step(5, 5, Cause::coverage_light, 1);
  p.step(15, 15, Cause::precision, -1);
  expect(of(p), 0, 0, 0);
  // An edge about one pixel: from (14, 10) to column 9, and from its four neighbours to column 10.
  p.step(14, 10, Cause::aliasing_dark, -1);
  expect(of(p), 5, (5 + 3 + 4 + 4 + 5) / (2 * 20 + 5.0), 4);
}

// A ramp over four pixels crosses one half where the true edge is, or beside it.
TEST(ShadowEdges, LieWhereASoftEdgeCrossesOneHalf) {
  for (const int beside : {0, 2}) {
    Picture p = half_dark(30, 30, 12);
    for (int y = 0; y < 30; ++y)
      for (int k = 0; k < 4; ++k) {
        const int x = 10 + beside + k;
        p.step(x, y, Cause::filter, 0.2f * static_cast<float>(k + 1) - (x < 12 ? 0.0f : 1.0f));
      }
    EXPECT_EQ(of(p).largest, beside);
    EXPECT_EQ(of(p).p95, beside);
  }
  // One half itself is lit.
  Picture p = half_dark(30, 30, 12);
  for (int y = 0; y < 30; ++y) p.step(11, y, Cause::filter, 0.5f);
  EXPECT_EQ(of(p).largest, 1);
  for (int y = 0; y < 30; ++y) p.step(11, y, Cause::filter, 0.4999f);
  EXPECT_EQ(of(p).largest, 0);
}

TEST(ShadowEdges, AreOnOneSurface) {
  // The left half is dark and a surface of its own: where it ends is an outline, and no edge of a shadow.
  Picture p = half_dark(40, 30, 12);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 12; ++x) p.receivers.primitive.at(x, y) = 1;
    p.rungs(20, y, {0, 0, 0, 0, 0, 0});
    p.step(12, y, Cause::aliasing_dark, -1);
  }
  const std::vector<uint32_t> apart = {0, 1}, alike = {5, 5};
  // Two edges about the column 20, of two pixels each, are right. Of one surface, the edge at 12 has moved by 1; else it is
  // a new one, from 12 to the outline at 11, and from 13 to it.
  EXPECT_EQ(of(p).largest, 1);
  EXPECT_EQ(of(p, alike).largest, 1);
  EXPECT_EQ(of(p, apart).largest, 2);
}

// Where the true edge is hidden, or outside of the picture, an edge is displaced by no more than can be known.
TEST(ShadowEdges, AreNoFurtherThanTheEndOfTheSurface) {
  Picture p(30, 30);  // all lit: no true edge at all
  p.step(15, 12, Cause::aliasing_dark, -1);
  EXPECT_EQ(of(p).largest, 14) << "from (15, 13) to row -1, above the picture";
  attach(p, 15, 20);  // turned away
  EXPECT_EQ(of(p).largest, 9) << "from (15, 11)";
  p.receivers.primitive.at(12, 12) = no_primitive;  // background
  p.ladder.flags.at(12, 12) = 0;
  EXPECT_EQ(of(p).largest, 4) << "from (16, 12)";
  EXPECT_EQ(of(p).p95, 4);
}

TEST(ShadowEdges, CountWhereTheTruthIsSure) {
  Picture p(9, 9);
  p.step(4, 4, Cause::aliasing_dark, -1);
  EXPECT_EQ(of(p).largest, 5);
  for (uint8_t& flags : p.ladder.flags.pixels) flags |= flag_ambiguous;
  expect(of(p), 0, 0, 0);
  p.step(4, 4, Cause::aliasing_dark, nan_float);
  expect(of(p), 0, 0, 0);
  p.ladder.flags.at(4, 4) = flag_facing;
  for (const double value : {of(p).largest, of(p).mean, of(p).p95}) EXPECT_TRUE(std::isnan(value));
  expect(of(Picture(0, 0)), 0, 0, 0);
}

}  // namespace
}  // namespace noonmark
