// Recommended settings as numbers for other engines. Each round trip types a number into the engine's own formula,
// written here from the engine's documents and not from the program, and expects the recommended bias back.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_settings.h"
#include "base/file.h"
#include "scenes/library.h"
#include "technique/filters.h"
#include "technique/setting_rules.h"
#include "tests/app/engine_case.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

using namespace test;

// three.js: the receiver's window depth becomes depth + bias; a metre is 1 / (far - near) of an orthographic map.
TEST(Engines, ThreeGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.bias["normal_offset"] = 1.5;
  const EngineAdvice got = advice(s, "three.js");
  expect_written(-typed(got, "shadow.bias = ") * (42 - 2), 0.06);
  expect_written(typed(got, "shadow.normalBias = "), 1.5 * texel_m);
  expect_written(typed(got, "camera.right = "), 8);
}

// The window depth d(z) = far (z - near) / (z (far - near)) of a perspective map, and its derivative.
TEST(Engines, ThreeTakesTheDepthOfASpotLightAsItIs) {
  Settings s = simple(LightChoice::spot);
  s.bias["constant"] = 0.0007;
  expect_written(typed(advice(s, "three.js"), "shadow.bias = "), -0.0007);
  s = constant_m(0.03, LightChoice::spot);
  expect_written(-typed(advice(s, "three.js"), "shadow.bias = ") * (10.0 * 10 * 40) / (42 * 2), 0.03);
  s = constant_m(0.03, LightChoice::point);
  expect_written(-typed(advice(s, "three.js"), "shadow.bias = ") * (10.0 * 10 * 40) / (42 * 2), 0.03);
}

// Babylon.js: the caster's clip depth, 2 for the whole map in WebGL, becomes z + bias w; without PCF the stored share of
// near to far becomes depth + bias, and a point light's distance / (near + far) too.
TEST(Engines, BabylonGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.bias["caster_normal_offset_sin"] = 1.5;
  EngineAdvice got = advice(s, "Babylon.js");
  expect_written(typed(got, ".bias = ") * 40, 0.06);  // filter none
  expect_written(typed(got, ".normalBias = "), 1.5 * texel_m);
  s.filter = FilterSettings("castano", {{"size", 5}});
  got = advice(s, "Babylon.js");
  EXPECT_NE(joined(got.lines).find("QUALITY_HIGH"), std::string::npos);
  expect_written(typed(got, ".bias = ") / 2 * 40, 0.06);
  expect_written(typed(advice(constant_m(0.06, LightChoice::point), "Babylon.js"), ".bias = ") * (42 + 2), 0.06);
  expect_written(typed(advice(constant_m(0.06, LightChoice::spot), "Babylon.js"), ".bias = ") * (42 - 2), 0.06);
}

// Filtered maps.

Settings filtered(const std::string& lookup, FilterSettings filter = {}) {
  Settings s = constant_m(0.06);
  s.lookup.kind = lookup;
  s.filter = std::move(filter);
  validate(s, LightKind::directional);
  return s;
}

bool says(const EngineAdvice& advice, const std::string& text) {
  return joined(advice.cannot).find(text) != std::string::npos;
}

// VSMShadowMap: the bias is of the receiver, as with comparisons; what the shader has as numbers is no setting there.
TEST(Engines, ThreeHasItsOwnVariance) {
  Settings s = filtered("three_vsm");
  s.lookup["radius"] = 2.5;
  s.lookup["samples"] = 9;
  s.bias["normal_offset"] = 1.5;
  EngineAdvice got = advice(s, "three.js");
  EXPECT_NE(joined(got.lines).find("shadowMap.type = THREE.VSMShadowMap;  // lookup.kind = three_vsm"),
            std::string::npos);
  EXPECT_EQ(typed(got, "shadow.radius = "), 2.5);
  EXPECT_EQ(typed(got, "shadow.blurSamples = "), 9);
  expect_written(-typed(got, "shadow.bias = ") * (42 - 2), 0.06);
  expect_written(typed(got, "shadow.normalBias = "), 1.5 * texel_m);
  EXPECT_TRUE(says(got, "lookup.reduction = 0: the engine computes with 0.3."));
  EXPECT_TRUE(says(got, "lookup.reduction_span = 0: the engine computes with 0.65."));
  EXPECT_FALSE(says(got, "lookup.v_min"));
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  const Settings there = as_engine(got, s);
  EXPECT_EQ(there.lookup["reduction"], 0.3);
  EXPECT_EQ(there.lookup["reduction_span"], 0.65);
  EXPECT_EQ(there.lookup["radius"], 2.5);
  expect_written(there.bias["constant"], 0.06);
  validate(there, LightKind::directional);
  s.lookup["reduction"] = 0.3, s.lookup["reduction_span"] = 0.65;
  EXPECT_FALSE(says(advice(s, "three.js"), "lookup.reduction"));
}

// The exponential maps: `bias` is added to each stored depth, a share of near to far, and is the same as one of the receiver. The
// texels of the blur are 2 blurBoxOffset + 1, or blurKernel, whose standard deviation is a sixth of its ways.
TEST(Engines, BabylonHasItsOwnExponentials) {
  Settings s = filtered("babylon_close_esm", {"box", {{"size", 7}}});
  s.lookup["exponent"] = 35;
  EngineAdvice got = advice(s, "Babylon.js");
  EXPECT_NE(joined(got.lines).find("useBlurCloseExponentialShadowMap = true;"), std::string::npos);
  EXPECT_EQ(typed(got, "depthScale = "), 35);
  EXPECT_EQ(typed(got, "blurScale = "), 1);
  EXPECT_EQ(2 * typed(got, "blurBoxOffset = ") + 1, 7);
  expect_written(typed(got, "shadowGenerator.bias = ") * 40, 0.06);
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  const Settings there = as_engine(got, s);
  EXPECT_EQ(there.lookup, s.lookup);
  EXPECT_EQ(there.filter, s.filter);
  expect_written(there.bias["constant"], 0.06);
  validate(there, LightKind::directional);

  got = advice(filtered("babylon_esm"), "Babylon.js");
  EXPECT_NE(joined(got.lines).find("useExponentialShadowMap = true;"), std::string::npos);
  EXPECT_EQ(joined(got.lines).find("blur"), std::string::npos);

  s = filtered("babylon_esm", {"gaussian", {{"size", 9}, {"sigma_texels", 8.0 / 6}}});
  got = advice(s, "Babylon.js");
  EXPECT_NE(joined(got.lines).find("useBlurExponentialShadowMap = true;"), std::string::npos);
  EXPECT_EQ(typed(got, "blurKernel = "), 9);
  EXPECT_EQ(got.emulated->filter, s.filter);
  s.filter["sigma_texels"] = 2;
  got = advice(s, "Babylon.js");
  EXPECT_TRUE(says(got, "the nearest blur here is a Gaussian of 9 texels"));
  expect_written(got.emulated->filter["sigma_texels"], 8.0 / 6);

  // A normal bias moves the casters: what the map of moments shows then is not measured.
  s.bias["tan"] = 0.01;
  got = advice(s, "Babylon.js");
  expect_written(typed(got, "shadowGenerator.normalBias = "), 0.01);
  EXPECT_FALSE(got.emulated);
  EXPECT_NE(got.why_not_emulated.find("shadowGenerator.normalBias"), std::string::npos);
}

TEST(Engines, SayWhichFilteredMapsTheyLack) {
  for (const char* lookup : {"vsm", "esm", "evsm2", "evsm4", "msm", "msm_hausdorff"}) {
    const Case c = make(filtered(lookup));
    for (const EngineAdvice& one : engine_advice(c.settings, c.frame, c.scene)) {
      EXPECT_TRUE(one.lines.empty()) << one.engine << ", " << lookup;
      EXPECT_TRUE(one.cannot.front().starts_with("There are no lines for lookup.kind = " + std::string(lookup) + ". "))
          << one.engine;
      EXPECT_FALSE(one.emulated);
      EXPECT_EQ(one.why_not_emulated, "there are no lines");
    }
  }
  EXPECT_TRUE(says(advice(filtered("vsm"), "three.js"), "three_vsm"));
  EXPECT_TRUE(says(advice(filtered("esm"), "Babylon.js"), "babylon_close_esm"));
  EXPECT_TRUE(advice(filtered("three_vsm"), "Babylon.js").lines.empty());
  EXPECT_TRUE(advice(filtered("babylon_esm"), "three.js").lines.empty());
  Settings cascades = filtered("three_vsm");
  cascades.cascades.count = 2;
  cascades.map.extent_m = cascades.map.near_m = cascades.map.far_m = std::nullopt;
  cascades.map.fit = MapFit::sphere;
  EXPECT_TRUE(says(advice(cascades, "three.js"), "There are no lines for cascades with lookup.kind = three_vsm."));
}

// Godot: bias / 100 * range * blur * quality radius, with a range of the cascade's diameter and 20 m; a spot light's
// clip depth (near 0.025 m).
TEST(Engines, GodotGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.filter = FilterSettings("hardware", {});
  EngineAdvice got = advice(s, "Godot");
  const Frustum seen = frustum(s);
  const double far_m = typed(got, "max_distance = "), size = typed(got, "atlas_set_size(");
  expect_written(far_m, seen.farthest_m);
  const double wide_m = middle_sphere_m(seen, far_m) * size / (size - 2);
  EXPECT_LE(wide_m / size, texel_m * (1 + written)) << "its texels are no wider than the recommended ones";
  EXPECT_TRUE(size == 512 || wide_m / size > texel_m / 2.1) << "and no finer than needed";
  expect_written(typed(got, "shadow_bias = ") / 100 * (wide_m + 20) * typed(got, "shadow_blur = ") * 1, 0.06);
  s.filter = FilterSettings("box", {{"size", 5}});
  got = advice(s, "Godot");
  EXPECT_NE(joined(got.lines).find("SHADOW_QUALITY_SOFT_LOW"), std::string::npos);
  expect_written(typed(got, "shadow_bias = ") / 100 * (wide_m + 20) * typed(got, "shadow_blur = ") * 2, 0.06);
  expect_written(1 + 2 * typed(got, "shadow_blur = ") * std::sqrt(3.5 / 4), 2.5);  // the reach of a box of 5 x 5

  s = constant_m(0.06, LightChoice::spot);
  s.filter = FilterSettings("hardware", {});
  s.bias["normal_offset_turned"] = 1.5;
  got = advice(s, "Godot");
  const double shift = typed(got, "shadow_bias = ") / 100 / 10;  // of z / w, at 10 m
  expect_written(shift * (10.0 * 10 * (42 - 0.025)) / (42 * 0.025), 0.06);
  const double spot_texel_m = 2 * 10 * std::tan(std::numbers::pi / 6) / 512;
  expect_written(typed(got, "shadow_normal_bias = ") * 10 / 512 * 10, 1.5 * spot_texel_m);
  // One linear fetch reaches twice as far as the one tap of these settings.
  expect_written(typed(advice(constant_m(0.06, LightChoice::point), "Godot"), "shadow_bias = "), 2 * 0.06);
}

// Bevy: metres towards the light; sqrt(2) texels along the normal, of a spot light 2 tan(outer) / size of the distance.
TEST(Engines, BevyGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.bias["normal_offset"] = 1.5;
  EngineAdvice got = advice(s, "Bevy");
  const Frustum seen = frustum(s);
  const double far_m = typed(got, "maximum_distance: "), size = typed(got, "size: ");
  expect_written(far_m, seen.farthest_m);
  const double wide_m = std::ceil(far_m * std::max(2 * seen.half_diagonal, std::hypot(1, seen.half_diagonal)));
  EXPECT_LE(wide_m / size, texel_m * (1 + written));
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  EXPECT_EQ(*got.emulated->map.extent_m, wide_m);
  // One linear fetch reaches twice as far as the one tap of the settings, so law 1 doubles both.
  expect_written(typed(got, "shadow_depth_bias: "), 2 * 0.06);
  expect_written(typed(got, "shadow_normal_bias: ") * std::numbers::sqrt2, 2 * 1.5);
  s.light.kind = LightChoice::spot;
  s.map.extent_m.reset();
  got = advice(s, "Bevy");
  expect_written(typed(got, "shadow_normal_bias: ") * std::numbers::sqrt2, 2 * 1.5);
  expect_written(typed(got, "outer_angle: "), std::numbers::pi / 6);
}

// PlayCanvas: 10 times the bias is the factor of a polygon offset; metres along the normal, which also replace a constant; the shader
// always subtracts 0.0001 of a window depth of 40 m.
TEST(Engines, PlayCanvasGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.filter = FilterSettings("hardware", {});
  s.bias["polygon_factor"] = 2;
  s.bias["normal_offset"] = 1.5;
  EngineAdvice got = advice(s, "PlayCanvas");
  const Frustum seen = frustum(s);
  const double far_m = typed(got, "shadowDistance = "), size = typed(got, "shadowResolution = ");
  expect_written(far_m, seen.farthest_m);
  const double engine_texel_m = middle_sphere_m(seen, far_m) / size;
  EXPECT_LE(engine_texel_m, texel_m * (1 + written));
  expect_written(typed(got, "shadowBias = ") * 10, 2);
  expect_written(typed(got, "normalOffsetBias = "), 1.5 * engine_texel_m + 0.06);
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  expect_written(got.emulated->bias["constant"], 0.0001 * 40);
  EXPECT_EQ(got.emulated->map.cull, CulledFaces::none) << "the plane has no materials with one side";
  got = advice(constant_m(0.06, LightChoice::spot), "PlayCanvas");
  EXPECT_TRUE(got.lines.empty());
  EXPECT_NE(joined(got.cannot).find("the bias of a spot light"), std::string::npos);
}

// The map draws what the materials show: with Babylon.js both faces of two-sided ones, unless front faces alone are asked for.
TEST(Engines, BabylonDrawsTheFacesOfTheMaterials) {
  Settings s = constant_m(0.06);
  Case c = make(s);
  const auto culled = [&] { return advice_for_engine("babylon", c.settings, c.frame, c.scene).emulated->map.cull; };
  EXPECT_EQ(culled(), CulledFaces::none);
  c.settings.map.cull = CulledFaces::back;
  EXPECT_EQ(culled(), CulledFaces::back);
  c.settings.map.cull = CulledFaces::none;
  c.scene.single_sided.assign(c.scene.triangles.size(), true);
  EXPECT_EQ(culled(), CulledFaces::back);
}

// Filament: metres away from the light; half texels of diameter / (size - 2) times |N.u| + |N.v|.
TEST(Engines, FilamentGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.filter = FilterSettings("castano", {{"size", 3}});
  s.bias["normal_offset_axes"] = 1.5;
  s.bias["polygon_factor"] = 2;
  s.bias["polygon_units"] = 3;
  const EngineAdvice got = advice(s, "Filament");
  const Frustum seen = frustum(s);
  const double far_m = typed(got, "shadowFar = "), size = typed(got, "mapSize = ");
  expect_written(far_m, seen.farthest_m);
  const double engine_texel_m = middle_sphere_m(seen, far_m) / (size - 2);
  EXPECT_LE(engine_texel_m, texel_m * (1 + written));
  expect_written(typed(got, "constantBias = "), 0.06);
  expect_written(0.5 * typed(got, "normalBias = ") * engine_texel_m, 1.5 * engine_texel_m);
  EXPECT_EQ(typed(got, "polygonOffsetSlope = "), 2);
  EXPECT_EQ(typed(got, "polygonOffsetConstant = "), 3);
}

// URP: texels of the least sphere around the frustum, times 1, 1.5, 2.5 or 3.5 by the soft shadows; a spot light's unit is
// tan(half) * range / size.
TEST(Engines, UrpGivesTheBiasBack) {
  Settings s = constant_m(0);
  s.filter = FilterSettings("tent", {{"size", 5}});
  s.bias["caster_offset"] = 2;
  s.bias["caster_normal_offset_turned"] = 1.5;
  EngineAdvice got = advice(s, "Unity URP");
  const Frustum seen = frustum(s);
  const double far_m = typed(got, "Max Distance: "), size = typed(got, "Shadow Resolution: ");
  expect_written(far_m, seen.farthest_m);
  const double half = seen.half_diagonal * far_m;  // of the far plane; the sphere goes through the eye and its corners
  ASSERT_LT(half, far_m);
  const double engine_texel_m = (far_m * far_m + half * half) / far_m / size;
  EXPECT_LE(engine_texel_m, texel_m * (1 + written));
  expect_written(typed(got, "Depth: ") * 2.5, 2);  // texels of the engine's own map
  expect_written(typed(got, "Normal: ") * 2.5, 1.5);
  s.filter = FilterSettings("tent", {{"size", 7}});
  expect_written(typed(advice(s, "Unity URP"), "Normal: ") * 3.5, 1.5);
  s = constant_m(0.06, LightChoice::spot);
  s.filter = FilterSettings("hardware", {});
  got = advice(s, "Unity URP");
  expect_written(typed(got, "Depth: ") * std::tan(std::numbers::pi / 6) * 42 / 512, 0.06);
}

// The inspector takes no more than 10: the lines hold that, say so, and what is measured has it.
TEST(Engines, UrpsBiasHasAGreatestValue) {
  Settings s = constant_m(0);
  s.filter = FilterSettings("hardware", {});
  s.bias["caster_offset"] = 4;
  EXPECT_EQ(joined(advice(s, "Unity URP").cannot).find("is at most"), std::string::npos);
  s.bias["caster_offset"] = 30;
  const EngineAdvice got = advice(s, "Unity URP");
  EXPECT_EQ(typed(got, "Depth: "), 10);
  EXPECT_NE(joined(got.cannot).find("Shadows > Depth Bias is at most 10, and 30 is needed"), std::string::npos)
      << joined(got.cannot);
  ASSERT_TRUE(got.emulated) << got.why_not_emulated;
  expect_written(got.emulated->bias["caster_offset"], 10);
}

// OpenGL: the formulas of the parts, with amounts in window depth or metres.
TEST(Engines, OpenGlGivesTheBiasBack) {
  Settings s = constant_m(0.06);
  s.bias["tan"] = 0.02;
  s.bias["tan_cap"] = 0.5;
  s.bias["normal_offset_axes"] = 1.5;
  s.bias["polygon_factor"] = 2;
  s.bias["polygon_units"] = 3;
  const EngineAdvice got = advice(s, "OpenGL");
  expect_written(typed(got, "depth -= ") * 40, 0.06);
  expect_written(typed(got, "depth -= min(") * 40, 0.02);
  expect_written(typed(got, "/ dot(N, L), ") * 40, 0.5);
  expect_written(typed(got, "position += "), 1.5 * texel_m);
  EXPECT_EQ(typed(got, "glPolygonOffset("), 2);
}

// The form of each part against the part's own formula. A plane's point that moves by v along a direction is v.N / N.L
// deeper or less deep than the plane at its new place.
TEST(Engines, FormsGainWhatTheirPartsGain) {
  for (double theta : {0.1, 0.8, 1.3})
    for (const BiasPart& part : bias_parts()) {
      if (!part.formula.factor && !part.formula.way) continue;  // OpenGL's own
      double gained = 0;
      if (part.formula.factor) {
        in_float::Surface at{};
        at.n_dot_l = static_cast<float>(std::cos(theta));
        at.tan_theta = static_cast<float>(std::tan(theta));
        gained = static_cast<double>(part.formula.factor(at));
      } else {
        in_double::Surface at{};
        at.normal = {std::sin(theta), 0, std::cos(theta)};
        at.to_light = {0, 0, 1};
        at.texel_right = {1, 0, 0};
        at.texel_up = {0, 1, 0};
        at.n_dot_l = std::cos(theta);
        const double away = glm::dot(part.formula.way(at), at.normal) / at.n_dot_l;
        gained = part.acts_on == BiasTarget::caster ? -away : away;
      }
      // Factors are computed in float. 1 - cos(0.1) loses the most: half a step of 1 (2^-25) of 0.005.
      EXPECT_NEAR(gain(form_of(part), theta), gained, 1e-5 * gained) << part.name << " at " << theta;
    }
}

// Plain OpenGL blends texels only for filters that are made of such fetches.
TEST(Engines, OpenGlSamplesAsTheFilterReads) {
  Settings s = simple();
  s.filter = FilterSettings("gaussian", {{"size", 3}});
  EXPECT_NE(joined(advice(s, "OpenGL").lines).find("GL_LINEAR"), std::string::npos);
  for (const char* nearest : {"none", "poisson", "box"}) {
    s.filter = FilterSettings(nearest, {});
    EXPECT_EQ(joined(advice(s, "OpenGL").lines).find("GL_LINEAR"), std::string::npos) << nearest;
  }
}

// Whether the text names it, not as the beginning of a longer name.
bool names(const std::string& text, const std::string& name) {
  for (size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const char after = at + name.size() < text.size() ? text[at + name.size()] : ' ';
    if (!std::isalnum(static_cast<unsigned char>(after)) && after != '_') return true;
  }
  return false;
}

void expect_said_by_each(const Settings& settings, const std::string& what) {
  const Case c = make(settings);
  for (const EngineAdvice& one : engine_advice(c.settings, c.frame, c.scene))
    EXPECT_TRUE(names(joined(one.cannot), what)) << one.engine << " does not say " << what;
}

TEST(Engines, EachSaysWhatItCannotExpress) {
  Settings s = simple();
  s.bias["tan"] = 0.001;
  expect_said_by_each(s, "bias.tan");
  s = simple();
  s.bias.reference = "texel_plane";
  expect_said_by_each(s, "bias.reference = texel_plane");
  s = simple();
  s.filter = FilterSettings("poisson", {});
  expect_said_by_each(s, "filter.kind = poisson");
  expect_said_by_each(simple(LightChoice::point), "point light");
  s = simple();
  s.map.depth_clamp = true;
  expect_said_by_each(s, "map.depth_clamp");
}

void make_legal(Settings& s) {
  const LightKind kind = effective_light(make_scene(s.scene), s).kind;
  try {
    validate(s, kind);
  } catch (const SettingConflict&) {
    s.bias.reference = "own_depth";
  }
  try {
    validate(s, kind);
  } catch (const SettingConflict&) {
    s.filter.kind = "none";
  }
  validate(s, kind);
}

RC_GTEST_PROP(Engines, NothingIsDropped, ()) {
  Settings s = simple(*rc::gen::element(LightChoice::directional, LightChoice::spot, LightChoice::point));
  s.bias.unit = *rc::gen::element(BiasUnit::depth, BiasUnit::m, BiasUnit::texel);
  s.bias.offset_unit = *rc::gen::element(OffsetUnit::texel, OffsetUnit::m);
  s.map.resolution = *rc::gen::element(1, 2, 256, 1024);
  s.bias.reference = *rc::gen::element<std::string>("own_depth", "receiver_plane", "texel_plane");
  const size_t filter = *rc::gen::inRange<size_t>(0, filters().size());
  s.filter.kind = filters()[filter].name;
  std::vector<std::string> expected;
  for (const BiasParameter& parameter : bias_parameters()) {
    if (*rc::gen::inRange(0, 3) != 0) continue;
    const bool cap = parameter.role == BiasParameter::Role::cap;  // above each floor
    if (cap && s.bias[parameter.part->name] == 0) continue;       // limits nothing
    s.bias[parameter.name] = (*rc::gen::inRange(1, 1000) + (cap ? 1000 : 0)) / 1000.0;
    expected.push_back(parameter.setting);
  }
  make_legal(s);
  if (s.bias.reference != "own_depth") expected.push_back("bias.reference = " + s.bias.reference);
  expected.push_back("filter.kind = " + s.filter.kind);
  const Case c = make(s);
  for (const EngineAdvice& one : engine_advice(c.settings, c.frame, c.scene)) {
    const std::string text = joined(one.lines) + joined(one.cannot);
    for (const std::string& name : expected)
      if (!names(text, name)) RC_FAIL(one.engine + " drops " + name + "\n" + text);
    RC_ASSERT(text.find("nan") == std::string::npos);
    for (const char* infinite : {"= inf", "= -inf", "{}", ": inf"}) RC_ASSERT(text.find(infinite) == std::string::npos);
    const bool refused = !one.cannot.empty() && one.cannot.front().starts_with("There are no lines");
    RC_ASSERT(one.lines.empty() == refused);
    RC_ASSERT(!one.version.empty() && !one.source.empty() && !one.comment.empty());
    RC_ASSERT(one.emulated.has_value() == one.why_not_emulated.empty());
    if (one.emulated) make_light_frame(c.scene, as_engine(one, c.settings));  // they are settings
  }
}

// docs/reference/engines.md holds one row of its table for each field, and no other; docs/reference/engine-sources.md one for each
// line of an engine's source that a row states.
TEST(Engines, TheDocumentListsEachField) {
  const auto document = [](const char* name) {
    return read_file(noonmark::test::source_dir() + "/" + name, uint64_t{1} << 20);
  };
  std::string table = "| engine, version | light | field | unit | acts on |\n|---|---|---|---|---|\n";
  for (const EngineField& row : engine_fields())
    table += "| " + row.engine + " " + row.version + " | " + row.light + " | `" + row.field + "` | " + row.unit +
             " | " + row.place + " |\n";
  EXPECT_NE(document("docs/reference/engines.md").find(table + "\n"), std::string::npos)
      << "docs/reference/engines.md must hold this table:\n"
      << table;
  std::string read = "| engine | repository | commit or release | line | text |\n|---|---|---|---|---|\n";
  for (const auto& [engine, sources] : engine_sources()) {
    EXPECT_FALSE(sources.empty()) << engine;
    for (const EngineSource& one : sources)
      read += "| " + engine + " | " + one.repository + " | " + one.commit + " | " + one.path +
              (one.line > 0 ? ":" + std::to_string(one.line) : "") + " | `" + one.text + "` |\n";
  }
  EXPECT_NE(document("docs/reference/engine-sources.md").find(read + "\n"), std::string::npos)
      << "docs/reference/engine-sources.md must hold this table:\n"
      << read;
}

}  // namespace
}  // namespace noonmark
