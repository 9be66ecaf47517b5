// What a shadow's own error does to the values is no wrong delivery, and what a delivery does to them is named by evidence that no
// shadow makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "frames/value_curve.h"
#include "tests/frames/wrong_delivery.h"

namespace noonmark::test {
namespace {

FrameVerdict verdict_of(const Delivered& from, const Image<float>& visibility) {
  GivenFrame frame = from.frame;
  frame.visibility = visibility;
  return judge_frame(*from.scene, *from.tracer, frame, {});
}

float srgb(float v) {
  return v <= 0.0031308f ? 12.92f * v : 1.055f * static_cast<float>(std::pow(v, 1 / 2.4)) - 0.055f;
}
float gamma_22(float v) { return static_cast<float>(std::pow(v, 1 / 2.2)); }
float as_8_bits(float v) { return std::round(v * 255) / 255; }

// ---- values

TEST(Values, SumsOfWeightsMayBeRounded) {
  for (const float by : {1e-7f, 5e-6f}) {
    const auto rounded = [&](float v) { return v == 1 ? 1 + by : v == 0 ? -by : v; };
    const CheckResult found = check_named(verdict_of(good(), each_value(good().frame.visibility, rounded)), "values");
    EXPECT_EQ(found.state, CheckState::passed) << found.says;
  }
  const auto beyond = [](float v) { return v == 1 ? 1.001f : v; };
  EXPECT_EQ(check_named(verdict_of(good(), each_value(good().frame.visibility, beyond)), "values").state,
            CheckState::failed);
}

// ---- encoding

TEST(Encoding, TheLevelsOfAFilterTellIt) {  // of 9 taps
  EXPECT_EQ(check_named(good().judged(), "encoding").state, CheckState::passed);
  expect_named(with(each_value(good().frame.visibility, srgb)), "encoding", "sRGB");
  for (const auto& [power, name] :
       {std::pair{1.8, "a gamma of 1.8"}, {2.0, "a square root"}, {2.2, "a gamma of 2.2"}, {2.4, "a gamma of 2.4"}}) {
    const double root = 1 / power;
    const auto encoded = [&](float v) { return static_cast<float>(std::pow(v, root)); };
    expect_named(with(each_value(good().frame.visibility, encoded)), "encoding", name);
  }
  expect_named(with(each_value(good().frame.visibility, [](float v) { return as_8_bits(srgb(v)); })), "encoding",
               "encoded with");
}

// A lookup that lights the middle of its edges: as bright as sRGB, but no curve makes it.
TEST(Encoding, AnAsymmetricEdgeIsNotSrgb) {
  for (const float power : {0.6f, 0.8f, 1.5f}) {
    const auto bent = [&](float v) { return static_cast<float>(std::pow(v, power)); };
    const CheckResult found = check_named(verdict_of(good(), each_value(good().frame.visibility, bent)), "encoding");
    EXPECT_EQ(found.state, CheckState::not_checked) << power << ": " << found.says;
  }
}

// Two weights that are no k / n, each rounded to five values: decoded with a gamma of 2.2 all are multiples of 1/39 within a
// shader's rounding, which two numbers are by chance.
TEST(Encoding, RoundedWeightsAreNotGamma) {
  int pixel = 0;
  const auto weighted = [&](float v) {
    if (!(v > 0 && v < 1)) return v;
    return (v < 0.5f ? 0.3931f : 0.6069f) + static_cast<float>(pixel++ % 5 - 2) * 2e-5f;
  };
  const CheckResult found = check_named(verdict_of(good(), each_value(good().frame.visibility, weighted)), "encoding");
  EXPECT_NE(found.state, CheckState::failed) << found.says;
}

// The blend of 2 x 2 texels that are lit or dark by chance: each is a shadow's error, and the ramps between them are straight.
Image<float> blended_texels(const Delivered& from) {
  constexpr double texel_m = 0.4;
  const LightFrame light = from.judged().light;
  const auto is_lit = [](double i, double j) {
    return std::fmod(std::abs(std::sin(12.9898 * i + 78.233 * j)) * 43758.5453, 1.0) < 0.5;
  };
  Image<float> v = from.frame.visibility;
  for (size_t i = 0; i < v.size(); ++i) {
    if (std::isnan(v[i])) continue;
    const glm::dvec3 p = light.to_light(from.receivers.position[i]);
    const double x = p.x / texel_m, y = p.y / texel_m, a = x - std::floor(x), b = y - std::floor(y);
    const auto at = [&](int dx, int dy) { return static_cast<double>(is_lit(std::floor(x) + dx, std::floor(y) + dy)); };
    v[i] = static_cast<float>((1 - a) * (1 - b) * at(0, 0) + a * (1 - b) * at(1, 0) + (1 - a) * b * at(0, 1) +
                              a * b * at(1, 1));
  }
  return v;
}

TEST(Encoding, TheRampsOfABlendTellIt) {
  const Image<float> linear = blended_texels(good());
  const auto encoding = [&](float (*curve)(float)) {
    return check_named(verdict_of(good(), each_value(linear, curve)), "encoding");
  };
  const CheckResult as_it_is = encoding([](float v) { return v; });
  EXPECT_EQ(as_it_is.state, CheckState::passed) << as_it_is.says;
  EXPECT_NE(as_it_is.says.find("straight"), std::string::npos) << as_it_is.says;
  for (const auto& curve : {srgb, gamma_22}) {
    const CheckResult found = encoding(curve);
    EXPECT_EQ(found.state, CheckState::failed) << found.says;
    EXPECT_NE(found.says.find("encoded with"), std::string::npos) << found.says;
  }
}

// Wide soft edges in 8 bits: three neighbours are near a straight ramp whatever curve decodes them. The shares are those of a right frame
// (a facade at 160 x 90 pixels, rounded) and of one that was encoded.
TEST(Encoding, RampsThatEveryCurveStraightensTellNothing) {
  CurveEvidence found;
  found.ramps = 41;
  found.straight = {0, 0.32, 0.2};
  found.straight_by_chance = 0.76;
  EXPECT_EQ(found.by_ramps(), nullptr);
  found.straight_by_chance = 0.06;
  ASSERT_NE(found.by_ramps(), nullptr);
  EXPECT_STREQ(found.by_ramps()->name, "sRGB");
}

TEST(Encoding, WithoutAFilterNothingTellsIt) {
  const Delivered hard = good_frame("cube-room", width, height, 0);
  EXPECT_EQ(check_named(hard.judged(), "encoding").state, CheckState::not_checked);
}

TEST(Encoding, RoundingIsKnownByTheValues) {
  Image<float> v(64, 1, 0);
  const auto rounded = [&](const std::function<double(int)>& f) {
    for (int x = 0; x < v.width; ++x) v.at(x, 0) = static_cast<float>(f(x));
    return rounding_of(v);
  };
  EXPECT_EQ(rounded([](int x) { return (4 * x + 1) / 255.0; }), 0.5 / 255);
  EXPECT_EQ(rounded([](int x) { return x / 64.0; }), 0x1p-12);
  EXPECT_LT(rounded([](int x) { return (977 * x + 5) / 65535.0; }), 0x1p-12);
  EXPECT_LT(rounded([](int x) { return x / 67.0; }), 0x1p-12);
}

// ---- shaded

// Acne of texels that are many pixels wide, softened by a filter: no pixel reaches 1, and from pixel to pixel it is as smooth as
// shading.
TEST(Shaded, FilteredAcneOfCoarseTexelsIsNot) {
  const LightFrame light = good().judged().light;
  Image<float> v = good().frame.visibility;
  for (size_t i = 0; i < v.size(); ++i) {
    const glm::dvec3 p = light.to_light(good().receivers.position[i]);
    if (good().truth.lit[i]) v[i] *= static_cast<float>(0.6 + 0.15 * std::sin(3 * p.x) + 0.15 * std::sin(4 * p.y));
  }
  const FrameVerdict verdict = verdict_of(good(), v);
  const CheckResult& found = check_named(verdict, "shaded");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
  EXPECT_NE(found.says.find("acne"), std::string::npos) << found.says;
  EXPECT_FALSE(verdict.refused());
  EXPECT_GT(verdict.metrics.at("frame_acne"), 0.2);
}

double cosine_at(const Delivered& from, const LightFrame& light, size_t i) {
  const glm::dvec3 p = from.receivers.position[i], n = from.receivers.normal[i];
  return std::max(0.0, glm::dot(n, light.direction_to_light(p)));
}

// As it is, with ambient light, and as a screen shows it.
TEST(Shaded, NLIsKnownUnderEveryLight) {
  using Shade = double (*)(double);
  for (const char* scene : {"cube-room", "spot-room", "point-room"}) {
    const Delivered from = good_frame(scene, width, height);
    const LightFrame light = from.judged().light;
    for (const Shade shade : {Shade([](double x) { return 0.9 * x; }), Shade([](double x) { return 0.15 + 0.7 * x; }),
                              Shade([](double x) { return (1.2 * x + 0.05) / (1.2 * x + 1.05); })}) {
      Image<float> v = from.frame.visibility;
      for (size_t i = 0; i < v.size(); ++i) v[i] = static_cast<float>(shade(v[i] * cosine_at(from, light, i)));
      const CheckResult found = check_named(verdict_of(from, v), "shaded");
      EXPECT_EQ(found.state, CheckState::failed) << scene << ": " << found.says;
    }
  }
}

// Acne, or edges of a filter that lie elsewhere: a third of the pixels is darker than the shading makes them.
TEST(Shaded, WhatAShadowDarkensDoesNotHideNL) {
  const LightFrame light = good().judged().light;
  Image<float> v = good().frame.visibility;
  for (size_t i = 0; i < v.size(); ++i) {
    const int x = static_cast<int>(i % width);
    v[i] *= static_cast<float>(cosine_at(good(), light, i) * (x % 9 < 3 ? 0.2 * (x % 9) : 1));
  }
  const CheckResult found = check_named(verdict_of(good(), v), "shaded");
  EXPECT_EQ(found.state, CheckState::failed) << found.says;
}

// A renderer that shadows all, and a wide filter without a bias, half of whose taps meet the surface itself on every plane.
TEST(Shaded, OneValueThatALookupCanHaveIsNot) {
  for (const float value : {0.0f, 9 / 16.0f}) {
    const FrameVerdict verdict =
        verdict_of(good(), each_value(good().frame.visibility, [&](float v) { return value * v; }));
    const CheckResult& found = check_named(verdict, "shaded");
    EXPECT_EQ(found.state, CheckState::not_checked) << value << ": " << found.says;
    EXPECT_FALSE(verdict.refused()) << value;
  }
}

// The floor has one value, as a filter's acne has there. Whatever a function of N.L makes of it, the other surfaces do not follow.
TEST(Shaded, OneFlatSurfaceIsNoEvidence) {
  Image<float> v = good().frame.visibility;
  size_t floor = 0, other = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    if (std::isnan(v[i]) || !good().truth.lit[i]) continue;
    const bool is_floor = good().receivers.normal[i].y > 0.9f;
    ++(is_floor ? floor : other);
    v[i] *= is_floor ? 0.6037f : 0.3f + 0.3f * static_cast<float>(i * 7919 % 1009) / 1009;
  }
  ASSERT_GT(3 * floor, 2 * other) << "or the floor explains less than is needed";
  const CheckResult found = check_named(verdict_of(good(), v), "shaded");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
}

// The acne of 144 taps, of which by chance six of ten pixels of each surface are as dark as N.L would make them.
TEST(Shaded, TheTapsOfAFilterAreNoEvidence) {
  constexpr int taps = 144;
  const LightFrame light = good().judged().light;
  Image<float> v = good().frame.visibility;
  for (size_t i = 0; i < v.size(); ++i) {
    if (std::isnan(v[i]) || !(v[i] > 0)) continue;
    const double by_cosine = 0.9 * taps * cosine_at(good(), light, i);
    v[i] = static_cast<float>(std::round(i % 10 < 6 ? by_cosine : by_cosine * static_cast<double>(i % 31) / 31) / taps);
  }
  const FrameVerdict verdict = verdict_of(good(), v);
  EXPECT_EQ(check_named(verdict, "encoding").state, CheckState::passed) << check_named(verdict, "encoding").says;
  EXPECT_EQ(check_named(verdict, "shaded").state, CheckState::not_checked) << check_named(verdict, "shaded").says;
  EXPECT_FALSE(verdict.refused());
}

// The acne of a wide filter follows N.L on a plane below a lamp, but not all of it, and nothing keeps the rest below.
TEST(Shaded, AcneThatFollowsNLIsNot) {
  const Delivered from = good_frame("spot-room", width, height);
  const LightFrame light = from.judged().light;
  Image<float> v = from.frame.visibility;
  for (size_t i = 0; i < v.size(); ++i) {
    const int x = static_cast<int>(i % width);
    v[i] *= static_cast<float>(0.3 + 0.5 * cosine_at(from, light, i) + (x % 9 < 3 ? -0.03 : x % 9 < 7 ? 0 : 0.03));
  }
  const CheckResult found = check_named(verdict_of(from, v), "shaded");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
}

// ---- intensity

// Where the truth is dark: what is left of the light at this distance of the occluder.
Image<float> leaking(const Delivered& from, const std::function<double(double)>& left) {
  const FrameVerdict verdict = from.judged();
  Image<uint8_t> dark(from.frame.visibility.width, from.frame.visibility.height, 0);
  for (size_t i = 0; i < dark.size(); ++i) dark[i] = verdict.counted[i] && !verdict.truth.lit[i];
  const Image<float> distance = from.tracer->occluder_distance(verdict.receivers, verdict.light, dark);
  Image<float> v = from.frame.visibility;
  for (size_t i = 0; i < v.size(); ++i)
    if (dark[i]) v[i] = static_cast<float>(left(distance[i]));
  return v;
}

TEST(Intensity, ALeakThatDependsOnTheOccluderIsNone) {
  const FrameVerdict verdict = verdict_of(good(), leaking(good(), [](double d) { return 0.95 * std::exp(-0.3 * d); }));
  const CheckResult& found = check_named(verdict, "intensity");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
  EXPECT_NE(found.says.find("differs by place"), std::string::npos) << found.says;
  EXPECT_FALSE(verdict.refused());
  const CheckResult one = check_named(verdict_of(good(), leaking(good(), [](double) { return 0.5; })), "intensity");
  EXPECT_EQ(one.state, CheckState::failed) << one.says;
}

// An edge's filter that reaches further, or a bias that loses some of the shadow.
TEST(Intensity, SomeBrighterPixelsDoNotHideIt) {
  for (const float dark : {0.2f, 0.45f}) {  // a half and three quarters are of 2 x 2 taps
    Image<float> v = leaking(good(), [&](double) { return dark; });
    for (size_t i = 0; i < v.size(); ++i)
      if (!std::isnan(v[i]) && !good().truth.lit[i] && i % 9 == 0) v[i] = 0.5f * (1 + dark);
    const CheckResult found = check_named(verdict_of(good(), v), "intensity");
    EXPECT_EQ(found.state, CheckState::failed) << dark << ": " << found.says;
  }
}

// Of 9 taps the three of one column may reach over a thin occluder, wherever they lie behind it.
TEST(Intensity, AColumnOfTheFilterIsNone) {
  const CheckResult found =
      check_named(verdict_of(good(), leaking(good(), [](double) { return 3 / 9.0f; })), "intensity");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
}

// A map holds the occluder that the light meets first, and an exponential map knows that distance alone: it is one below a
// level top. The shadows of all else are left out.
TEST(Intensity, ALeakBelowOneTopTellsNothing) {
  const Delivered from = good_frame("cube-room", 2 * width, 2 * height);
  const FrameVerdict verdict = from.judged();
  Image<uint8_t> dark(2 * width, 2 * height, 0);
  for (size_t i = 0; i < dark.size(); ++i) dark[i] = verdict.counted[i] && !verdict.truth.lit[i];
  const Image<uint32_t> first = from.tracer->first_on_the_way(verdict.receivers, verdict.light, dark);
  std::map<uint32_t, size_t> pixels;  // by the triangle that is first
  for (size_t i = 0; i < dark.size(); ++i)
    if (dark[i]) ++pixels[first[i]];
  const auto most =
      std::max_element(pixels.begin(), pixels.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  Image<float> v = from.frame.visibility;
  for (size_t i = 0; i < v.size(); ++i)
    if (dark[i]) v[i] = first[i] == most->first && verdict.receivers.normal[i].y > 0.9f ? 0.4f : no_surface;
  const CheckResult found = check_named(verdict_of(from, v), "intensity");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
  EXPECT_NE(found.says.find("different distances"), std::string::npos) << found.says;
}

// Below a plate that is parallel to its floor, an exponential map leaks by one value.
TEST(Intensity, OneDistanceTellsNothing) {
  const Delivered plate = good_frame("plate", width, height);
  const CheckResult found =
      check_named(verdict_of(plate, leaking(plate, [](double d) { return std::exp(-0.3 * d); })), "intensity");
  EXPECT_NE(found.state, CheckState::failed) << found.says;
}

}  // namespace
}  // namespace noonmark::test
