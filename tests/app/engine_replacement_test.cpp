// What an engine has no field for is replaced by the least that suffices, and what the engine does with its lines is settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/advise/engines/cover.h"
#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_settings.h"
#include "technique/setting_rules.h"
#include "tests/app/engine_case.h"

namespace noonmark {
namespace {

using namespace test;

// A filter that reaches further needs the greater bias of law 1: k 1 of hardware against 2 of Castano's 3 x 3. The numbers
// hold it.
TEST(Engines, AWiderFilterGetsAGreaterBias) {
  Settings s = constant_m(0.06);
  s.filter = FilterSettings("hardware", {});
  const EngineAdvice got = advice(s, "Filament");
  expect_written(typed(got, "constantBias = "), 2 * 0.06);
  EXPECT_NE(joined(got.cannot).find("the lines hold 2 times"), std::string::npos);
  EXPECT_EQ(joined(advice(s, "Bevy").cannot).find("filter.kind"), std::string::npos) << "it has this filter";
}

// A part on the other side, or in another form with the same law, is typed too: on a plane it gains the same depth.
TEST(Engines, APartOfTheSameLawIsTypedAndSaid) {
  Settings s = simple();
  s.bias.unit = BiasUnit::texel;
  s.bias["tan"] = 1.5;  // b tan(theta) as an offset b sin(theta) against the normal
  const EngineAdvice got = advice(s, "Babylon.js");
  expect_written(typed(got, "normalBias = "), 1.5 * texel_m);
  EXPECT_NE(joined(got.cannot).find("bias.tan acts on"), std::string::npos);
}

// An offset by axes gives k w A tan(theta), A at most sqrt(2). A plain normal offset d gives d / cos(theta), which is at least
// as much at every slope only from sqrt(2) k w on; one by the sine gives d tan(theta), so sqrt(2) k w too.
TEST(Engines, AnOffsetByAxesIsReplacedByItsLeastUpperBound) {
  Settings s = simple();
  s.bias["normal_offset_axes"] = 0.5;
  const double least_m = std::numbers::sqrt2 * 0.5 * texel_m;
  expect_written(typed(advice(s, "three.js"), "normalBias = "), least_m);
  expect_written(typed(advice(s, "Babylon.js"), "normalBias = "), least_m);
  // Bevy's one linear fetch reaches k = 1, and its texels are its own: texels of sqrt(2) each.
  expect_written(typed(advice(s, "Bevy"), "shadow_normal_bias: "), 1);
}

// A plane of law 1 for the reference of a tap's own texel: the same offset, of the filter's whole reach.
TEST(Engines, APlaneOfReferenceIsReplacedByTheKernelsReach) {
  Settings s = simple();
  s.bias.reference = "texel_plane";  // and the filter none, which reaches half a texel
  expect_written(typed(advice(s, "three.js"), "normalBias = "), std::numbers::sqrt2 * 0.5 * texel_m);
}

// (1 - c) b is at most b, but also at most b / 4 of a normal offset, because (1 - c) c is greatest at 60 degrees; at 45
// degrees the offset is less (sqrt(2) / 4 against 1), so it is taken.
TEST(Engines, ASlopeIsReplacedByTheLesserOfTwoFields) {
  Settings s = constant_m(0);
  s.bias["slope"] = 0.1;
  expect_written(typed(advice(s, "three.js"), "normalBias = "), 0.1 / 4);
  EXPECT_EQ(typed(advice(s, "three.js"), "shadow.bias = "), 0);
}

// Godot's normal bias is d s t, which no d makes A t at small slopes, and a constant is none at grazing ones; together they
// are, and at no slope is what they give less.
TEST(Engines, TwoFieldsReplaceWhatNoOneCan) {
  const double needed = std::numbers::sqrt2;
  const auto cover = least_cover({BiasForm::constant, BiasForm::sideways},
                                 [&](double theta, double phi) { return gain(BiasForm::axes, theta, phi); });
  ASSERT_TRUE(cover);
  const double c = (*cover)[0], d = (*cover)[1];
  EXPECT_GE(d, needed * (1 - 1e-5)) << "at 90 degrees";
  double least = 1;
  for (int i = 1; i < 9000; ++i) {
    const double theta = i * std::numbers::pi / 18000;
    const double given = c + d * std::sin(theta) * std::tan(theta);
    least = std::min(least, given / (needed * std::tan(theta)));
  }
  EXPECT_GE(least, 1 - 1e-5);
  EXPECT_LE(least, 1 + 1e-5) << "and it touches, so it is the least";
  EXPECT_FALSE(least_cover({BiasForm::constant}, [&](double theta, double) { return std::tan(theta); }));
}

// URP gives a point light no normal bias, and no constant gives as much as a tangent at every slope: there are no lines, and
// the first sentence says why.
TEST(Engines, WhereNothingSufficesThereAreNoLines) {
  Settings s = simple(LightChoice::point);
  s.bias["normal_offset_axes"] = 1;
  const EngineAdvice got = advice(s, "Unity URP");
  EXPECT_TRUE(got.lines.empty());
  EXPECT_EQ(got.cannot.front().find("There are no lines: no fields"), 0u) << joined(got.cannot);
  EXPECT_NE(got.cannot.front().find("bias.normal_offset_axes = 1"), std::string::npos);
  EXPECT_FALSE(got.emulated);
}

// What three.js does with its lines: the same map, the constant as it is, and a plain normal offset in place of that by axes.
TEST(Engines, TheReplacementIsSettingsLikeAnyOther) {
  Settings s = constant_m(0.06);
  s.bias["normal_offset_axes"] = 0.5;
  const EngineAdvice got = advice(s, "three.js");
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  const Settings& does = *got.emulated;
  EXPECT_NEAR(does.bias["normal_offset"], std::numbers::sqrt2 / 2, written);
  EXPECT_EQ(does.bias["normal_offset_axes"], 0);
  EXPECT_EQ(does.bias["constant"], 0.06);
  EXPECT_EQ(does.bias.unit, BiasUnit::m);
  EXPECT_EQ(does.map.resolution, 512);
  EXPECT_EQ(does.filter.kind, "none");
  EXPECT_EQ(as_engine(got, s).map.extent_m, 16);
}

// In a right-handed scene forceBackFacesOnly draws the front faces (its winding is that of a left-handed one).
TEST(Engines, BabylonDrawsFrontFacesIntoItsMap) {
  Settings s = constant_m(0.06);
  s.map.cull = CulledFaces::back;
  EXPECT_NE(joined(advice(s, "Babylon.js").lines).find("forceBackFacesOnly = true"), std::string::npos);
  s.map.cull = CulledFaces::front;
  EXPECT_NE(joined(advice(s, "Babylon.js").lines).find("forceBackFacesOnly = false"), std::string::npos);
}

// What URP does: its own extent and power of two, one linear fetch, 16 bits, and the polygon offset that is always on. That
// gives 2.5 w max(|cos|, |sin|) t, at least 1.25 w A t, more than the k w A t of one linear fetch: no normal bias is left.
TEST(Engines, AnEngineThatFitsItsMapIsEmulatedWithIt) {
  Settings s = simple();
  s.bias["normal_offset_axes"] = 0.5;
  const EngineAdvice got = advice(s, "Unity URP");
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  const Settings does = as_engine(got, s);
  EXPECT_EQ(does.map.fit, MapFit::sphere);
  EXPECT_NEAR(*does.map.reach_m, typed(got, "Max Distance: "), written * *does.map.reach_m);
  EXPECT_EQ(does.map.resolution, typed(got, "Shadow Resolution: "));
  EXPECT_EQ(does.map.format, DepthFormat::d16);
  EXPECT_EQ(does.bias["polygon_factor"], 2.5);
  EXPECT_EQ(typed(got, "Normal: "), 0);
  EXPECT_EQ(does.filter.kind, "hardware");
  const Frustum seen = frustum(s);
  const double far_m = *does.map.reach_m, half = seen.half_diagonal * far_m;
  expect_written(make(does).frame.extent_m, (far_m * far_m + half * half) / far_m);
}

// Godot's normal bias has no part of Noonmark; turned and slope together gain its d sin tan on every plane.
TEST(Engines, GodotsNormalBiasIsEmulatedByTwoParts) {
  Settings s = simple();
  s.bias["normal_offset_axes"] = 0.5;
  const EngineAdvice got = advice(s, "Godot");
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  const double d = typed(got, "shadow_normal_bias = "),
               engine_texel_m = make(as_engine(got, s)).frame.texel_m({0, 0, 2});
  EXPECT_GT(d, std::numbers::sqrt2 * (1 - written)) << "at 90 degrees only the normal bias is left";
  for (double theta : {0.2, 0.8, 1.4}) {
    const double gained = got.emulated->bias["normal_offset_turned"] * engine_texel_m * gain(BiasForm::turned, theta) +
                          got.emulated->bias["slope"] * gain(BiasForm::slope, theta);
    expect_written(gained, d * engine_texel_m * gain(BiasForm::sideways, theta));
  }
}

// A map that not even the engine's largest makes fine enough needs cascades, and the advice says so.
TEST(Engines, WhatNeedsCascadesIsSaid) {
  Settings s = simple();
  s.map.resolution = 8192;
  s.map.extent_m = 1;
  EXPECT_NE(joined(advice(s, "Unity URP").cannot).find("needs cascades"), std::string::npos);
  EXPECT_EQ(typed(advice(s, "Unity URP"), "Shadow Resolution: "), 4096);
  EXPECT_EQ(joined(advice(simple(), "Unity URP").cannot).find("needs cascades"), std::string::npos);
}

}  // namespace
}  // namespace noonmark
