// The two small headers that turn settings into the numbers that the shader uses: biases and texel addresses.
#include <gtest/gtest.h>

#include <cmath>

#include "technique/bias.h"
#include "technique/map_address.h"
#include "tests/support/bias_of.h"

namespace noonmark {
namespace {

TEST(MapAddress, WrapsAsOpenGLSays) {
  // OpenGL 4.5, 8.14.2: repeat takes the remainder towards minus infinity; the clamps clamp.
  for (int n : {1, 2, 3, 8, 1000}) {
    for (int i = -3 * n - 2; i <= 3 * n + 2; ++i) {
      const bool inside = i >= 0 && i < n;
      const int remainder = i - n * static_cast<int>(std::floor(static_cast<double>(i) / n));
      const int edge = i < 0 ? 0 : i >= n ? n - 1 : i;
      for (int j : {0, n / 2, n - 1}) {  // the other axis, inside
        ASSERT_EQ(inside_map({i, j}, {n, n}), inside);
        ASSERT_EQ(inside_map({j, i}, {n, n}), inside);
        ASSERT_EQ(wrapped({i, j}, {n, n}, Wrap::repeat), glm::ivec2(remainder, j));
        ASSERT_EQ(wrapped({j, i}, {n, n}, Wrap::repeat), glm::ivec2(j, remainder));
        ASSERT_EQ(wrapped({i, j}, {n, n}, Wrap::clamp_to_edge), glm::ivec2(edge, j));
        ASSERT_EQ(wrapped({j, i}, {n, n}, Wrap::clamp_to_edge), glm::ivec2(j, edge));
        ASSERT_EQ(wrapped({i, j}, {n, n}, Wrap::clamp_to_border), inside ? glm::ivec2(i, j) : glm::ivec2(-1));
        ASSERT_EQ(wrapped({j, i}, {n, n}, Wrap::clamp_to_border), inside ? glm::ivec2(j, i) : glm::ivec2(-1));
      }
    }
    // The farthest texels that a lookup can name, and a kernel's reach more.
    for (int far : {-(1 << 20) - 15, (1 << 20) + 15}) {
      const glm::ivec2 read = wrapped({far, far}, {n, n}, Wrap::repeat);
      ASSERT_TRUE(inside_map(read, {n, n}));
      ASSERT_EQ((far - read.x) % n, 0);
      ASSERT_EQ(wrapped({far, -far}, {n, n}, Wrap::clamp_to_edge),
                glm::ivec2(far < 0 ? 0 : n - 1, far < 0 ? n - 1 : 0));
    }
  }
  // Of blocks of two texels: the last whole block is the edge.
  EXPECT_EQ(wrapped({-1, 9}, {8, 8}, Wrap::clamp_to_edge, 2), glm::ivec2(1, 7));
  EXPECT_EQ(wrapped({-2, 8}, {8, 8}, Wrap::clamp_to_edge, 2), glm::ivec2(0, 6));
  EXPECT_EQ(wrapped({-7, 15}, {8, 8}, Wrap::clamp_to_edge, 4), glm::ivec2(1, 7));
  EXPECT_EQ(wrapped({-8, 13}, {8, 8}, Wrap::clamp_to_edge, 4), glm::ivec2(0, 5));
  // A map that is not square: each axis uses its own size.
  EXPECT_EQ(wrapped({7, 7}, {3, 18}, Wrap::repeat), glm::ivec2(1, 7));
  EXPECT_EQ(wrapped({7, 19}, {3, 18}, Wrap::clamp_to_edge), glm::ivec2(2, 17));
  EXPECT_TRUE(inside_map({2, 17}, {3, 18}));
  EXPECT_FALSE(inside_map({17, 2}, {3, 18}));
  EXPECT_EQ(border_depth, 1);
}

// A probe of one receiver.
LookupProbe probe_of(float n_dot_l, float bias_unit, float tan_theta = 0) {
  LookupProbe probe;
  probe.n_dot_l = Image<float>(1, 1, n_dot_l);
  probe.bias_unit = Image<float>(1, 1, bias_unit);
  probe.tan_theta = Image<float>(1, 1, tan_theta);
  return probe;
}

std::vector<std::string> names_of(std::span<const ActivePart> parts) {
  std::vector<std::string> names;
  for (const ActivePart& active : parts) names.emplace_back(active.part->name);
  return names;
}

TEST(Bias, HasThePartsThatAreSet) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_of(bias_of({}).compared()), Names{});
  EXPECT_FALSE(bias_of({}).moves_lookup());
  EXPECT_FALSE(bias_of({}).polygon_offset());
  EXPECT_EQ(bias_of({}).reference().name, "own_depth");
  const Bias all =
      bias_of({{"tan", 1}, {"constant", 1}, {"slope_floor", 1}, {"normal_offset", 1}, {"polygon_units", 2}});
  EXPECT_EQ(names_of(all.compared()), (Names{"constant", "slope", "tan"})) << "in the table's order";
  EXPECT_EQ(names_of(all.moving()), Names{"normal_offset"});
  EXPECT_EQ(all.polygon_offset()->factor, 0);
  EXPECT_EQ(all.polygon_offset()->units, 2);
  EXPECT_EQ(names_of(bias_of({{"tan_cap", 1}}).compared()), Names{}) << "a cap alone does nothing";
}

TEST(Bias, IsTheSumOfItsPartsInTheReceiversOwnUnit) {
  const LookupProbe probe = probe_of(0.5f, 0.125f, 2);
  EXPECT_EQ(bias_of({{"constant", 0.3}}).at(probe, 0), 0.3f * 0.125f);
  EXPECT_EQ(bias_of({{"normal_offset", 1}, {"polygon_factor", 1}}).at(probe, 0), 0);
  const float slope = 0.7f * 0.5f, tan = 0.1f * 2;
  EXPECT_EQ(bias_of({{"constant", 0.3}, {"slope", 0.7}, {"tan", 0.1}}).at(probe, 0), ((0.3f + slope) + tan) * 0.125f);
}

TEST(Bias, OfANormalOffsetIsALengthAndNoDepth) {
  LightFrame frame;
  frame.extent_m = 20;
  frame.resolution = frame.rows = 1000;
  BiasSettings settings = bias_settings_of({{"normal_offset", 1.5}});
  for (const BiasUnit unit : {BiasUnit::depth, BiasUnit::m, BiasUnit::texel}) {
    settings.unit = unit;
    const Bias bias(settings);
    // 1.5 texels of 20 mm. The unit of the other parts does not matter.
    EXPECT_EQ(bias.moved_m(frame, {1, 2, 3}, {0, -1, 0}), glm::dvec3(0, -0.03, 0));
    EXPECT_LT(glm::length(bias.looked_up(frame, {1, 2, 3}, {0, -1, 0}) - glm::dvec3(1, 1.97, 3)), 1e-15);
  }
  // Under a point light the texel at the receiver counts. Its width is 2 z / resolution, with z along the face's axis.
  frame.kind = LightKind::point;
  EXPECT_DOUBLE_EQ(Bias(settings).moved_m(frame, {1, 2, -3}, {0, 0, 1}).z, 1.5 * 2 * 3 / 1000);
}

TEST(Bias, OffsetsCanBeMetres) {
  LightFrame frame;
  frame.extent_m = 20;
  frame.resolution = frame.rows = 1000;
  BiasSettings settings = bias_settings_of({{"normal_offset", 0.25}, {"caster_offset", 0.5}});
  settings.offset_unit = OffsetUnit::m;
  for (const LightKind kind : {LightKind::directional, LightKind::point}) {
    frame.kind = kind;
    EXPECT_EQ(Bias(settings).moved_m(frame, {1, 2, 3}, {0, -1, 0}), glm::dvec3(0, -0.25, 0));
  }
  EXPECT_EQ(unit_of_amount("bias.offset_unit", settings), "m");
  EXPECT_EQ(unit_of_amount("bias.offset_unit", BiasSettings()), "texels");
  EXPECT_EQ(unit_of_amount("bias.unit", BiasSettings()), "depth");
}

TEST(Bias, OfASlopeIsTheShadersFloatArithmetic) {
  const Bias bias = bias_of({{"slope", 0.05}, {"slope_floor", 0.005}});
  const auto at = [&](float n_dot_l) { return bias.at(probe_of(n_dot_l, 1), 0); };
  EXPECT_EQ(at(1), 0.005f);
  EXPECT_EQ(at(1 + 0x1p-23f), 0.005f);  // a cosine above 1 by rounding
  EXPECT_EQ(at(0), 0.05f);
  EXPECT_EQ(at(0.5f), 0.025f);
  for (int i = 0; i <= 1000; ++i) {
    const float n_dot_l = static_cast<float>(i) / 1000;
    const volatile float turned = 1.0f - n_dot_l, scaled = 0.05f * turned;  // rounded at each step
    EXPECT_EQ(at(n_dot_l), scaled > 0.005f ? scaled : 0.005f);
  }
}

TEST(Bias, OfATanIsHeldBetweenItsFloorAndItsCap) {
  const Bias bias = bias_of({{"tan_floor", 0.005}, {"tan", 0.01}, {"tan_cap", 0.05}});
  for (int i = 0; i <= 1000; ++i) {
    const float tan = static_cast<float>(i) / 100;
    const volatile float scaled = 0.01f * tan;
    const float held = scaled < 0.005f ? 0.005f : scaled > 0.05f ? 0.05f : scaled;
    const volatile float in_depth = held * 0.3f;
    EXPECT_EQ(bias.at(probe_of(0.5f, 0.3f, tan), 0), in_depth);
  }
}

}  // namespace
}  // namespace noonmark
