// load_gltf on files whose geometry moves: skins, morph targets, instances, visibility and animations, against numbers
// worked out by hand.
#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "tests/scenes/gltf/gltf_fixture.h"

namespace noonmark::test {
namespace {

// Floats of order 1 to 10 after a handful of operations in double.
constexpr float pose_rounding = 1e-6f;

class GltfPose : public GltfFile {
 protected:
  static void expect_positions(const Scene& s, const std::vector<glm::vec3>& expected) {
    ASSERT_EQ(s.positions.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i)
      EXPECT_LT(glm::distance(s.positions[i], expected[i]), pose_rounding)
          << i << ": " << s.positions[i].x << ' ' << s.positions[i].y << ' ' << s.positions[i].z;
  }
  static json& attributes(json& d) { return d["meshes"][0]["primitives"][0]["attributes"]; }

  // The square under a skin of two joints: nodes 1 and 2, the second one a child of the first. Vertices 0 and 1 follow
  // the first, 2 and 3 the second.
  static json skinned() {
    json d = square();
    d["nodes"][0]["skin"] = 0;
    d["nodes"][0]["translation"] = {50, 60, 70};  // to be ignored
    d["nodes"].push_back({{"translation", {10, 0, 0}}, {"children", {2}}});
    d["nodes"].push_back({{"translation", {0, 5, 0}}});
    d["scenes"][0]["nodes"] = {0, 1};
    d["skins"] = {{{"joints", {1, 2}}}};
    attributes(d)["JOINTS_0"] =
        add_accessor(d, raw(std::vector<uint8_t>{0, 9, 9, 9, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0, 0, 0}), 5121, "VEC4", 4);
    attributes(d)["WEIGHTS_0"] =
        add_accessor(d, raw(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5126, "VEC4", 4);
    return d;
  }
  static int add_floats(json& d, const std::vector<float>& values, const std::string& type, size_t count) {
    return add_accessor(d, raw(values), 5126, type, count);
  }
  // A channel of an animation over keys at 1, 2 and 4 seconds.
  static void animate(json& d, int node, const std::string& path, int output, const std::string& how) {
    if (!d.contains("animations")) d["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
    json& animation = d["animations"][0];
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back(
        {{"input", add_floats(d, {1, 2, 4}, "SCALAR", 3)}, {"output", output}, {"interpolation", how}});
  }
};

TEST_F(GltfPose, SkinsFollowTheirJointsAndNotTheirNode) {
  json d = skinned();
  expect_positions(load(d), {{10, 0, 0}, {11, 0, 0}, {11, 6, 0}, {10, 6, 0}});
  // With inverse bind matrices, joints that stand in their bind pose leave the mesh as modelled.
  const std::vector<float> unbind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, 0,  0, 1,
                                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, -5, 0, 1};
  d["skins"][0]["inverseBindMatrices"] = add_floats(d, unbind, "MAT4", 2);
  expect_positions(load(d), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  // A joint that is turned turns the vertices bound to it about the joint: here the upper edge, by 180 degrees about Y
  // at (10, 5).
  d["nodes"][2]["rotation"] = {0, 1, 0, 0};
  expect_positions(load(d), {{0, 0, 0}, {1, 0, 0}, {19, 1, 0}, {20, 1, 0}});
}

TEST_F(GltfPose, WeightsBlendJointsAndAreScaledToASumOfOne) {
  json d = skinned();
  attributes(d)["JOINTS_0"] =
      add_accessor(d, raw(std::vector<uint16_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5123, "VEC4", 4);
  // A quarter and three quarters, as bytes that add to 252.
  attributes(d)["WEIGHTS_0"] = add_accessor(
      d, raw(std::vector<uint8_t>{63, 189, 0, 0, 63, 189, 0, 0, 252, 0, 0, 0, 0, 252, 0, 0}), 5121, "VEC4", 4);
  d["accessors"].back()["normalized"] = true;
  expect_positions(load(d), {{10, 3.75, 0}, {11, 3.75, 0}, {11, 1, 0}, {10, 6, 0}});
  // A second set of joints adds to the first.
  attributes(d)["JOINTS_1"] = attributes(d)["JOINTS_0"];
  attributes(d)["WEIGHTS_1"] =
      add_accessor(d, raw(std::vector<float>{0.5, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}), 5126, "VEC4", 4);
  const Scene s = load(d);
  const double sum = 252 / 255.0, first = 63 / 255.0 + 0.5, all = sum + 0.5;
  EXPECT_NEAR(s.positions[0].y, 5 * (1 - first / all), pose_rounding);
  EXPECT_NEAR(s.positions[2].y, 1 + 5 * (1 / (sum + 1)), pose_rounding);
}

TEST_F(GltfPose, MirroringJointsFlipTheWinding) {
  json d = skinned();
  d["nodes"][1]["scale"] = {-1, 1, 1};
  const Scene s = load(d);
  for (const glm::uvec3& t : s.triangles)
    EXPECT_GT(glm::cross(s.positions[t.y] - s.positions[t.x], s.positions[t.z] - s.positions[t.x]).z, 0);
  // The scale of the mesh's own node has no effect on the winding either.
  d["nodes"][1].erase("scale");
  d["nodes"][0]["scale"] = {-1, 1, 1};
  expect_positions(load(d), {{10, 0, 0}, {11, 0, 0}, {11, 6, 0}, {10, 6, 0}});
  d["nodes"][0]["scale"] = {0, 0, 0};
  expect_positions(load(d), {{10, 0, 0}, {11, 0, 0}, {11, 6, 0}, {10, 6, 0}});
}

TEST_F(GltfPose, JointsMayStandOutsideTheScene) {
  json d = skinned();
  d["scenes"][0]["nodes"] = {0};
  expect_positions(load(d), {{10, 0, 0}, {11, 0, 0}, {11, 6, 0}, {10, 6, 0}});
}

TEST_F(GltfPose, BrokenSkinsAreRefused) {
  const auto expect = [&](const std::function<void(json&)>& damage, const std::string& text) {
    json d = skinned();
    damage(d);
    expect_refusal(d, text);
  };
  const auto weights = [](json& d, const std::vector<float>& values) {
    attributes(d)["WEIGHTS_0"] = add_floats(d, values, "VEC4", 4);
  };
  expect([](json& d) { attributes(d).erase("WEIGHTS_0"); }, "JOINTS_0 without its weights");
  expect([](json& d) { attributes(d).erase("WEIGHTS_0"), attributes(d).erase("JOINTS_0"); },
         "a mesh under a skin without JOINTS_0 and WEIGHTS_0, which it has to have");
  expect([](json& d) { attributes(d)["JOINTS_0"] = 0; }, "JOINTS_0: accessors[0] is not a list of 4 joints");
  expect([](json& d) { attributes(d)["JOINTS_0"] = 99; }, "JOINTS_0: accessors[99] is not a list");
  expect([](json& d) { attributes(d)["WEIGHTS_0"] = -1; }, "WEIGHTS_0: should be an integer");
  expect([&](json& d) { weights(d, std::vector<float>(16, 0)); },
         "vertex 0 under a skin has no weights (their sum is 0), so glTF gives it no place");
  expect([&](json& d) { weights(d, std::vector<float>(16, -1)); }, "vertex 0 has a weight of -1");
  expect([&](json& d) { weights(d, std::vector<float>(16, 0.25)); }, "vertex 0 follows joint 9 of 2");
  expect([](json& d) { d["nodes"][0]["skin"] = 1; }, "nodes[0].skin: 1 refers beyond");
  expect([](json& d) { d["skins"][0]["joints"] = {1, 9}; }, "skins[0].joints[1]: 9 refers beyond");
  expect([](json& d) { d["skins"][0]["joints"] = json::array(); }, "skins[0].joints: is empty");
  expect([](json& d) { d["skins"][0]["inverseBindMatrices"] = 0; }, "skins[0].inverseBindMatrices: accessors[0] is no");
  expect([](json& d) { d["skins"][0]["inverseBindMatrices"] = add_floats(d, std::vector<float>(16), "MAT4", 1); },
         "1 matrix for 2 joints");
}

// Targets: the first lifts all by 1, the second moves vertex 2 by (4, 0, 0).
json morphed() {
  json d = square();
  const int lift = add_accessor(d, raw(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
  const int stretch = add_accessor(d, raw(std::vector<float>{0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0}), 5126, "VEC3", 4);
  d["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", lift}, {"NORMAL", lift}}, {{"POSITION", stretch}}};
  return d;
}

TEST_F(GltfPose, MorphTargetsByTheNodesWeightsElseTheMeshs) {
  json d = morphed();
  expect_positions(load(d), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  d["meshes"][0]["weights"] = {0.5, 0};
  expect_positions(load(d), {{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}});
  d["nodes"][0]["weights"] = {-2, 0.25};
  expect_positions(load(d), {{0, 0, -2}, {1, 0, -2}, {2, 1, -2}, {0, 1, -2}});
  // Morph targets are applied before the node's transform and before the skin.
  d["nodes"][0]["scale"] = {1, 1, 3};
  EXPECT_EQ(load(d).positions[0].z, -6);
  d["nodes"][0]["weights"] = {1};
  expect_refusal(d, "meshes[0].primitives[0].targets: 2 morph targets, but 1 weights");
  d["nodes"][0]["weights"] = {1, 0};
  d["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] =
      add_accessor(d, raw(std::vector<float>(9)), 5126, "VEC3", 3);
  expect_refusal(d, "targets[0].POSITION: 3 vertices, but the mesh has 4");
  d["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 77;
  expect_refusal(d, "targets[0].POSITION: 77 refers beyond");
}

TEST_F(GltfPose, InvisibleNodesHideWhatIsBelowThemButNoCamera) {
  json d = square();
  d["scenes"][0]["nodes"] = {0, 1};
  d["nodes"].push_back(
      {{"mesh", 0}, {"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  d["nodes"].push_back(
      {{"mesh", 0},
       {"camera", 0},
       {"translation", {0.5, 0.5, 7}},
       {"extensions", {{"KHR_node_visibility", {{"visible", true}}}, {"KHR_lights_punctual", {{"light", 0}}}}}});
  d["extensionsUsed"] = d["extensionsRequired"] = {"KHR_node_visibility"};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.25}}}}};
  const Scene hidden = load(d);
  EXPECT_EQ(hidden.triangles.size(), 2u);
  EXPECT_EQ(hidden.camera.eye_m.z, 7);
  EXPECT_EQ(hidden.light.kind, LightKind::directional) << "fitted: the point light is not visible";
  d["nodes"][1]["extensions"]["KHR_node_visibility"] = json::object();
  const Scene shown = load(d);
  EXPECT_EQ(shown.triangles.size(), 6u);
  EXPECT_EQ(shown.light.kind, LightKind::point);
}

json instanced() {
  json d = square();
  const int translation = add_accessor(d, raw(std::vector<float>{0, 0, 1, 5, 0, 2, 0, 0, 3}), 5126, "VEC3", 3);
  // Rotations in 16 bits: none, a quarter turn about Z, none.
  const int rotation =
      add_accessor(d, raw(std::vector<int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767}), 5122, "VEC4", 3);
  d["accessors"].back()["normalized"] = true;
  const int scale = add_accessor(d, raw(std::vector<float>{1, 1, 1, 2, 1, 1, -1, 1, 1}), 5126, "VEC3", 3);
  d["extensionsUsed"] = d["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  d["nodes"][0]["translation"] = {100, 0, 0};
  d["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", 3}};
  return d;
}

TEST_F(GltfPose, InstancesAreInTheNodesOwnSpace) {
  const Scene s = load(instanced());
  ASSERT_EQ(s.triangles.size(), 6u);
  ASSERT_EQ(s.parts.size(), 1u);
  expect_positions(s, {{100, 0, 1},
                       {101, 0, 1},
                       {101, 1, 1},
                       {100, 1, 1},
                       {105, 0, 2},
                       {105, 2, 2},
                       {104, 2, 2},
                       {104, 0, 2},
                       {100, 0, 3},
                       {99, 1, 3},
                       {99, 0, 3},
                       {100, 1, 3}});
  // The mirrored instance faces the same side as the others.
  for (const glm::uvec3& t : s.triangles)
    EXPECT_GT(glm::cross(s.positions[t.y] - s.positions[t.x], s.positions[t.z] - s.positions[t.x]).z, 0);
}

TEST_F(GltfPose, BrokenInstancesAreRefused) {
  const std::string place = "nodes[0].extensions.EXT_mesh_gpu_instancing";
  const auto expect = [&](const std::function<void(json&)>& damage, const std::string& text) {
    json d = instanced();
    damage(d);
    expect_refusal(d, text);
  };
  const auto given = [](json& d) -> json& {
    return d["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  };
  expect([&](json& d) { given(d)["SCALE"] = 0; }, place + ".attributes.SCALE: 4 instances, and 3 in another");
  expect([&](json& d) { given(d)["SCALE"] = 1; }, place + ".attributes.SCALE: accessors[1] is of another type");
  expect([&](json& d) { given(d)["ROTATION"] = 99; }, place + ".attributes.ROTATION: 99 refers beyond");
  expect([&](json& d) { d["accessors"][3]["bufferView"] = d["accessors"][2]["bufferView"]; }, "quaternion of length");
  // 67 million triangles in a file of 1 kB: an accessor without a view is all zeros and takes no room in the file.
  expect(
      [&](json& d) {
        given(d).erase("ROTATION"), given(d).erase("SCALE");
        d["accessors"][2].erase("bufferView");
        d["accessors"][2]["count"] = (1 << 25) + 1;
      },
      "nodes[0].mesh: the scene has more than the 67108864 triangles allowed");
  json both = skinned();
  both["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 0}};
  expect_refusal(both, "instances of a mesh under a skin");
}

TEST_F(GltfPose, AtRestAnAnimationIsNotReadButSaid) {
  json d = square();
  d["animations"] = {{{"channels", "broken"}}, 7};
  const Scene s = load(d);
  EXPECT_EQ(s.positions[1], glm::vec3(1, 0, 0));
  EXPECT_TRUE(noted(s, "2 animations at rest"));
  expect_refusal(d, "animations[0].channels: should be an array", {1.0, 0});
  expect_refusal(d, "animations: there are 2, counted from 0, and 2 is requested", {1.0, 2});
  expect_refusal(square(), "animations: there are none", {1.0, 0});
  d["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
  EXPECT_TRUE(noted(load(d, {1.0, 0}), "the animation has no channels, so scene.time_s moves nothing"));
}

TEST_F(GltfPose, LinearKeysAndTheEndsStandStill) {
  json d = square();
  animate(d, 0, "translation", add_floats(d, {0, 0, 0, 10, 0, 0, 10, 8, 0}, "VEC3", 3), "LINEAR");
  animate(d, 0, "scale", add_floats(d, {1, 1, 1, 1, 1, 1, 3, 1, 1}, "VEC3", 3), "STEP");
  const auto corner = [&](double time, size_t vertex) { return load(d, {time, 0}).positions[vertex]; };
  for (const auto& [time, at] : {std::pair{0.0, glm::vec3(0)},
                                 {1.0, {0, 0, 0}},
                                 {1.25, {2.5, 0, 0}},
                                 {2.0, {10, 0, 0}},
                                 {3.0, {10, 4, 0}},
                                 {4.0, {10, 8, 0}},
                                 {1000.0, {10, 8, 0}}})
    EXPECT_LT(glm::distance(corner(time, 0), at), pose_rounding) << time;
  EXPECT_LT(glm::distance(corner(3.999999, 1), glm::vec3(11, 8, 0)), 1e-4f) << "a step holds until the next key";
  EXPECT_LT(glm::distance(corner(4, 1), glm::vec3(13, 8, 0)), pose_rounding);
  EXPECT_EQ(load(d).positions[0], glm::vec3(0)) << "at rest";
  EXPECT_FALSE(noted(load(d, {2.0, 0}), "at rest"));
}

TEST_F(GltfPose, RotationsGoTheShortWayAtEvenSpeed) {
  json d = square();
  const float half = std::sqrt(0.5f);
  // No rotation, then a quarter turn about Z written as the negated quaternion, then the same turn. The shorter arc is
  // 90 degrees.
  animate(d, 0, "rotation", add_floats(d, {0, 0, 0, 1, 0, 0, -half, -half, 0, 0, half, half}, "VEC4", 3), "LINEAR");
  for (double t : {0.0, 0.25, 0.5, 1.0}) {
    const double angle = t * glm::half_pi<double>();
    const glm::vec3 x = load(d, {1 + t, 0}).positions[1];
    EXPECT_LT(glm::distance(x, glm::vec3(std::cos(angle), std::sin(angle), 0)), pose_rounding) << t;
  }
}

// A cubic spline that is given the values and slopes of x(t) = (t - 1)^3 is that cubic.
TEST_F(GltfPose, CubicSplinesAreHermites) {
  json d = square();
  std::vector<float> keys;
  for (double t : {1.0, 2.0, 4.0}) {
    const auto slope = static_cast<float>(3 * (t - 1) * (t - 1)), value = static_cast<float>(std::pow(t - 1, 3));
    for (float x : {slope, 0.0f, 0.0f, value, 0.0f, 0.0f, slope, 0.0f, 0.0f}) keys.push_back(x);
  }
  animate(d, 0, "translation", add_floats(d, keys, "VEC3", 9), "CUBICSPLINE");
  for (double t : {0.5, 1.0, 1.5, 2.0, 2.25, 3.5, 4.0, 9.0}) {
    const double clamped = std::clamp(t, 1.0, 4.0);
    EXPECT_NEAR(load(d, {t, 0}).positions[0].x, std::pow(clamped - 1, 3), 1e-5) << t;
  }
}

TEST_F(GltfPose, WeightsJointsAndVisibilityAreAnimatedToo) {
  json d = morphed();
  animate(d, 0, "weights", add_floats(d, {0, 0, 1, 0, 1, 1}, "SCALAR", 6), "LINEAR");
  expect_positions(load(d, {3.0, 0}), {{0, 0, 1}, {1, 0, 1}, {3, 1, 1}, {0, 1, 1}});

  json bones = skinned();
  animate(bones, 2, "translation", add_floats(bones, {0, 5, 0, 0, 7, 0, 0, 9, 0}, "VEC3", 3), "LINEAR");
  expect_positions(load(bones, {3.0, 0}), {{10, 0, 0}, {11, 0, 0}, {11, 9, 0}, {10, 9, 0}});

  json blink = square();
  blink["scenes"][0]["nodes"] = {0, 1};
  blink["nodes"].push_back({{"mesh", 0}});
  animate(blink, 1, "pointer", add_accessor(blink, raw(std::vector<uint8_t>{1, 0, 1}), 5121, "SCALAR", 3), "STEP");
  blink["animations"][0]["channels"][0]["target"] = {
      {"path", "pointer"},
      {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/1/extensions/KHR_node_visibility/visible"}}}}}};
  EXPECT_EQ(load(blink, {1.0, 0}).triangles.size(), 4u);
  EXPECT_EQ(load(blink, {2.5, 0}).triangles.size(), 2u);
  blink["animations"][0]["channels"][0]["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
      "/materials/0/emissiveFactor";
  const Scene shining = load(blink, {2.5, 0});
  EXPECT_EQ(shining.triangles.size(), 4u);
  EXPECT_TRUE(noted(shining, "1 channel of the animation not read"));
}

TEST_F(GltfPose, BrokenAnimationsAreRefusedWhenTheyPose) {
  const auto expect = [&](const std::function<void(json&)>& damage, const std::string& text) {
    json d = square();
    animate(d, 0, "translation", add_floats(d, {0, 0, 0, 10, 0, 0, 10, 8, 0}, "VEC3", 3), "LINEAR");
    damage(d);
    EXPECT_EQ(defect_of(load(d)), "") << "at rest";
    expect_refusal(d, text, {2.5, 0});
  };
  const auto sampler = [](json& d) -> json& { return d["animations"][0]["samplers"][0]; };
  const auto target = [](json& d) -> json& { return d["animations"][0]["channels"][0]["target"]; };
  expect(
      [&](json& d) {
        sampler(d)["input"] = add_floats(d, {1, 1, 4}, "SCALAR", 3);
      },
      "time 1 is 1, not finite or not after");
  expect([&](json& d) { sampler(d)["input"] = add_floats(d, {1, NAN, 4}, "SCALAR", 3); }, "time 1 is nan");
  expect([&](json& d) { sampler(d)["input"] = add_floats(d, {1, 2}, "SCALAR", 2); }, "has 3 values for 2 keys");
  expect(
      [&](json& d) {
        sampler(d)["output"] = add_floats(d, {1, 2, 3, INFINITY, 0, 0, 0, 0, 0}, "VEC3", 3);
      },
      "the value of key 1 is not finite");
  expect([&](json& d) { sampler(d)["interpolation"] = "CUBICSPLINE"; }, "has 3 values for 3 keys of 3");
  expect([&](json& d) { sampler(d)["interpolation"] = "MAGIC"; }, "interpolation 'MAGIC'");
  expect([&](json& d) { sampler(d)["output"] = 1; }, "the type of the property that it moves");
  expect([&](json& d) { sampler(d)["output"] = 99; }, "output 99 is beyond");
  expect([&](json& d) { sampler(d)["input"] = 0; }, "accessors[0] is not a list of times");
  expect([&](json& d) { d["animations"][0]["channels"][0]["sampler"] = 3; }, "sampler 3 is beyond the 1 samplers");
  expect([&](json& d) { target(d)["node"] = 9; }, "node 9 is beyond the 1 nodes");
  expect([&](json& d) { target(d)["path"] = "weights"; }, "weights of a mesh without morph targets");
  expect([&](json& d) { d["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
         "which has a matrix");
  expect(
      [&](json& d) {
        target(d)["path"] = "rotation", sampler(d)["output"] = add_floats(d, std::vector<float>(12), "VEC4", 3);
      },
      "a quaternion of length 0");
}

// A file of a few kilobytes must not cause hours of work.
TEST_F(GltfPose, WorkIsBounded) {
  json d = square();
  auto& primitive = d["meshes"][0]["primitives"][0];
  d["accessors"][0].erase("bufferView"), d["accessors"][0]["count"] = 3000000;
  primitive.erase("indices");
  for (int i = 0; i < 1000; ++i) primitive["targets"].push_back({{"POSITION", 0}});
  d["meshes"][0]["weights"] = std::vector<double>(1000, 1);
  expect_refusal(d, "values are to be read");
}

}  // namespace
}  // namespace noonmark::test
