// What is typed into engines for cascades: ends, maps and biases come back from the printed numbers by the engines' own formulas.
#include <algorithm>
#include <functional>
#include <regex>

#include "app/advise/engines/engine.h"
#include "technique/cascades.h"
#include "technique/corner_fits.h"
#include "tests/app/engine_case.h"

namespace noonmark {
namespace {

using test::expect_written;
using test::joined;
using test::typed;

constexpr int resolution = 1024;
constexpr double texels = 2;  // of the bias

Settings street(int count = 4) {
  Settings s;
  s.scene.name = "street";
  s.view.near_m = 0.2;
  s.map.reach_m = 80;
  s.map.fit = MapFit::sphere;
  s.map.resolution = resolution;
  s.cascades.count = count;
  s.bias.unit = BiasUnit::texel;
  s.bias["constant"] = texels;
  return s;
}

Settings manual(std::vector<double> bounds) {
  Settings s = street(static_cast<int>(bounds.size()) + 1);
  s.cascades.splits = "manual";
  s.cascades.bounds_m = std::move(bounds);
  return s;
}

EngineAdvice advice(const Settings& settings, const std::string& engine) {
  const Scene scene = make_scene(settings.scene);
  return advice_for_engine(engine_word(engine), settings, make_light_frame(scene, settings), scene);
}

std::vector<double> list_after(const EngineAdvice& advice, const std::string& before) {
  const std::string all = joined(advice.lines);
  const size_t at = all.find(before);
  EXPECT_NE(at, all.npos) << before << " is not in\n" << all;
  if (at == all.npos) return {};
  std::vector<double> values;
  const std::string rest = all.substr(at + before.size(), all.find('\n', at) - at - before.size());
  const std::regex number(R"(^[ ,]*(-?[0-9.]+(e-?[0-9]+)?))");
  std::smatch found;
  for (std::string left = rest; std::regex_search(left, found, number); left = found.suffix())
    values.push_back(std::stod(found[1]));
  return values;
}

// Of the street's camera: half of the picture's diagonal at one metre.
double tangent() { return std::tan(std::numbers::pi / 6) * std::hypot(1, 1280.0 / 720); }

double longest_diagonal(const ViewSlice& s) {
  return std::max(2 * tangent() * s.end_m, std::hypot(s.end_m - s.begin_m, tangent() * (s.begin_m + s.end_m)));
}
double corner_radius(const ViewSlice& s) { return std::hypot((s.end_m - s.begin_m) / 2, tangent() * s.end_m); }

struct Slices {
  explicit Slices(const Settings& settings) : scene(make_scene(settings.scene)) {
    for (const Technique& one : techniques_of(scene, settings)) texel_m.push_back(one.frame.extent_m / resolution);
    slices = view_slices(scene, settings);
  }
  // The bias that is needed where the engine's texels are this wide: never less than the recommended one.
  double needed_m(size_t k, double engine_texel_m) const { return texels * std::max(texel_m[k], engine_texel_m); }
  Scene scene;
  std::vector<double> texel_m;
  std::vector<ViewSlice> slices;
};

TEST(EngineCascades, ThreeHasEndsAndBiasesOfItsOwn) {
  const Settings settings = manual({4, 13, 31});
  const Slices known(settings);
  const EngineAdvice found = advice(settings, "three.js");
  const double far = typed(found, "maxFar: "), near = typed(found, "camera.near = ");
  expect_written(far - near, 80);  // by which the shader divides the depth
  const std::vector<double> breaks = list_after(found, "breaks.push(");
  ASSERT_EQ(breaks.size(), 4u);
  for (size_t k = 0; k < 4; ++k) expect_written(breaks[k] * (far - near), known.slices[k].end_m);
  // The bias of each light, in depth from lightNear to lightFar.
  const double depth = typed(found, "lightFar: ") - typed(found, "lightNear: ");
  const std::vector<double> biases = list_after(found, "light.shadow.bias = [");
  ASSERT_EQ(biases.size(), 4u);
  for (size_t k = 0; k < 4; ++k) {
    // The maps' own slices end at breaks times far.
    const ViewSlice slice{k == 0 ? near : breaks[k - 1] * far, breaks[k] * far};
    expect_written(-biases[k] * depth, known.needed_m(k, longest_diagonal(slice) / resolution));
  }
  EXPECT_NE(joined(found.lines).find("csm.lights.forEach((light, i) => { light.shadow.bias = ["), std::string::npos)
      << joined(found.lines);
}

TEST(EngineCascades, BabylonTakesTheNearestLambda) {
  Settings settings = street();
  settings.cascades.lambda = 0.7;
  EngineAdvice found = advice(settings, "Babylon.js");
  expect_written(typed(found, ".lambda = "), 0.7);
  EXPECT_EQ(typed(found, ".numCascades = "), 4);
  EXPECT_EQ(typed(found, ".shadowMaxZ = "), 80);
  EXPECT_EQ(joined(found.cannot).find("the engine knows no ends"), std::string::npos) << joined(found.cannot);
  settings.cascades.splits = "logarithmic";
  expect_written(typed(advice(settings, "Babylon.js"), ".lambda = "), 1);
  // Ends that no lambda has: no other lambda is nearer.
  settings = manual({4, 13, 31});
  found = advice(settings, "Babylon.js");
  EXPECT_NE(joined(found.cannot).find("the nearest to the recommended 4, 13, 31 m"), std::string::npos)
      << joined(found.cannot);
  const auto missed = [&](double lambda) {
    double sum = 0;
    for (int i = 1; i < 4; ++i) {
      const double end = lambda * 0.2 * std::pow(400, i / 4.0) + (1 - lambda) * (0.2 + 79.8 * i / 4);
      sum += std::pow(end - settings.cascades.bounds_m[static_cast<size_t>(i) - 1], 2);
    }
    return sum;
  };
  const double lambda = typed(found, ".lambda = ");
  for (int i = 0; i <= 1000; ++i) EXPECT_GE(missed(i / 1000.0) * (1 + 1e-9), missed(lambda) * (1 - 1e-4)) << i;
}

// One share of each cascade's own depth range: no cascade has less than it needs, and one has no more.
TEST(EngineCascades, BabylonsBiasIsEnoughInEach) {
  const Settings settings = street();
  const Slices known(settings);
  const EngineAdvice found = advice(settings, "Babylon.js");
  Settings laid = settings;
  laid.map.fit = MapFit::corner_sphere;
  laid.map.depth_clamp = true;
  laid.cascades.radius_round_m = 0.0625;
  double least = 1e9;
  for (size_t k = 0; k < 4; ++k) {
    const LightFrame frame = techniques_of(known.scene, laid)[k].frame;
    const double radius = std::ceil(corner_radius(known.slices[k]) * 16) / 16;
    expect_written(frame.extent_m, 2 * radius);
    const double given = typed(found, "shadowGenerator.bias = ") * (frame.far_m - frame.near_m);
    least = std::min(least, given / known.needed_m(k, 2 * radius / resolution));
  }
  expect_written(least, 1);
  EXPECT_NE(
      joined(found.cannot).find("shadowGenerator.bias is one number for all cascades. It is what cascade 4 needs"),
      std::string::npos)
      << joined(found.cannot);
}

// With PCF and depthClamp the stored depth has one and a half times the bias (measured: engine_cascades_test.py).
TEST(EngineCascades, BabylonAddsTheBiasTwiceWithPcf) {
  Settings settings = street();
  settings.filter = FilterSettings("castano", {{"size", 5}});
  const EngineAdvice found = advice(settings, "Babylon.js");
  const double without = typed(advice(street(), "Babylon.js"), "shadowGenerator.bias = ");
  expect_written(1.5 * typed(found, "shadowGenerator.bias = "), without);
  EXPECT_NE(joined(found.cannot).find("adds the bias twice"), std::string::npos) << joined(found.cannot);
}

// A blend band stands where an engine has one of that shape, and is said to be missing where it has not.
TEST(EngineCascades, BlendWhereTheEngineDoes) {
  Settings settings = street();
  settings.cascades.blend = 0.1;
  settings.cascades.blend_of = CascadeBlendOf::slice;
  const auto is_missing = [&](const char* engine) {
    return joined(advice(settings, engine).cannot).find("the engine has no such blending") != std::string::npos;
  };
  EXPECT_EQ(typed(advice(settings, "Babylon.js"), "cascadeBlendPercentage = "), 0.1);
  EXPECT_EQ(typed(advice(settings, "Bevy"), "overlap_proportion: "), 0);
  for (const char* engine : {"three.js", "Godot", "Bevy", "Unity URP"}) EXPECT_TRUE(is_missing(engine)) << engine;
  EXPECT_FALSE(is_missing("Babylon.js"));
  settings.cascades.blend_of = CascadeBlendOf::end;
  EXPECT_EQ(typed(advice(settings, "Babylon.js"), "cascadeBlendPercentage = "), 0);
  EXPECT_EQ(typed(advice(settings, "Bevy"), "overlap_proportion: "), 0.1);
  EXPECT_TRUE(is_missing("Babylon.js"));
  EXPECT_FALSE(is_missing("Bevy"));
  settings.cascades.blend_shape = "smooth";
  EXPECT_EQ(typed(advice(settings, "Bevy"), "overlap_proportion: "), 0);
  EXPECT_NE(joined(advice(settings, "Bevy").cannot).find("cascades.blend_shape = smooth: the engine has no such"),
            std::string::npos);
  settings.cascades.blend_shape = "linear";
  // CSM's fade has one width.
  const auto fades = [&] {
    return joined(advice(settings, "three.js").lines).find("csm.fade = true") != std::string::npos;
  };
  settings.cascades.blend_of = CascadeBlendOf::square;
  EXPECT_FALSE(fades());
  settings.cascades.blend = 0.25;
  EXPECT_TRUE(fades());
  EXPECT_EQ(advice(settings, "three.js").emulated->cascades.blend, 0.25);
  settings.cascades.depths = CascadeDepths::visible;
  settings.map.fit_fov_deg = 80;
  const EngineAdvice three = advice(settings, "three.js");
  for (const char* part : {"cascades.depths = visible: the lines lay cascades between the camera's planes",
                           "map.fit_fov_deg = 80 is not set by the lines above"})
    EXPECT_NE(joined(three.cannot).find(part), std::string::npos) << joined(three.cannot);
  EXPECT_EQ(three.emulated->cascades.depths, CascadeDepths::planes);
  EXPECT_FALSE(three.emulated->map.fit_fov_deg);
  settings.cascades.depths = CascadeDepths::planes;
  settings.map.fit_fov_deg.reset();
  settings.cascades.select = "map";
  EXPECT_NE(joined(advice(settings, "Bevy").cannot)
                .find("cascades.select = map: the engine chooses a receiver's cascade by its depth"),
            std::string::npos);
  EXPECT_NE(joined(advice(settings, "Unity URP").cannot).find("by its sphere"), std::string::npos);
  settings.cascades.resolutions = {512, 512, 256, 256};
  const std::string cannot = joined(advice(settings, "Godot").cannot);
  EXPECT_NE(cannot.find("cascades.resolutions: all maps of the engine have one resolution"), std::string::npos)
      << cannot;
}

TEST(EngineCascades, TheBiasHasTheFactorOfItsCascade) {
  Settings settings = manual({4, 13, 31});
  const std::vector<double> without = list_after(advice(settings, "three.js"), "light.shadow.bias = [");
  settings.cascades.bias_scales = {1, 2, 3, 0.5};
  const std::vector<double> with = list_after(advice(settings, "three.js"), "light.shadow.bias = [");
  ASSERT_EQ(with.size(), 4u);
  for (size_t k = 0; k < 4; ++k) expect_written(with[k], settings.cascades.bias_scales[k] * without[k]);
}

TEST(EngineCascades, GodotsSplitsAreSharesOfTheWay) {
  const Settings settings = manual({4, 13, 31});
  const Slices known(settings);
  const EngineAdvice found = advice(settings, "Godot");
  EXPECT_NE(joined(found.lines).find("SHADOW_PARALLEL_4_SPLITS"), std::string::npos);
  EXPECT_EQ(typed(found, "directional_shadow_atlas_set_size("), 2 * resolution);
  const double near = typed(found, "camera.near = "), reach = typed(found, "directional_shadow_max_distance = ");
  double least = 1e9;
  for (size_t k = 0; k < 4; ++k) {
    if (k < 3)
      expect_written(near + (reach - near) * typed(found, "directional_shadow_split_" + std::to_string(k + 1) + " = "),
                     known.slices[k].end_m);
    const double width = 2 * corner_radius(known.slices[k]) * resolution / (resolution - 2);
    // A hundredth of the map's width and the pancake size, for each 1.
    const double given = 0.01 * typed(found, "shadow_bias = ") * (width + typed(found, "pancake_size = "));
    // Hard reads one linear fetch, which reaches twice as far as the recommended one tap (law 1).
    least = std::min(least, given / (2 * known.needed_m(k, width / resolution)));
  }
  expect_written(least, 1);
}

TEST(EngineCascades, BevyTakesAnyBounds) {
  const Settings settings = manual({4, 13, 31});
  const Slices known(settings);
  EngineAdvice found = advice(settings, "Bevy");
  EXPECT_EQ(list_after(found, "bounds: vec!["), (std::vector<double>{4, 13, 31, 80}));
  EXPECT_EQ(typed(found, "minimum_distance: "), 0.2);
  // Rust takes no integer for a float.
  EXPECT_NE(joined(found.lines).find("bounds: vec![4.0, 13.0, 31.0, 80.0], overlap_proportion: 0.0"),
            std::string::npos);
  EXPECT_NE(joined(found.lines).find("shadow_normal_bias: 0.0,"), std::string::npos) << joined(found.lines);
  double most = 0;  // one bias in metres, of the widest texels
  for (size_t k = 0; k < 4; ++k)
    most = std::max(most, 2 * known.needed_m(k, std::ceil(longest_diagonal(known.slices[k])) / resolution));
  expect_written(typed(found, "shadow_depth_bias: "), most);
  // A bias along the normal is in texels of each cascade, so one number is right in all.
  Settings along = settings;
  along.bias = {};
  along.bias["normal_offset"] = 1;
  found = advice(along, "Bevy");
  EXPECT_EQ(joined(found.cannot).find("one number for all cascades"), std::string::npos) << joined(found.cannot);
  // The builder's own bounds.
  Settings first = street();
  first.cascades.splits = "first_bound";
  first.cascades.first_m = 5;
  found = advice(first, "Bevy");
  EXPECT_EQ(typed(found, "num_cascades: "), 4);
  EXPECT_EQ(typed(found, "first_cascade_far_bound: "), 5);
  EXPECT_EQ(typed(found, "maximum_distance: "), 80);
}

TEST(EngineCascades, UrpsSplitsAreSharesOfTheDistance) {
  const Settings settings = manual({4, 13, 32});
  const EngineAdvice found = advice(settings, "Unity URP");
  EXPECT_EQ(typed(found, "Cascade Count: "), 4);
  EXPECT_EQ(typed(found, "Shadow Resolution: "), 2 * resolution);
  const std::string lines = joined(found.lines);
  EXPECT_NE(lines.find("Split 1 to 3: 4, 13, 32 m  // m_Cascade4Split: {x: 0.05, y: 0.1625, z: 0.4}"),
            std::string::npos)
      << lines;
  // URP's bias is in texels of each cascade, so one number is right in all of them. Its Hard Shadows read texels that lie up to
  // twice as far away as those of a single tap, so the number is twice as large.
  expect_written(typed(found, "Depth: "), 2 * texels);
  EXPECT_NE(joined(advice(manual({20}), "Unity URP").lines).find("Split 1: 20 m  // m_Cascade2Split: 0.25"),
            std::string::npos);
}

// The bias along the light of each cascade on a plane square to it, in metres, as Noonmark measures the engine's lines.
std::vector<double> emulated_m(const EngineAdvice& found, const Scene& scene) {
  EXPECT_TRUE(found.emulated) << found.engine << ": " << found.why_not_emulated;
  if (!found.emulated) return {};
  std::vector<double> metres;
  for (const Technique& one : techniques_of(scene, *found.emulated)) {
    const BiasSettings& bias = one.settings.bias;
    const double unit = bias.unit == BiasUnit::depth ? one.frame.far_m - one.frame.near_m : 1;
    EXPECT_NE(bias.unit, BiasUnit::texel);
    metres.push_back(one.frame.bias_scale * unit * bias["constant"] +
                     one.frame.extent_m / resolution * bias["caster_offset"]);
  }
  return metres;
}

// What is measured of an engine is what its formulas make of the printed numbers, in each cascade.
TEST(EngineCascades, TheEmulationHasTheTypedBias) {
  const Settings settings = manual({4, 13, 31});
  const Slices known(settings);
  const auto of = [&](const char* engine) { return advice(settings, engine); };
  const auto expect_each = [&](const EngineAdvice& found, const std::function<double(size_t)>& metres,
                               const std::function<double(const ViewSlice&)>& width) {
    const std::vector<double> has = emulated_m(found, known.scene);
    ASSERT_EQ(has.size(), 4u);
    const std::vector<Technique> cascades = techniques_of(known.scene, *found.emulated);
    for (size_t k = 0; k < 4; ++k) {
      SCOPED_TRACE(found.engine + ", cascade " + std::to_string(k + 1));
      expect_written(has[k], metres(k));
      if (width) {
        EXPECT_NEAR(cascades[k].frame.extent_m / width(known.slices[k]), 1, 1e-9);
      }
    }
  };
  const EngineAdvice three = of("three.js");
  const std::vector<double> each = list_after(three, "light.shadow.bias = [");
  const double depth = typed(three, "lightFar: ") - typed(three, "lightNear: ");
  expect_each(
      three, [&](size_t k) { return -each[k] * depth; }, nullptr);
  const EngineAdvice babylon = of("Babylon.js");
  const std::vector<Technique> spheres = techniques_of(known.scene, *babylon.emulated);
  expect_each(
      babylon,
      [&](size_t k) {
        return typed(babylon, "shadowGenerator.bias = ") * (spheres[k].frame.far_m - spheres[k].frame.near_m);
      },
      nullptr);
  EXPECT_EQ(babylon.emulated->bias.unit, BiasUnit::depth) << "its depth range changes with the view";
  const EngineAdvice godot = of("Godot");
  const auto godots = [&](const ViewSlice& slice) { return 2 * corner_radius(slice) * resolution / (resolution - 2); };
  expect_each(
      godot,
      [&](size_t k) {
        return 0.01 * typed(godot, "shadow_bias = ") * (godots(known.slices[k]) + typed(godot, "pancake_size = "));
      },
      godots);
  const EngineAdvice bevy = of("Bevy");
  expect_each(
      bevy, [&](size_t) { return typed(bevy, "shadow_depth_bias: "); },
      [](const ViewSlice& slice) { return std::ceil(longest_diagonal(slice)); });
  const EngineAdvice urp = of("Unity URP");
  expect_each(
      urp, [&](size_t k) { return typed(urp, "Depth: ") * known.texel_m[k]; }, nullptr);
  EXPECT_EQ(urp.emulated->cascades.select, "sphere");
  EXPECT_EQ(urp.emulated->bias["polygon_factor"], 2.5);
  EXPECT_EQ(urp.emulated->map.format, DepthFormat::d16);
}

TEST(EngineCascades, WhatNoonmarkHasNoSettingsForIsNotEmulated) {
  Settings along = manual({4, 13, 31});
  along.bias = {};
  along.bias["normal_offset_sin"] = 1;
  const EngineAdvice babylon = advice(along, "Babylon.js");  // one normalBias in metres, and texels of each cascade
  EXPECT_FALSE(babylon.emulated);
  EXPECT_NE(babylon.why_not_emulated.find("bias.caster_normal_offset_sin of Noonmark has one number"),
            std::string::npos)
      << babylon.why_not_emulated;
  const EngineAdvice three = advice(along, "three.js");  // a normalBias of each light
  ASSERT_TRUE(three.emulated) << three.why_not_emulated;
  EXPECT_GT(three.emulated->bias["normal_offset"], 0);
  const EngineAdvice godot = advice(manual({20}), "Godot");
  EXPECT_FALSE(godot.emulated);
  EXPECT_NE(godot.why_not_emulated.find("oblong"), std::string::npos) << godot.why_not_emulated;
}

// One set of lines serves all views: the camera's near plane cuts nothing open that is near to another view's camera, and CSM's
// maps hold each slice and its casters however the camera turns.
TEST(EngineCascades, LinesServeEveryView) {
  const Settings settings = street();
  const Scene scene = make_scene(settings.scene);
  const LightFrame frame = make_light_frame(scene, settings);
  const EngineAdvice near_by = engine_advice(settings, frame, scene, {0.05, 80}).front();
  ASSERT_EQ(near_by.engine, "three.js");
  EXPECT_EQ(typed(near_by, "camera.near = "), 0.05);
  EXPECT_EQ(near_by.emulated->view.near_m, 0.05);
  EXPECT_EQ(as_engine(near_by, settings).view.near_m, 0.05);
  const double margin = typed(near_by, "lightMargin: ") - typed(near_by, "lightNear: ");
  const double deep = typed(near_by, "lightFar: ") - typed(near_by, "lightMargin: ");
  for (const double turn : {0.0, 40.0, 90.0, 200.0, 310.0}) {
    Settings there = as_engine(near_by, settings);
    const double angle = glm::radians(turn);
    there.view.eye_m = glm::dvec3(0, 1.6, 0), there.view.target_m = glm::dvec3(std::sin(angle), 1.6, -std::cos(angle));
    for (const Technique& one : techniques_of(scene, there)) {
      double first = 1e9, last = -1e9;  // of the slice, along the light
      const CameraFrame camera = make_camera_frame(effective_camera(scene, there.view), 1280, 720);
      for (const glm::dvec3& corner :
           corners_of_slice(camera, one.cascade->slices[static_cast<size_t>(one.cascade->index)], one.frame))
        first = std::min(first, corner.z), last = std::max(last, corner.z);
      EXPECT_LE(last - first, deep);
      EXPECT_GE(margin, first - one.frame.near_m);
    }
  }
}

TEST(EngineCascades, WhatAnEngineDoesNotLayHasNoLines) {
  const auto none = [](int count, const char* engine, const char* why) {
    const EngineAdvice found = advice(street(count), engine);
    EXPECT_TRUE(found.lines.empty()) << engine;
    ASSERT_EQ(found.cannot.size(), 1u) << engine;
    EXPECT_NE(found.cannot.front().find(why), std::string::npos) << found.cannot.front();
    EXPECT_FALSE(found.why_not_emulated.empty());
  };
  none(3, "Godot", "the engine lays 2, 4 cascades, and cascades.count = 3");
  none(5, "Bevy", "the engine lays 2, 3, 4 cascades");
  none(5, "Babylon.js", "the engine lays 2, 3, 4 cascades");
  none(4, "PlayCanvas", "There are no lines for cascades. light.numCascades");
  none(4, "Filament", "There are no lines for cascades. options.shadowCascades");
  none(4, "OpenGL", "There are no lines for cascades. The application lays them itself");
}

}  // namespace
}  // namespace noonmark
