// A scene that is written as a .glb and read again is the same scene.
#include "scenes/gltf/write_glb.h"

#include "scenes/builtin.h"
#include "scenes/camera_fit.h"
#include "scenes/gltf/gltf.h"
#include "tests/scenes/gltf/expect.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::test {
namespace {

// A quaternion and back, in double.
constexpr double rotation_rounding = 1e-12;

class WriteGlb : public ::testing::Test {
 protected:
  Scene through_file(const Scene& scene, const Light& light) {
    return load_gltf(folder_.write("scene.glb", glb_of(scene, effective_camera(scene, {}), light)));
  }
  static glm::dvec3 travels(const Light& light) { return glm::normalize(light.target_m - light.position_m); }
  TemporaryFolder folder_;
};

TEST_F(WriteGlb, KeepsEveryBuiltinScene) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    SCOPED_TRACE(builtin.name);
    const Scene scene = builtin.make({});
    const Scene read = through_file(scene, scene.light);
    EXPECT_EQ(defect_of(read), "");
    ASSERT_EQ(read.triangles.size(), scene.triangles.size());
    for (size_t t = 0; t < scene.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        ASSERT_EQ(read.positions[read.triangles[t][k]], scene.positions[scene.triangles[t][k]]) << t << ' ' << k;
    const auto single = [](const Scene& s, size_t t) { return !s.single_sided.empty() && s.single_sided[t]; };
    for (size_t t = 0; t < scene.triangles.size(); ++t) ASSERT_EQ(single(read, t), single(scene, t)) << t;
    std::vector<std::string> names, names_read;
    for (const Part& part : scene.parts) names.push_back(part.name);
    for (const Part& part : read.parts) names_read.push_back(part.name);
    EXPECT_EQ(names_read, names);
    const Camera camera = effective_camera(scene, {});
    EXPECT_EQ(read.camera.eye_m, camera.eye_m);
    EXPECT_LT(glm::distance(glm::normalize(read.camera.target_m - camera.eye_m),
                            glm::normalize(camera.target_m - camera.eye_m)),
              rotation_rounding);
    EXPECT_NEAR(read.camera.fov_y_deg, camera.fov_y_deg, rotation_rounding);
    EXPECT_EQ(read.camera.near_m, camera.near_m);
    EXPECT_EQ(read.camera.far_m, camera.far_m);
    EXPECT_EQ(read.light.kind, scene.light.kind);
    if (scene.light.kind != LightKind::point) {
      EXPECT_LT(glm::distance(travels(read.light), travels(scene.light)), rotation_rounding);
    }
    if (scene.light.kind != LightKind::directional) {
      EXPECT_EQ(read.light.position_m, scene.light.position_m);
    }
    if (scene.light.kind == LightKind::spot) {
      EXPECT_NEAR(read.light.cone_deg, scene.light.cone_deg, rotation_rounding * 100);
    }
  }
}

TEST_F(WriteGlb, KeepsALightFromStraightAboveAndAnOrthographicCamera) {
  Scene scene = builtin_scenes().front().make({});
  scene.camera.projection = Projection::orthographic;
  scene.camera.height_m = 3.5;
  Light light = scene.light;
  light.position_m = {0, 10, 0};
  light.target_m = {0, 0, 0};
  const Scene read = through_file(scene, light);
  EXPECT_EQ(read.camera.projection, Projection::orthographic);
  EXPECT_EQ(read.camera.height_m, 3.5);
  EXPECT_LT(glm::distance(travels(read.light), glm::dvec3(0, -1, 0)), rotation_rounding);
}

TEST_F(WriteGlb, KeepsAllLightsOfASceneInTheirOrder) {
  Scene scene;
  for (const BuiltinScene& builtin : builtin_scenes())
    if (builtin.name == std::string("lab")) scene = builtin.make({});
  ASSERT_EQ(scene.lights.size(), 3u);
  const Scene read = load_gltf(folder_.write(
      "scene.glb", glb_of(scene, effective_camera(scene, {}), scene.light, std::span(scene.lights).subspan(1))));
  ASSERT_EQ(read.lights.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.lights[i].name, scene.lights[i].name);
    ASSERT_TRUE(read.lights[i].value) << read.lights[i].why_not;
    const Light &there = *read.lights[i].value, &here = *scene.lights[i].value;
    EXPECT_EQ(there.kind, here.kind);
    if (here.kind != LightKind::directional) {
      EXPECT_EQ(there.position_m, here.position_m);
    }
    EXPECT_NEAR(there.power.intensity, here.power.intensity, 1e-6 * here.power.intensity);
  }
}

TEST_F(WriteGlb, KeepsWhichTrianglesAreSeenFromTheFrontOnly) {
  Scene scene = builtin_scenes().front().make({});
  scene.single_sided.assign(scene.triangles.size(), false);
  for (size_t t = 0; t < scene.triangles.size(); t += 3) scene.single_sided[t] = true;
  const Scene read = through_file(scene, scene.light);
  EXPECT_EQ(read.single_sided, scene.single_sided);
}

TEST_F(WriteGlb, WritesAUnitNormalForATriangleWithoutArea) {
  Scene scene = builtin_scenes().front().make({});
  scene.triangles[0].y = scene.triangles[0].x;
  const Scene read = through_file(scene, scene.light);
  EXPECT_EQ(defect_of(read), "");
}

}  // namespace
}  // namespace noonmark::test
