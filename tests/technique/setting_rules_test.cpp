// The rules between settings: what is refused together, what is not read, and which stage reads what.
#include "technique/setting_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "technique/bias_parts.h"
#include "technique/settings.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

TEST(Validate, FindsWhatNoRowCanSee) {
  Settings s;
  s.filter["size"] = 4;
  EXPECT_NO_THROW(validate(s)) << "no filter reads it";
  s.filter.kind = "box";
  EXPECT_THROW(validate(s), Error);
  s.filter["size"] = 31;
  EXPECT_NO_THROW(validate(s));
  s.map.near_m = 5;
  EXPECT_NO_THROW(validate(s));
  s.map.far_m = 5;
  EXPECT_THROW(validate(s), Error);
  s.map.far_m = std::nextafter(5.0, 6.0);
  EXPECT_NO_THROW(validate(s));
  s.map.near_m = -1;
  s.map.far_m = -2;
  EXPECT_THROW(validate(s), Error);
}

Settings with(std::initializer_list<std::pair<const char*, const char*>> values) {
  Settings s;
  for (const auto& [name, value] : values) find_setting(name).set(s, value);
  return s;
}

// What each kind of light refuses. The message must name the setting.
TEST(ValidateFor, RefusesWhatTheLightsMapCannotDo) {
  const auto refused = [](LightKind kind, const Settings& s, const std::string& name) {
    try {
      validate(s, kind);
      return false;
    } catch (const SettingConflict& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_TRUE(error.setting().starts_with(name)) << error.setting();
      return true;
    }
  };
  constexpr LightKind kinds[] = {LightKind::directional, LightKind::spot, LightKind::point};
  for (const LightKind kind : kinds) {
    const bool cube = kind == LightKind::point;
    EXPECT_FALSE(refused(kind, {}, ""));
    for (const char* filter : {"box", "hardware", "gaussian", "poisson"})
      EXPECT_EQ(refused(kind, with({{"filter.kind", filter}}), "filter.kind"), cube) << filter;
    for (const char* filter : {"cube_grid", "cube_disk"})
      EXPECT_EQ(refused(kind, with({{"filter.kind", filter}}), "filter.kind"), !cube) << filter;
    for (const BiasPart& part : bias_parts()) {
      Settings settings;
      settings.bias[part.name] = 1;
      EXPECT_FALSE(refused(kind, settings, "")) << part.name;
    }
    for (const char* plane : {"receiver_plane", "texel_plane"}) {
      EXPECT_EQ(refused(kind, with({{"bias.reference", plane}}), "bias.reference"), cube) << plane;
      // These filters have one reference for four texels, so they cannot compare with a plane.
      for (const char* filter : {"hardware", "gaussian"})
        EXPECT_TRUE(refused(kind, with({{"bias.reference", plane}, {"filter.kind", filter}}), cube ? "" : "bias.ref"));
      EXPECT_EQ(refused(kind, with({{"bias.reference", plane}, {"filter.kind", "poisson"}}), ""), cube);
    }
    EXPECT_EQ(refused(kind, with({{"map.shift_u_texels", "0.5"}}), "map.shift_u_texels"), cube);
    EXPECT_EQ(refused(kind, with({{"map.shift_v_texels", "0.5"}}), "map.shift_v_texels"), cube);
    EXPECT_EQ(refused(kind, with({{"map.snap", "true"}}), "map.snap"), kind != LightKind::directional);
    EXPECT_EQ(refused(kind, with({{"map.pancake", "true"}}), "map.pancake"), kind != LightKind::directional);
    EXPECT_FALSE(refused(kind, with({{"map.placements", "4"}}), ""));
    EXPECT_FALSE(refused(kind, with({{"map.turn_deg", "0,-360,0"}}), ""));
    EXPECT_TRUE(refused(kind, with({{"map.turn_deg", "255,-255,0"}}), "map.turn_deg"));
  }
}

// What a step is in range adds up to over the frames.
TEST(Validate, AMotionStaysInTheWorld) {
  using Given = std::initializer_list<std::pair<const char*, const char*>>;
  const auto says = [](const Given& given) {
    try {
      validate(with(given));
    } catch (const SettingConflict& conflict) {
      return conflict.setting();
    }
    return std::string();
  };
  EXPECT_EQ(says({{"motion.frame", "99"}, {"motion.move_m", "1e7,0,0"}}), "");
  EXPECT_EQ(says({{"motion.frame", "100"}, {"motion.move_m", "1e7,0,0"}}), "motion.move_m");
  EXPECT_EQ(says({{"motion.frame", "100"}, {"motion.light_move_m", "0,0,-1e7"}}), "motion.light_move_m");
  EXPECT_EQ(says({{"motion.frame", "100"}, {"motion.light_move_m", "0,0,-1e7"}, {"motion.light_period", "7"}}), "");
  EXPECT_EQ(says({{"motion.frame", "100000"}, {"motion.zoom", "1.01"}}), "motion.zoom");
  EXPECT_EQ(says({{"motion.frame", "1000"}, {"motion.zoom", "0.5"}}), "motion.zoom");
}

// A level of a map of moments has whole texels, and says which sizes have.
TEST(Validate, OfALevelNeedsAMapOfWholeBlocks) {
  const auto said = [](std::initializer_list<std::pair<const char*, const char*>> more) -> std::string {
    Settings settings;
    settings.lookup.kind = "vsm", settings.lookup["level"] = 2;
    for (const auto& [name, value] : more) find_setting(name).set(settings, value);
    return refusal_of(ErrorKind::usage, [&] { validate(settings); });
  };
  EXPECT_EQ(said({{"map.resolution", "252"}}), "");
  EXPECT_NE(said({{"map.resolution", "250"}}).find("take 248 or 252 texels"), std::string::npos);
  EXPECT_EQ(said({{"map.resolution", "250"}, {"lookup.level", "0"}}), "");
  EXPECT_EQ(said({{"map.resolution", "250"}, {"lookup.kind", "compare"}}), "");
  EXPECT_NE(said({{"map.aspect", "auto"}}).find("map.aspect"), std::string::npos);
  const std::string height = said({{"map.resolution", "512"}, {"map.aspect", "1.37"}});
  EXPECT_NE(height.find("height of 374 texels"), std::string::npos) << height;
  const size_t at = height.find("map.aspect = ", height.find("take"));
  ASSERT_NE(at, std::string::npos) << height;
  EXPECT_EQ(said({{"map.resolution", "512"},
                  {"map.aspect", height.substr(at + 13, height.find(' ', at + 13) - at - 13).c_str()}}),
            "")
      << height;
  EXPECT_NE(said({{"cascades.count", "2"}, {"map.fit", "sphere"}, {"cascades.resolutions", "256,130"}})
                .find("take 128 or 132"),
            std::string::npos);
}

TEST(Validate, OfABiasNeedsItsFloorBelowItsCap) {
  EXPECT_THROW(validate(with({{"bias.tan_floor", "0.02"}, {"bias.tan_cap", "0.01"}})), Error);
  EXPECT_NO_THROW(validate(with({{"bias.tan_floor", "0.01"}, {"bias.tan_cap", "0.01"}})));
  EXPECT_NO_THROW(validate(with({{"bias.slope_floor", "0.02"}, {"bias.tan_cap", "0.01"}})));
}

TEST(Settings, ThoseThatChangeNothingAreNamed) {
  const auto idle = [](LightKind light, std::initializer_list<std::pair<const char*, const char*>> given) {
    Settings settings;
    for (const auto& [name, value] : given) find_setting(name).set(settings, value);
    std::string text;
    for (const IdleSetting& setting : idle_settings(light, settings)) text += setting.name + " " + setting.why + ";";
    return text;
  };
  for (LightKind light : {LightKind::directional, LightKind::spot, LightKind::point})
    EXPECT_EQ(idle(light, {}), "") << "a default was not set by the user";
  EXPECT_EQ(idle(LightKind::directional, {{"light.radius_m", "0.5"}}), "light.radius_m on a directional light;");
  EXPECT_EQ(idle(LightKind::spot, {{"light.radius_m", "0.5"}, {"light.cone_deg", "30"}}), "");
  EXPECT_EQ(idle(LightKind::spot, {{"light.angular_diameter_deg", "1"}, {"map.extent_m", "3"}}),
            "light.angular_diameter_deg on a spot light;map.extent_m on a spot light;");
  EXPECT_EQ(idle(LightKind::point, {{"light.cone_deg", "30"}, {"map.fov_deg", "30"}, {"map.extent_scale", "2"}}),
            "light.cone_deg on a point light;map.extent_scale on a point light;map.fov_deg on a point light;");
  EXPECT_EQ(idle(LightKind::directional, {{"map.cube_pass", "six_passes"}, {"light.shape", "disc"}}),
            "light.shape on a directional light;map.cube_pass on a directional light;");
  EXPECT_EQ(idle(LightKind::spot, {{"map.cube_pass", "six_passes"}}), "map.cube_pass on a spot light;");
  EXPECT_EQ(idle(LightKind::spot, {{"map.turn_deg", "0,10,0"}}), "map.turn_deg on a spot light;");
  EXPECT_EQ(idle(LightKind::point, {{"map.turn_deg", "0,10,0"}}), "");
  EXPECT_EQ(idle(LightKind::point, {{"map.wrap", "repeat"}}), "map.wrap on a point light;");
  EXPECT_EQ(idle(LightKind::point, {{"light.target_m", "1,2,3"}}), "light.target_m on a point light;");
  EXPECT_EQ(idle(LightKind::spot, {{"light.target_m", "1,2,3"}}), "");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.theta_deg", "20"}}), "scene.theta_deg in the scene cube-room;");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.name", "a.glb"}, {"scene.height_m", "2"}}),
            "scene.height_m in a scene from a file;");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.name", "plate"}, {"scene.height_m", "2"}, {"scene.thickness_m", "0.5"}}),
            "");
  EXPECT_EQ(idle(LightKind::directional, {{"filter.rotate", "true"}}), "filter.rotate with filter.kind = none;");
  EXPECT_EQ(idle(LightKind::directional, {{"filter.rotate", "true"}, {"filter.kind", "poisson"}}), "");
  EXPECT_EQ(idle(LightKind::directional, {{"bias.tan_cap", "2"}}), "bias.tan_cap with bias.tan = 0;");
  EXPECT_EQ(idle(LightKind::directional, {{"bias.tan_cap", "2"}, {"bias.tan_floor", "1"}}), "");
  EXPECT_EQ(idle(LightKind::directional, {{"bias.plane_cap", "2"}}), "bias.plane_cap with bias.reference = own_depth;");
  EXPECT_EQ(idle(LightKind::spot, {{"bias.plane_cap", "2"}, {"bias.reference", "receiver_plane"}}), "");
  EXPECT_EQ(idle(LightKind::spot, {{"bias.polygon_factor", "2"}}), "");
  EXPECT_EQ(idle(LightKind::point, {{"bias.polygon_factor", "2"}}),
            "bias.polygon_factor on a point light, whose shader writes its depth itself;");
  EXPECT_EQ(idle(LightKind::point,
                 {{"filter.kind", "cube_disk"}, {"filter.disk", "view_distance"}, {"filter.radius_m", "0.1"}}),
            "filter.radius_m with filter.disk = view_distance;");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.name", "a.glb"}, {"view.fit_depths", "true"}}), "");
  EXPECT_EQ(idle(LightKind::spot, {{"view.fit_depths", "true"}}),
            "view.fit_depths in a built-in scene, where near and far are always fitted;");
  EXPECT_EQ(idle(LightKind::spot,
                 {{"scene.name", "a.glb"}, {"view.fit_depths", "true"}, {"view.near_m", "1"}, {"view.far_m", "9"}}),
            "view.fit_depths with both view.near_m and view.far_m;");
  EXPECT_EQ(idle(LightKind::spot, {{"map.fit", "tight"}, {"map.near_m", "1"}}), "");
  EXPECT_EQ(idle(LightKind::spot, {{"map.fit", "tight"}, {"map.near_m", "1"}, {"map.far_m", "9"}}),
            "map.fit with both map.near_m and map.far_m;");
  EXPECT_EQ(idle(LightKind::directional, {{"map.fit", "tight"}, {"map.near_m", "1"}, {"map.far_m", "9"}}), "");
  EXPECT_EQ(idle(LightKind::directional,
                 {{"map.fit", "tight"}, {"map.near_m", "1"}, {"map.far_m", "9"}, {"map.extent_m", "4"}}),
            "map.fit with map.extent_m, map.near_m and map.far_m;");
  EXPECT_EQ(idle(LightKind::directional, {{"truth.standard_error", "0.1"}}),
            "truth.standard_error with a light without a size;");
  EXPECT_EQ(idle(LightKind::directional, {{"truth.standard_error", "0.1"}, {"light.angular_diameter_deg", "1"}}), "");
  EXPECT_EQ(idle(LightKind::point, {{"truth.standard_error", "0.1"}, {"light.radius_m", "0.2"}}), "");
  const char* const no_unit = "bias.unit without a part of the bias in that unit;";
  EXPECT_EQ(idle(LightKind::spot, {{"bias.unit", "m"}}), "") << "bias.constant is in it";
  EXPECT_EQ(idle(LightKind::spot, {{"bias.unit", "m"}, {"bias.constant", "0"}}), "") << "a curve varies bias.constant";
  EXPECT_EQ(idle(LightKind::spot, {{"bias.unit", "m"}, {"bias.constant", "0"}, {"bias.normal_offset", "1"}}), no_unit);
  EXPECT_EQ(idle(LightKind::spot,
                 {{"bias.unit", "m"}, {"bias.constant", "0"}, {"bias.normal_offset", "1"}, {"bias.slope_floor", "1"}}),
            "");
  EXPECT_EQ(idle(LightKind::spot, {{"bias.unit", "m"},
                                   {"bias.constant", "0"},
                                   {"bias.normal_offset", "1"},
                                   {"bias.reference", "receiver_plane"},
                                   {"bias.plane_cap", "1"}}),
            "");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.time_s", "2"}}), "scene.time_s in a built-in scene;");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.name", "a.glb"}, {"scene.animation", "1"}}),
            "scene.animation without scene.time_s;");
  EXPECT_EQ(idle(LightKind::spot, {{"scene.name", "a.glb"}, {"scene.animation", "1"}, {"scene.time_s", "2"}}), "");
}

// The result of a stage is used again while its key stays the same (measure/workbench.cpp).
TEST(Settings, TheKeyOfAStageChangesWithWhatItReadsAndNothingElse) {
  const auto key = [](const Settings& s, Stage stage) { return settings_key(s, {stage}); };
  const std::pair<const char*, Stages> expected[] = {{"scene.theta_deg", {Stage::scene}},
                                                     {"view.eye_m", {Stage::view}},
                                                     {"light.position_m", {Stage::truth, Stage::map, Stage::lookup}},
                                                     {"light.radius_m", {Stage::truth}},  // R0 alone
                                                     {"map.resolution", {Stage::map, Stage::lookup}},
                                                     {"map.format", {Stage::map}},
                                                     {"map.lit_beyond_far", {Stage::ladder}},
                                                     {"bias.constant", {Stage::ladder}},
                                                     {"bias.tan_cap", {Stage::ladder}},
                                                     {"bias.normal_offset", {Stage::lookup}},
                                                     {"bias.polygon_units", {Stage::map, Stage::lookup}},
                                                     {"filter.size", {Stage::lookup}},
                                                     {"truth.standard_error", {Stage::truth}},
                                                     {"truth.method", {Stage::scene}}};
  for (const auto& [name, stages] : expected) {
    Settings changed;
    const Setting& row = find_setting(name);
    const char* value = row.type == ValueType::point               ? "1,2,3"
                        : row.type == ValueType::flag              ? "false"
                        : name == std::string_view("truth.method") ? "rays"
                        : row.type == ValueType::choice            ? "16"
                        : row.type == ValueType::integer           ? "7"
                                                                   : "0.5";
    row.set(changed, value);
    for (Stage stage : {Stage::scene, Stage::view, Stage::truth, Stage::map, Stage::lookup, Stage::ladder})
      EXPECT_EQ(key(changed, stage) != key({}, stage), stages.has(stage)) << name << " " << static_cast<int>(stage);
  }
  for (const Setting& row : settings_table()) EXPECT_NE(row.read_by.bits, 0) << row.name << " is read by no stage";
  Settings biased;
  biased.bias["constant"] = 1;
  EXPECT_EQ(settings_key(biased, {Stage::ladder}, "bias.constant"), settings_key({}, {Stage::ladder}, "bias.constant"));
}

TEST(Cascades, RefuseWhatTheyCannotDo) {
  const auto why = [](const Settings& s, LightKind light = LightKind::directional) -> std::string {
    try {
      validate(s, light);
      return "";
    } catch (const SettingConflict& error) {
      return error.what();
    }
  };
  const Settings four = with({{"cascades.count", "4"}, {"map.fit", "sphere"}});
  EXPECT_EQ(why(four), "");
  EXPECT_EQ(why(with({{"cascades.count", "1"}, {"map.placements", "8"}})), "");
  const auto refused = [&](std::initializer_list<std::pair<const char*, const char*>> more, const char* part,
                           LightKind light = LightKind::directional) {
    Settings s = four;
    for (const auto& [name, value] : more) find_setting(name).set(s, value);
    EXPECT_NE(why(s, light).find(part), std::string::npos) << part << ": " << why(s, light);
  };
  refused({{"map.fit", "tight"}}, "map.fit = tight");
  refused({{"map.extent_m", "10"}}, "map.extent_m");
  refused({{"map.fit", "view"}}, "a spot light", LightKind::spot);
  refused({{"cascades.splits", "manual"}}, "3 for cascades.count = 4, and cascades.bounds_m has 0");
  refused({{"cascades.splits", "manual"}, {"cascades.bounds_m", "1,2"}}, "has 2");
  refused({{"cascades.splits", "manual"}, {"cascades.bounds_m", "1,2,3"}, {"cascades.depths", "visible"}},
          "cascades.depths = visible moves the ends");
  // Of a spot light no fit is named that it cannot have either.
  refused({}, "a spot light; set cascades.count = 1 and map.fit = tight", LightKind::spot);
  for (const char* fit : {"scene", "sphere"}) {
    const Settings spot = with({{"cascades.count", "4"}, {"map.fit", fit}, {"light.kind", "spot"}});
    try {
      validate(spot);  // before the scene is loaded
      ADD_FAILURE() << "it is not refused";
    } catch (const SettingConflict& error) {
      EXPECT_NE(std::string(error.what()).find("cascades need a directional light"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(require_one_map(four, "a chart"), SettingConflict);
  EXPECT_NO_THROW(require_one_map({}, "a chart"));
}

TEST(Cascades, ReadOnlyWhatTheirSplitsNeed) {
  const auto idle = [](std::initializer_list<std::pair<const char*, const char*>> values) {
    std::vector<std::string> names;
    for (const IdleSetting& one : idle_settings(LightKind::directional, with(values))) names.push_back(one.name);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(idle({{"cascades.lambda", "0.2"}}), Names{"cascades.lambda"});
  EXPECT_EQ(idle({{"cascades.count", "3"}, {"cascades.lambda", "0.2"}}), Names{});
  EXPECT_EQ(idle({{"cascades.count", "3"}, {"cascades.splits", "exponent"}, {"cascades.lambda", "0.2"}}),
            Names{"cascades.lambda"});
  EXPECT_EQ(idle({{"cascades.depths", "visible"}}), Names{"cascades.depths"});
  EXPECT_EQ(idle({{"cascades.count", "3"}, {"cascades.blend_shape", "smooth"}}), Names{"cascades.blend_shape"});
  EXPECT_EQ(idle({{"cascades.count", "3"}, {"cascades.blend_shape", "smooth"}, {"cascades.blend", "0.1"}}), Names{});
  EXPECT_EQ(idle({{"map.fit_fov_deg", "60"}}), Names{"map.fit_fov_deg"});
  EXPECT_EQ(idle({{"map.fit_fov_deg", "60"}, {"map.fit", "sphere"}}), Names{});
  EXPECT_EQ(idle({{"map.reach_m", "9"}}), Names{"map.reach_m"});
  EXPECT_EQ(idle({{"map.reach_m", "9"}, {"map.fit", "view"}}), Names{"map.reach_m"});
  EXPECT_EQ(idle({{"map.reach_m", "9"}, {"map.fit", "view"}, {"cascades.count", "2"}}), Names{});
}

}  // namespace
}  // namespace noonmark
