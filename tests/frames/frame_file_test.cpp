// frame.json: cameras that are given in different ways are the same camera, and what is wrong is named.
#include "frames/frame_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frames/frame_keys.h"
#include "technique/settings.h"
#include "tests/frames/good_frame.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::test {
namespace {

using Json = nlohmann::json;

Json least() { return {{"noonmark_frame", 1}, {"visibility", {{"file", "V.exr"}}}}; }

std::string fault_of(const Json& json) {
  return refusal_of(ErrorKind::file, [&] { parse_frame_file("frame.json", json.dump()); });
}

std::vector<double> numbers(const glm::dmat4& m, bool by_rows) {
  std::vector<double> all;
  for (int i = 0; i < 16; ++i) all.push_back(by_rows ? m[i % 4][i / 4] : m[i / 4][i % 4]);
  return all;
}

// OpenGL's clip space to that of the convention.
glm::dmat4 to_convention(bool zero_to_one, bool reversed, bool y_down) {
  glm::dmat4 m(1);
  if (y_down) m[1][1] = -1;
  if (zero_to_one) {
    m[2][2] = reversed ? -0.5 : 0.5;
    m[3][2] = 0.5;
  } else if (reversed) {
    m[2][2] = -1;
  }
  return m;
}

void expect_same_rays(const ViewMatrix& a, const ViewMatrix& b, const std::string& what) {
  for (const auto& [x, y] : {std::pair(0, 0), {159, 0}, {80, 45}, {3, 89}}) {
    const Ray p = a.pixel_ray(x, y, 160, 90), q = b.pixel_ray(x, y, 160, 90);
    EXPECT_LT(glm::length(p.origin - q.origin), 1e-9) << what;
    EXPECT_LT(glm::length(p.direction - q.direction), 1e-12) << what;
  }
}

TEST(FrameFile, ACameraAndALightOfTheSceneAreTakenByName) {
  Scene scene = make_scene({.name = "cube-room"});
  Camera side = scene.camera;
  side.eye_m = {7, 3, 1};
  Light lamp;
  lamp.kind = LightKind::point;
  lamp.position_m = {1, 2, 3};
  scene.cameras = {{"front", "", scene.camera, ""}, {"side", "", side, ""}};
  scene.lights = {{"sun", "", scene.light, ""}, {"ceiling", "lamp", lamp, ""}};
  Json json = least();
  json["camera"] = {{"name", "side"}};
  json["light"] = {{"name", "lamp"}, {"radius", 0.25}};
  const FrameFile file = parse_frame_file("frame.json", json.dump());
  scene.camera = side;
  expect_same_rays(file.view(scene, 160, 90), view_of(scene, 160, 90), "by name");
  EXPECT_EQ(file.light_in(scene).position_m, lamp.position_m);
  EXPECT_EQ(file.light_in(scene).radius_m, 0.25);
  json["light"]["name"] = "lump";
  const FrameFile wrong = parse_frame_file("frame.json", json.dump());
  expect_refused(ErrorKind::file, {"frame.json: 'light.name': ", "did you mean 'lamp'"},
                 [&] { wrong.light_in(scene); });
  json["light"]["kind"] = "point";
  EXPECT_NE(fault_of(json).find("give a name, or the light itself"), std::string::npos);
  json.erase("light");
  json["camera"]["eye"] = {1, 2, 3};
  EXPECT_NE(fault_of(json).find("give a name, or matrices"), std::string::npos);
}

TEST(FrameFile, ALightThatCannotBeIsNamed) {
  Json json = least();
  json["light"] = {{"kind", "directional"}, {"direction", {1e200, -1e200, 0}}};
  EXPECT_NE(fault_of(json).find("'light.direction' must be"), std::string::npos) << fault_of(json);
  json["light"] = {{"kind", "directional"}, {"direction", {0, -1, 0}}, {"angular_diameter_deg", 720}};
  EXPECT_NE(fault_of(json).find("0 ... 90 deg"), std::string::npos) << fault_of(json);
}

TEST(FrameFile, EveryConventionOfAMatrixIsTheSameCamera) {
  const Scene scene = make_scene({.name = "cube-room"});
  const ViewMatrix view = view_of(scene, 160, 90);
  for (const bool zero_to_one : {false, true})
    for (const bool reversed : {false, true})
      for (const bool y_down : {false, true})
        for (const bool by_rows : {false, true}) {
          Json json = least();
          json["camera"] = {{"clip_from_world",
                             numbers(to_convention(zero_to_one, reversed, y_down) * view.clip_from_world(), by_rows)},
                            {"order", by_rows ? "row" : "column"},
                            {"depth_range", zero_to_one ? "0..1" : "-1..1"},
                            {"reversed", reversed},
                            {"y", y_down ? "down" : "up"}};
          expect_same_rays(parse_frame_file("frame.json", json.dump()).view(scene, 160, 90), view, json.dump());
        }
}

// Z up, left-handed, in centimetres: x to the right, y away, z up as in a game engine.
TEST(FrameFile, AxesAndUnitsAreTheScenes) {
  const Scene scene = make_scene({.name = "cube-room"});
  glm::dmat4 frame_from_world(0);  // x' = x, y' = z, z' = y, times 100
  frame_from_world[0][0] = frame_from_world[2][1] = frame_from_world[1][2] = 100;
  frame_from_world[3][3] = 1;
  Json json = least();
  json["axes"] = {"x", "z", "y"};
  json["metres_per_unit"] = 0.01;
  const ViewMatrix view = view_of(scene, 160, 90);
  json["camera"] = {{"clip_from_world", numbers(view.clip_from_world() * glm::inverse(frame_from_world), false)},
                    {"order", "column"},
                    {"depth_range", "-1..1"},
                    {"reversed", false}};
  json["light"] = {{"kind", "directional"}, {"direction", {0, 0, -1}}};
  json["contact"] = {{"distance", 5}};
  const FrameFile file = parse_frame_file("frame.json", json.dump());
  expect_same_rays(file.view(scene, 160, 90), view, "");
  EXPECT_EQ(glm::normalize(file.light->target_m - file.light->position_m), glm::dvec3(0, -1, 0));
  EXPECT_DOUBLE_EQ(*file.contact_m, 0.05);
}

TEST(FrameFile, EyeAndTargetAreTheScenesCamera) {
  const Scene scene = make_scene({.name = "cube-room"});
  const Camera& c = scene.camera;
  Json json = least();
  json["camera"] = {{"eye", {c.eye_m.x, c.eye_m.y, c.eye_m.z}},
                    {"target", {c.target_m.x, c.target_m.y, c.target_m.z}},
                    {"fov_y_deg", c.fov_y_deg}};
  expect_same_rays(parse_frame_file("frame.json", json.dump()).view(scene, 160, 90),
                   parse_frame_file("frame.json", least().dump()).view(scene, 160, 90), "");
}

TEST(FrameFile, WhatIsWrongIsNamed) {
  const auto with = [](const char* pointer, const Json& value) {
    Json json = least();
    json[Json::json_pointer(pointer)] = value;
    return fault_of(json);
  };
  EXPECT_EQ(fault_of(least()), "");
  const std::vector<double> m(16, 1);
  for (const auto& [fault, words] : std::vector<std::pair<std::string, std::string>>{
           {with("/noonmark_frame", 2), "1, the version"},
           {with("/visbility", Json::object()), "did you mean 'visibility'"},
           {with("/visibility/encoding", "gamma"), "\"linear\", \"srgb\""},
           {with("/camera", {{"clip_from_world", m}}), "'camera.order' is missing"},
           {with("/camera", {{"clip_from_world", {1, 2}}}), "16 numbers"},
           {with("/camera", {{"eye", {0, 0, 1}}}), "'camera.target' is missing"},
           {with("/camera", {{"eye", {0, 0, 1}}, {"target", {0, 0, 0}}}), "fov_y_deg"},
           {with("/light", {{"kind", "directional"}}), "direction"},
           {with("/light", {{"kind", "spot"}, {"position", {0, 1, 0}}, {"direction", {0, -1, 0}}}),
            "'light.cone_deg' is missing"},
           {with("/axes", {"x", "x", "y"}), "each of x, y and z once"},
           {with("/edge", {{"texels", 2}}), "'edge.texel' is missing"},
           {with("/edge", Json::object()), "one of pixels, texels and distance"},
           {with("/metres_per_unit", 0), "'metres_per_unit' must be a number"},
           {with("/notes", {"pass 47", 85}), "'notes' must be a list of texts"},
           {with("/depth", Json::object()), "'depth.file' is missing"}})
    EXPECT_NE(fault.find(words), std::string::npos) << fault << "\nwanted: " << words;
  EXPECT_THROW(parse_frame_file("frame.json", "{"), Error);
  EXPECT_THROW(parse_frame_file("frame.json", "[]"), Error);
}

// Of two values the last would be taken in silence.
TEST(FrameFile, AKeyTwiceIsNamed) {
  const std::string text = least().dump();
  for (const auto& [twice, words] : {std::pair{"\"noonmark_frame\": 1, ", "'noonmark_frame' twice"},
                                     {"\"notes\": [], \"notes\": [], ", "'notes' twice"}})
    try {
      parse_frame_file("frame.json", "{" + std::string(twice) + text.substr(1));
      ADD_FAILURE() << twice;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  EXPECT_NO_THROW(parse_frame_file("frame.json", text)) << "one name in two objects is no fault";
}

// A length is checked in metres, whatever the renderer's unit is, and a setting's range is that of its key.
TEST(FrameFile, EveryNumberHasARange) {
  for (const FrameKey& key : frame_keys()) {
    if (key.kind != FrameKeyKind::number && key.kind != FrameKeyKind::vector3 && key.kind != FrameKeyKind::matrix)
      continue;
    const FrameRange range = range_of(key);
    EXPECT_TRUE(std::isfinite(range.numbers.least) && std::isfinite(range.numbers.most)) << key.full_name();
    EXPECT_LT(range.numbers.least, range.numbers.most) << key.full_name();
    EXPECT_THROW(require_in_range(key.full_name(), std::nan("")), Error) << key.full_name();
    EXPECT_NO_THROW(require_in_range(key.full_name(), range.numbers.most)) << key.full_name();
  }
  EXPECT_EQ(range_of("light.position").numbers.most, find_setting("light.position_m").max);
  const auto camera_at = [](double x, double unit) {
    Json json = least();
    json["metres_per_unit"] = unit;
    json["camera"] = {{"eye", {x, 5 / unit, 0}}, {"target", {0, 0, 0}}, {"fov_y_deg", 60}};
    return fault_of(json);
  };
  EXPECT_EQ(camera_at(1e9, 1), "");
  EXPECT_NE(camera_at(2e9, 1).find("'camera.eye'"), std::string::npos) << camera_at(2e9, 1);
  EXPECT_EQ(camera_at(2e9, 0.01), "");
  EXPECT_NE(camera_at(2e7, 100).find("'camera.eye'"), std::string::npos);
  for (const double unit : {0.0, -1.0, 1e20}) {
    Json json = least();
    json["metres_per_unit"] = unit;
    json["contact"] = {{"distance", 1}};
    EXPECT_NE(fault_of(json).find("'metres_per_unit' must"), std::string::npos) << fault_of(json);
  }
}

TEST(FrameFile, AMatrixWithoutAnInverseIsRefused) {
  Json json = least();
  json["camera"] = {
      {"clip_from_world", std::vector<double>(16, 1)}, {"order", "row"}, {"depth_range", "0..1"}, {"reversed", false}};
  const Scene scene = make_scene({.name = "plate"});
  EXPECT_THROW(parse_frame_file("frame.json", json.dump()).view(scene, 16, 9), Error);
}

TEST(FrameFile, TheSchemaHasEveryKey) {
  const Json schema = Json::parse(frame_schema());
  for (const FrameKey& key : frame_keys()) {
    const Json& owner = key.object.empty() ? schema : schema.at("properties").at(std::string(key.object));
    EXPECT_TRUE(owner.at("properties").contains(std::string(key.name))) << key.object << "." << key.name;
  }
}

}  // namespace
}  // namespace noonmark::test
