// The first steps with a model of one's own: inspect, init, and the program without arguments.
#include <nlohmann/json.hpp>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "app/definition/first_experiment.h"
#include "scenes/shapes.h"
#include "tests/program/fixture.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::acceptance {
namespace {

using nlohmann::json;

class FirstSteps : public Program {};

// A square that stands upright: it has no ground.
json standing() { return test::square(); }
// The same lying on its back, which faces up.
json lying() {
  json model = test::square();
  model["nodes"][0]["rotation"] = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  return model;
}

TEST_F(FirstSteps, AnInitializedExperimentRunsAtOnce) {
  fs::create_directories(folder_ / "models/a \"b\"");
  write("models/a \"b\"/square.gltf", standing().dump());
  expect_run({"init", "models/a \"b\"/square.gltf", "--out", "exp/first.toml"}, 0,
             {"noonmark run exp/first.toml", "noonmark recommend exp/first.toml",
              "noonmark check out/exp/recommend-first/recommended.toml", "open out/exp/first/report.html"});
  expect_run({"run", "exp/first.toml", "--out", "out", "--set", "view.width_px=64", "--set", "view.height_px=36"}, 0,
             {"4 points measured"});
  EXPECT_FALSE(says("has no effect")) << "it sets something in vain: " << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
}

TEST_F(FirstSteps, AnExperimentThatIsThereStaysUnlessAskedFor) {
  write("square.gltf", standing().dump());
  write("square.toml", "mine");
  expect_run({"init", "square.gltf"}, 2, {"square.toml is there already", "--overwrite"});
  EXPECT_EQ(text("square.toml"), "mine");
  EXPECT_EQ(run({"init", "square.gltf", "--overwrite"}), 0) << output_;
  EXPECT_NE(text("square.toml"), "mine");
}

TEST_F(FirstSteps, AModelWithAGroundGetsNoFloorAndOneWithALightNoSun) {
  write("standing.gltf", standing().dump());
  json lit = lying();
  lit["extensionsUsed"] = {"KHR_lights_punctual"};
  lit["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  lit["nodes"].push_back({{"translation", {0, 3, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  lit["scenes"][0]["nodes"] = {0, 1};
  write("lit.gltf", lit.dump());
  ASSERT_EQ(run({"init", "standing.gltf"}), 0) << output_;
  ASSERT_EQ(run({"init", "lit.gltf"}), 0) << output_;
  const Experiment first = load_experiment((folder_ / "standing.toml").string());
  EXPECT_TRUE(first.base.scene.floor);
  EXPECT_TRUE(first.base.light.elevation_deg && first.base.light.azimuth_deg);
  EXPECT_EQ(first.base.map.fit, MapFit::casters);
  EXPECT_TRUE(first.phase.enabled);
  EXPECT_EQ(first.bounds.size(), 4u) << "acne, Peter Panning, and two for the eye";
  EXPECT_EQ(first.choose.size(), 4u);
  const Experiment second = load_experiment((folder_ / "lit.toml").string());
  EXPECT_FALSE(second.base.scene.floor);
  EXPECT_FALSE(second.base.light.elevation_deg || second.base.light.azimuth_deg);
  EXPECT_EQ(second.base.map.fit, MapFit::scene) << "a point light has no fit to the view";
  EXPECT_FALSE(second.phase.enabled) << "nor a phase diagram";
}

// The lines of a comment are an offer: as they stand there, they must work.
TEST_F(FirstSteps, TheSunMayBeGivenAsAPositionAndATarget) {
  write("standing.gltf", standing().dump());
  ASSERT_EQ(run({"init", "standing.gltf"}), 0) << output_;
  std::string file = text("standing.toml");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const size_t at = file.find(from);
    ASSERT_NE(at, std::string::npos) << from << "\n" << file;
    file.replace(at, from.size(), to);
  };
  replace("# position_m", "position_m"), replace("# target_m", "target_m");
  write("both.toml", file);
  expect_run({"check", "both.toml", "--dry-run"}, 2, {"both set the light's direction"});
  // On the command line: what the file sets must be taken back, and the message says how.
  std::vector<std::string> words = {"check", "standing.toml", "--dry-run", "--set", "light.position_m=5,10,7"};
  expect_run(words, 2, {"--set light.azimuth_deg=auto"});
  words.insert(words.end(), {"--set", "light.azimuth_deg=auto", "--set", "light.elevation_deg=auto"});
  EXPECT_EQ(run(words), 0) << output_;
  replace("azimuth_deg", "# azimuth_deg"), replace("elevation_deg", "# elevation_deg");
  write("sun.toml", file);
  const Experiment sun = load_experiment((folder_ / "sun.toml").string());
  EXPECT_EQ(sun.base.light.position_m, glm::dvec3(5, 10, 7));
  EXPECT_EQ(run({"run", "sun.toml", "--set", "view.width_px=64", "--set", "view.height_px=36"}), 0) << output_;
}

TEST_F(FirstSteps, AClosedRoomGetsALightInside) {
  Model room;
  add_box(room.scene, "room", {-2, 0, -2}, {2, 3, 2});
  for (glm::uvec3& t : room.scene.triangles) std::swap(t.y, t.z);
  room.scene.single_sided.assign(room.scene.triangles.size(), true);
  const std::string first = first_experiment(room, "room.glb");
  EXPECT_NE(first.find("kind = \"point\""), std::string::npos) << first;
  EXPECT_NE(first.find("position_m = [0, 1.5, 0]"), std::string::npos) << first;
  EXPECT_NE(first.find("floor = false"), std::string::npos) << first;
}

TEST_F(FirstSteps, InspectSaysWhatAModelHolds) {
  json model = standing();
  model["materials"] = {{{"alphaMode", "BLEND"}, {"doubleSided", true}}, {{"name", "plain"}}};
  model["meshes"][0]["primitives"][0]["material"] = 0;
  model["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
  model["nodes"][0]["translation"] = {100, 0, 0};
  write("square.gltf", model.dump());
  expect_run({"inspect", "square.gltf"}, 0,
             {"1 mesh, 1 primitive, 1 node, 2 triangles", "2 (1 opaque, 1 blended, 1 double-sided)",
              "open: 4 edges of one triangle only", "1 material with alphaMode BLEND taken as opaque"});
  EXPECT_TRUE(fs::exists(folder_ / "out/inspect-square/view.png"));
  ASSERT_EQ(run({"inspect", "square.gltf", "--json", "--set", "scene.mesh=doubled", "--out", "here"}), 0) << output_;
  const json facts = json::parse(output_.substr(output_.find('{')));
  EXPECT_EQ(facts["triangles"], 4);
  EXPECT_EQ(facts["doubled_triangles"], 2);
  EXPECT_EQ(facts["open_edges"], 4);
  EXPECT_EQ(facts["closed"], false);
  EXPECT_EQ(facts["cameras"], 1);
  EXPECT_EQ(facts["gives_camera"], false) << "no node has it";
  EXPECT_EQ(facts["farthest_coordinate_m"], 101);
  EXPECT_EQ(facts["float_step_m"], 0x1p-17) << "of floats from 64 to 128";
  EXPECT_EQ(facts["shortest_edge_m"], 1);
  EXPECT_NEAR(facts["texel_m"]["1024"].get<double>(), 4 * facts["texel_m"]["4096"].get<double>(), 1e-12);
  EXPECT_EQ(facts["picture"], "here/view.png");
  EXPECT_TRUE(fs::exists(folder_ / "here/view.png"));
}

TEST_F(FirstSteps, WhatIsNoModelIsOneClearError) {
  write("broken.glb", "glTF");
  json empty = standing();
  empty["meshes"][0]["primitives"][0]["mode"] = 1;  // lines
  write("lines.gltf", empty.dump());
  fs::create_directories(folder_ / "folder.glb");
  fs::create_directories(folder_ / "folder");
  const std::pair<const char*, int> mistakes[] = {{"absent.glb", 3},
                                                  {"broken.glb", 3},
                                                  {"lines.gltf", 3},
                                                  {"folder.glb", 3},
                                                  {"folder", 2},
                                                  {"cube-room", 2},
                                                  {"", 2}};
  for (const char* verb : {"init", "inspect"})
    for (const auto& [model, code] : mistakes) {
      EXPECT_EQ(run({verb, model}), code) << verb << " " << model << ": " << output_;
      EXPECT_TRUE(says(*model ? model : "empty")) << output_;
      EXPECT_FALSE(fs::exists(folder_ / "out") || fs::exists(folder_ / "broken.toml")) << verb << " " << model;
    }
  write("square.gltf", standing().dump());
  expect_run({"init", "square.gltf", "--out", "folder"}, 2, {"folder is a folder"});
}

}  // namespace
}  // namespace noonmark::acceptance
