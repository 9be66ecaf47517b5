// The two small headers that turn settings into what the shader computes with: biases and texel addresses.
#include <gtest/gtest.h>

#include <cmath>

#include "technique/depth_bias.h"
#include "technique/map_address.h"

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
    // The farthest texels that a lookup names, and a kernel beyond.
    for (int far : {-(1 << 20) - 15, (1 << 20) + 15}) {
      const glm::ivec2 read = wrapped({far, far}, {n, n}, Wrap::repeat);
      ASSERT_TRUE(inside_map(read, {n, n}));
      ASSERT_EQ((far - read.x) % n, 0);
      ASSERT_EQ(wrapped({far, -far}, {n, n}, Wrap::clamp_to_edge),
                glm::ivec2(far < 0 ? 0 : n - 1, far < 0 ? n - 1 : 0));
    }
  }
  // A map that is not square: each side by its own size.
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

BiasSettings every_value(BiasForm form) {
  BiasSettings s;
  s.form = form;
  s.constant = 0.3;
  s.slope = 0.7;
  s.floor = 0.9;
  s.tan_scale = 1.1;
  s.cap = 1.3;
  s.factor = 1.5;
  s.units = 1.7;
  s.normal_offset = 1.9;
  return s;
}

TEST(DepthBias, LeavesWhatItsFormDoesNotUse) {
  struct Row {
    BiasForm form;
    std::vector<float> used;  // in the order of the members
  };
  const float c = 0.3f, s = 0.7f, f = 0.9f, t = 1.1f, cap = 1.3f, factor = 1.5f, units = 1.7f, offset = 1.9f;
  for (const Row& row : std::vector<Row>{{BiasForm::none, {0, 0, 0, 0, 0, 0, 0, 0}},
                                         {BiasForm::constant, {c, 0, 0, 0, 0, 0, 0, 0}},
                                         {BiasForm::slope, {0, s, f, 0, 0, 0, 0, 0}},
                                         {BiasForm::tan, {0, 0, f, t, cap, 0, 0, 0}},
                                         {BiasForm::polygon_offset, {0, 0, 0, 0, 0, factor, units, 0}},
                                         {BiasForm::normal_offset, {0, 0, 0, 0, 0, 0, 0, offset}},
                                         {BiasForm::receiver_plane, {c, 0, 0, 0, 0, 0, 0, 0}},
                                         {BiasForm::tangent_plane, {c, 0, 0, 0, 0, 0, 0, 0}}}) {
    const DepthBias b = depth_bias(every_value(row.form));
    EXPECT_EQ(b.form, row.form);
    EXPECT_EQ((std::vector<float>{b.constant, b.slope, b.floor, b.tan_scale, b.cap, b.factor, b.units,
                                  b.normal_offset_texels}),
              row.used)
        << static_cast<int>(row.form);
    EXPECT_EQ(b.moves_lookup(), row.form == BiasForm::normal_offset);
    EXPECT_EQ(b.tap_reference(), row.form == BiasForm::receiver_plane  ? TapReference::plane_at_tap
                                 : row.form == BiasForm::tangent_plane ? TapReference::plane_at_texel
                                                                       : TapReference::own_depth);
  }
}

TEST(DepthBias, IsInTheReceiversOwnUnit) {
  for (const BiasForm form : {BiasForm::constant, BiasForm::receiver_plane, BiasForm::tangent_plane})
    EXPECT_EQ(depth_bias(every_value(form)).at(probe_of(0.5f, 0.125f), 0), 0.3f * 0.125f);
  for (const BiasForm form : {BiasForm::none, BiasForm::polygon_offset, BiasForm::normal_offset})
    EXPECT_EQ(depth_bias(every_value(form)).at(probe_of(0.5f, 0.125f), 0), 0);
}

TEST(DepthBias, OfANormalOffsetIsALengthAndNoDepth) {
  LightFrame frame;
  frame.extent_m = 20;
  frame.resolution = 1000;
  BiasSettings settings = every_value(BiasForm::normal_offset);
  settings.normal_offset = 1.5;
  for (const BiasUnit unit : {BiasUnit::depth, BiasUnit::m, BiasUnit::texel}) {
    settings.unit = unit;
    const DepthBias bias = depth_bias(settings);
    // 1.5 texels of 20 mm, whatever the unit of the others.
    EXPECT_DOUBLE_EQ(bias.normal_offset_m(frame, {1, 2, 3}), 0.03);
    EXPECT_LT(glm::length(bias.looked_up(frame, {1, 2, 3}, {0, -1, 0}) - glm::dvec3(1, 1.97, 3)), 1e-15);
  }
  // Of a point light, of a texel at the receiver: 2 z / resolution with z along the face's axis.
  frame.kind = LightKind::point;
  EXPECT_DOUBLE_EQ(depth_bias(settings).normal_offset_m(frame, {1, 2, -3}), 1.5 * 2 * 3 / 1000);
  settings.normal_offset = 0;
  EXPECT_FALSE(depth_bias(settings).moves_lookup());
}

TEST(DepthBias, OfASlopeIsTheShadersFloatArithmetic) {
  const DepthBias bias{.form = BiasForm::slope, .slope = 0.05f, .floor = 0.005f};
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

TEST(DepthBias, OfATanIsHeldBetweenItsFloorAndItsCap) {
  const DepthBias bias{.form = BiasForm::tan, .floor = 0.005f, .tan_scale = 0.01f, .cap = 0.05f};
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
