// The cost of a frame, compared with counts made by hand from the formulas and the shaders.
#include "technique/cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "technique/bias_parts.h"
#include "technique/filters.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

Settings with(const FilterSettings& filter) {
  Settings settings;
  settings.filter = filter;
  settings.bias["constant"] = 0;
  return settings;
}

TEST(Cost, CountsTextureInstructions) {
  const auto fetches = [](const FilterSettings& filter) { return lookup_cost(with(filter)).fetches; };
  const auto texels = [](const FilterSettings& filter) { return lookup_cost(with(filter)).texels; };
  EXPECT_EQ(fetches({"none", {}}), 1);
  EXPECT_EQ(fetches({"box", {{"size", 5}}}), 25);
  EXPECT_EQ(texels({"box", {{"size", 5}}}), 25);
  EXPECT_EQ(fetches({"hardware", {}}), 1);  // one instruction that reads four texels
  EXPECT_EQ(texels({"hardware", {}}), 4);
  EXPECT_EQ(fetches({"gaussian", {{"size", 3}}}), 9);
  EXPECT_EQ(texels({"gaussian", {{"size", 3}}}), 36);
  for (const char* kind : {"castano", "tent"}) {  // "in 4, 9 or 16 fetches"
    EXPECT_EQ(fetches({kind, {{"size", 3}}}), 4) << kind;
    EXPECT_EQ(fetches({kind, {{"size", 5}}}), 9) << kind;
    EXPECT_EQ(fetches({kind, {{"size", 7}}}), 16) << kind;
  }
  EXPECT_EQ(fetches({"poisson", {}}), 16);
  EXPECT_EQ(fetches({"vogel", {{"taps", 5}}}), 5);
}

TEST(Cost, CountsTheOperationsOfTheFormulas) {
  const auto operations = [](const Settings& settings) { return lookup_cost(settings).operations; };
  Settings s = with({"none", {}});
  EXPECT_EQ(operations(s), 1);  // the comparison
  s.bias["constant"] = 0.1;
  EXPECT_EQ(operations(s), 3);  // amount * 1, reference - bias, the comparison
  s.bias["slope"] = 0.1;
  EXPECT_EQ(operations(s), 7);  // and 1 - N.L, its product, its floor, the sum
  s = with({"none", {}});
  s.bias["normal_offset"] = 1;
  EXPECT_EQ(operations(s), 7);  // amount * N, P + that, the comparison
  s.bias["normal_offset_axes"] = 1;
  EXPECT_EQ(operations(s),
            7 + 5 + 5 + 1 + 3 + 3 + 3);  // two dots, their sum, times N, times the amount, the sum with P
  s = with({"box", {{"size", 3}}});
  EXPECT_EQ(operations(s), 9 * 2);  // compared and counted
  s.bias.reference = "texel_plane";
  EXPECT_EQ(operations(s), 9 * (2 + 4));  // two products, two sums
  s.bias.reference = "receiver_plane";
  EXPECT_EQ(operations(s), 9 * (2 + 6));  // and its cap, from both sides
  s = with({"gaussian", {{"size", 3}}});
  EXPECT_EQ(operations(s), 9 * 2);  // the weights are constants: weight * fetch, and the sum
}

// castano_weight(texel, s, size): 1 - s is one operation; a weight of two kernel taps is here * (1 - s) + before * s,
// divided: five operations. The kernel's values are constants. tent_weight: the two ends of the texel are a sum each; the area up
// to each is held (2), divided, and 2 - |at|, its product, the sum and the division by 2; their difference: 2 + 14 + 1.
TEST(Cost, CountsTheWeightsOfAFilterThatMakesThem) {
  for (const auto& [kind, weight] : {std::pair{"castano", 5}, std::pair{"tent", 17}})
    for (const int size : {3, 5, 7}) {
      const int along = size + 1, rows = along / 2, fetches = rows * rows;  // of 2 x 2 texels
      const int weights = weight * (along + rows * along);  // per row of fetches: two, and two for each of its fetches
      const int blends = 5 * fetches;                       // two sums, their product, two divisions
      EXPECT_EQ(lookup_cost(with({kind, {{"size", size}}})).operations, weights + blends + 3 * fetches + 1)
          << kind << size;
    }
}

TEST(Cost, AddsTheMapAndTheLookups) {
  Settings s = with({"box", {{"size", 3}}});
  s.map.resolution = 1024;
  s.map.format = DepthFormat::d24;
  const FrameCost flat = frame_cost(s, 1, int64_t{s.map.resolution} * s.map.resolution, 1000, 50);
  EXPECT_EQ(flat.map_texels, 1 << 20);
  EXPECT_EQ(flat.map_bytes, 4 << 20);
  EXPECT_EQ(flat.map_triangles, 50);
  EXPECT_EQ(flat.texel_work, (1 << 20) + 1000 * 9);
  EXPECT_EQ(flat.traffic_bytes, (4 << 20) + 1000 * 9 * 4);
  s.map.format = DepthFormat::d16;
  const FrameCost cube = frame_cost(s, 6, int64_t{6} * s.map.resolution * s.map.resolution, 1000, 50);
  EXPECT_EQ(cube.map_bytes, 6 * (2 << 20));
  EXPECT_EQ(cube.map_triangles, 300);
  EXPECT_EQ(cube.traffic_bytes, 6 * (2 << 20) + 1000 * 9 * 2);
  s.map.resolution = 16384;  // beyond 32 bits
  EXPECT_EQ(frame_cost(s, 6, int64_t{6} * s.map.resolution * s.map.resolution, 0, 0).map_bytes,
            int64_t{6} * 2 * 16384 * 16384);
}

// A pass stores moments and two blur them; three.js's two passes read the depths themselves.
TEST(Cost, AddsThePassesOverAMapOfMoments) {
  Settings s = with({"box", {{"size", 5}}});
  s.lookup.kind = "vsm";
  const FrameCost vsm = frame_cost(s, 1, 100, 10, 1);
  EXPECT_EQ(vsm.pass_fetches, 100 * (1 + 5 + 5));
  EXPECT_EQ(vsm.texel_work, 100 + 10 + 3 * 100 + vsm.pass_fetches);
  // 1600 texels stored, 400 and 100 halved from four each, and 100 blurred twice, of 5 each.
  s.lookup["level"] = 2;
  const FrameCost halved = frame_cost(s, 1, 1600, 10, 1);
  EXPECT_EQ(halved.pass_fetches, 1600 + 4 * (400 + 100) + 2 * 5 * 100);
  EXPECT_EQ(halved.texel_work, 1600 + 10 + 1600 + 400 + 100 + 2 * 100 + halved.pass_fetches);
  EXPECT_EQ(halved.map_bytes, 1600 * 4 + 8 * (1600 + 400 + 100 + 100));
  s.lookup["level"] = 0;
  s.filter.kind = "none";
  s.lookup.kind = "three_vsm";
  s.lookup["samples"] = 8, s.lookup["radius"] = 4;
  const FrameCost three = frame_cost(s, 1, 100, 10, 1);
  EXPECT_EQ(three.pass_fetches, 100 * (8 + 8));
  EXPECT_EQ(three.texel_work, 100 + 10 + 2 * 100 + three.pass_fetches);
  // Depths of 32 bits are written, read 8 times along v, and the two numbers are written twice and fetched four times 8.
  EXPECT_EQ(three.traffic_bytes, 100 * (4 + 8 * 4 + 2 * 8 + 4 * 8 * 8) + 10 * 4 * 8);
  EXPECT_EQ(three.map_bytes, vsm.map_bytes);
}

// Each part alone with one nearest tap, whose comparison is 1 operation. The parts that are not named here act on the caster.
TEST(Cost, CountsTheOperationsOfEachPart) {
  const std::map<std::string_view, int> of_formula = {
      {"constant", 0},
      {"slope", 1},              // 1 - N.L
      {"tan", 0},                // tan(theta) is given
      {"normal_offset", 0},      // N is given
      {"normal_offset_sin", 8},  // N.L held between 0 and 1, squared, 1 less that, root, and the way's three products
      {"normal_offset_turned", 4},    // 1 - N.L, three products
      {"normal_offset_lateral", 10},  // that, three products along the light, three differences
      {"normal_offset_axes", 14},     // two dots of 5, their sum, three products
  };
  for (const BiasPart& part : bias_parts()) {
    Settings s = with({"none", {}});
    s.bias[part.name] = 0.5;
    int expected = 1;
    if (part.acts_on == BiasTarget::compared_depth)  // times the amount, floor, cap, and taken from the reference
      expected += of_formula.at(part.name) + 1 + !part.floor_help.empty() + !part.cap_help.empty() + 1;
    else if (part.acts_on == BiasTarget::place_looked_up)  // times the amount, added to P
      expected += of_formula.at(part.name) + 3 + 3;
    EXPECT_EQ(lookup_cost(s).operations, expected) << part.name;
  }
}

TEST(Cost, CountsTheOperationsOfEachLookup) {
  struct Row {
    const char* kind;
    int form, operations;
  };
  const Row rows[] = {
      {"vsm", 0, 9},     // variance 2, max, way, spread 2, quotient 2, choice
      {"esm", 0, 4},     // product, exp, product, choice
      {"evsm2", 0, 17},  // warp 4, floor 4, as VSM 9
      {"evsm4", 0, 35},  // twice that, choice
      {"msm", 0, 92},
      {"msm", 1, 102},
      {"msm", 2, 121},
      {"msm", 3, 92},
      {"msm_hausdorff", 0, 151},
      {"msm_hausdorff", 1, 161},
      {"msm_hausdorff", 2, 160},
      {"msm_hausdorff", 3, 131},
      {"babylon_esm", 0, 8},
      {"babylon_close_esm", 0, 7},
      {"three_vsm", 0, 8},
  };
  for (const Row& row : rows) {
    Settings s = with({"none", {}});
    s.lookup.kind = row.kind;
    s.lookup["moments"] = row.form;
    EXPECT_EQ(lookup_cost(s).operations, row.operations) << row.kind << " " << row.form;
    s.lookup["reduction"] = 0.3;  // (v - reduction) / (1 - reduction), clamped to 0 ... 1
    EXPECT_EQ(lookup_cost(s).operations, row.operations + 4) << row.kind << " " << row.form;
  }
  for (const LookupKind& lookup : lookups())
    EXPECT_TRUE(lookup.compares() || std::ranges::any_of(rows, [&](const Row& row) { return row.kind == lookup.name; }))
        << lookup.name;
}

TEST(Cost, EveryFilterFetches) {
  for (const Filter& filter : filters()) {
    EXPECT_EQ(filter.weight_operations != 0, filter.own_weights) << filter.name;
    EXPECT_GE(lookup_cost(with({std::string(filter.name), {}})).fetches, 1) << filter.name;
  }
}

}  // namespace
}  // namespace noonmark
