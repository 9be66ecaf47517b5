// Cameras and lights: from the file, and fitted where it has none.
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scenes/camera_fit.h"
#include "scenes/fit.h"
#include "scenes/library.h"
#include "tests/scenes/gltf/gltf_fixture.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::test {
namespace {

// Doubles of order 1 to 100 after a handful of operations.
constexpr double view_rounding = 1e-9;

class GltfView : public GltfFile {
 protected:
  // The square with one more node.
  static json with_node(const json& node) {
    json d = square();
    d["scenes"][0]["nodes"] = {0, 1};
    d["nodes"].push_back(node);
    return d;
  }
  static json with_lights(const json& lights, const json& node) {
    json d = with_node(node);
    d["extensionsUsed"] = d["extensionsRequired"] = {"KHR_lights_punctual"};
    d["extensions"]["KHR_lights_punctual"]["lights"] = lights;
    d["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    return d;
  }
  static glm::dvec3 travels(const Light& light) { return glm::normalize(light.target_m - light.position_m); }
  static void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::distance(found, expected), view_rounding) << found.x << ' ' << found.y << ' ' << found.z;
  }
};

// About +X by -90 degrees: -Z becomes -Y, +Y becomes -Z.
const json looks_down = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

TEST_F(GltfView, PerspectiveCameraLooksAlongItsNode) {
  json d = with_node({{"camera", 0}, {"translation", {0.5, 9, 0}}, {"rotation", looks_down}});
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.25}, {"zfar", 50}}}}};
  const Camera c = load(d).camera;
  EXPECT_EQ(c.projection, Projection::perspective);
  EXPECT_EQ(c.eye_m, glm::dvec3(0.5, 9, 0));
  expect_near(glm::normalize(c.target_m - c.eye_m), {0, -1, 0});
  expect_near(c.up, {0, 0, -1});
  EXPECT_NEAR(c.target_m.y, 0.5, view_rounding);  // level with the square's middle
  EXPECT_NEAR(c.fov_y_deg, 180 / glm::pi<double>(), view_rounding);
  EXPECT_EQ(c.near_m, 0.25);
  EXPECT_EQ(c.far_m, 50);
}

TEST_F(GltfView, InfinitePerspectiveHasNoFarPlane) {
  json d = with_node({{"camera", 0}, {"translation", {0.5, 0.5, 9}}});
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.25}}}}};
  const Scene s = load(d);
  EXPECT_EQ(s.camera.near_m, 0.25);
  EXPECT_FALSE(s.camera.far_m);
  const Camera fitted = effective_camera(s, {});
  EXPECT_EQ(fitted.near_m, 0.25);
  EXPECT_GT(*fitted.far_m, 9);
  EXPECT_LT(*fitted.far_m, 9.1);
}

// FLT_MAX is some exporters' infinity.
TEST_F(GltfView, AFarPlaneBeyondEverythingIsNone) {
  json d = with_node({{"camera", 0}, {"translation", {0.5, 0.5, 9}}});
  for (const double far : {3.4e38, 1e300}) {
    d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.25}, {"zfar", far}}}}};
    EXPECT_FALSE(load(d).camera.far_m) << far;
  }
}

TEST_F(GltfView, OrthographicCamera) {
  json d = with_node({{"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {3, 3, 3}}});
  d["cameras"] = {{{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}}};
  const Camera c = load(d).camera;
  EXPECT_EQ(c.projection, Projection::orthographic);
  EXPECT_EQ(c.height_m, 6);
  EXPECT_EQ(c.near_m, 0);
  EXPECT_EQ(c.far_m, 10);
}

TEST_F(GltfView, DirectionalLightTravelsAlongItsNode) {
  const Scene s = load(with_lights({{{"type", "directional"}}}, {{"rotation", looks_down}}));
  expect_near(travels(s.light), {0, -1, 0});
  expect_near(s.light.target_m, {0.5, 0.5, 0});
  EXPECT_GT(glm::distance(s.light.position_m, s.light.target_m), std::sqrt(0.5));
  EXPECT_EQ(s.light.angular_diameter_deg, 0);
}

TEST_F(GltfView, TheFirstLightInTheScenesOrderIsTaken) {
  json d = with_lights({{{"type", "point"}}, {{"type", "directional"}}}, {{"translation", {5, 5, 5}}});
  d["scenes"][0]["nodes"].push_back(2);
  d["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  EXPECT_EQ(load(d).light.kind, LightKind::point);
  d["scenes"][0]["nodes"] = {0, 2, 1};
  EXPECT_EQ(load(d).light.kind, LightKind::directional);
  // A light that is not used may have a cone that is too wide for a map.
  d["extensions"]["KHR_lights_punctual"]["lights"][0] = {{"type", "spot"}, {"spot", {{"outerConeAngle", 1.57}}}};
  EXPECT_EQ(load(d).light.kind, LightKind::directional);
}

TEST_F(GltfView, ALightsPowerIsRead) {
  const json lamp = {{"type", "spot"},  {"name", "lamp"},
                     {"intensity", 20}, {"color", {1, 0.5, 0.25}},
                     {"range", 30},     {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}};
  const Scene s = load(with_lights({lamp, {{"type", "directional"}}}, {{"translation", {5, 5, 5}}}));
  EXPECT_EQ(s.light.power.intensity, 20);
  EXPECT_EQ(s.light.power.color, glm::dvec3(1, 0.5, 0.25));
  EXPECT_EQ(s.light.power.range_m, 30);
  EXPECT_NEAR(s.light.power.inner_cone_deg, glm::degrees(0.5), 1e-9);
  const Light plain = load(with_lights({{{"type", "point"}}}, {{"translation", {5, 5, 5}}})).light;
  EXPECT_EQ(plain.power.intensity, 1);
  EXPECT_EQ(plain.power.color, glm::dvec3(1));
  EXPECT_FALSE(plain.power.range_m);
  const auto fault = [&](const json& light) {
    return refusal_of(ErrorKind::file, [&] { load(with_lights(json::array({light}), {{"translation", {5, 5, 5}}})); });
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(fault({{"type", "point"}, {"intensity", -3}}), "lights[0].intensity: -3 is not at least 0");
  has(fault({{"type", "point"}, {"range", 0}}), "lights[0].range: 0 is not above 0");
  has(fault({{"type", "point"}, {"color", {1, -1, 0}}}), "lights[0].color: -1 is not at least 0");
  EXPECT_EQ(fault({{"type", "point"}, {"intensity", 0}}), "");
}

TEST_F(GltfView, CamerasAndLightsAreFoundByTheirNames) {
  json d = with_lights({{{"type", "point"}, {"name", "lamp"}}, {{"type", "directional"}, {"name", "sun"}}},
                       {{"translation", {5, 5, 5}}, {"name", "ceiling"}});
  d["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
  d["nodes"].push_back({{"name", "sky"}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.5}, {"znear", 0.25}}}},
                  {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}};
  d["nodes"].push_back({{"camera", 0}, {"name", "wide"}, {"translation", {0, 0, 9}}});
  d["nodes"].push_back({{"camera", 1}, {"name", "door"}, {"translation", {0, 1, 9}}});
  const Scene s = load(d);
  for (const char* name : {"lamp", "ceiling"}) EXPECT_EQ(light_named(s, name).kind, LightKind::point);
  for (const char* name : {"sun", "sky"}) EXPECT_EQ(light_named(s, name).kind, LightKind::directional);
  EXPECT_EQ(camera_named(s, "wide").eye_m, glm::dvec3(0, 0, 9));
  EXPECT_EQ(camera_named(s, "door").eye_m, glm::dvec3(0, 1, 9));
  EXPECT_EQ(s.light.kind, LightKind::point);
  EXPECT_EQ(s.camera.eye_m, glm::dvec3(0, 0, 9));
  const auto fault = [&](const json& document, const char* light) {
    return refusal_of(ErrorKind::usage, [&] { light_named(load(document), light); });
  };
  EXPECT_EQ(fault(d, "sin"),
            "scene has no light with the name 'sin'; did you mean 'sun'?; it has ceiling, lamp, sky, sun");
  // A later light that a map cannot cover, and two of one name.
  d["extensions"]["KHR_lights_punctual"]["lights"][1] = {
      {"type", "spot"}, {"name", "sun"}, {"spot", {{"outerConeAngle", 1.57}}}};
  EXPECT_NE(fault(d, "sun").find("a shadow map can cover"), std::string::npos) << fault(d, "sun");
  EXPECT_EQ(fault(d, "lamp"), "");
  d["nodes"][2]["name"] = "ceiling";
  EXPECT_NE(fault(d, "ceiling").find("two lights"), std::string::npos);
  EXPECT_EQ(fault(square(), "sun"), "scene has no light with the name 'sun'; it has no named light");
}

TEST_F(GltfView, SpotStandsAndLooksAsItsNode) {
  // The translation, rotation and scale of the parent place the light. The light itself has no scale.
  json d = with_lights({{{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}, {"range", 2}}},
                       {{"translation", {1, 2, 3}}, {"scale", {2, 2, 2}}, {"rotation", looks_down}});
  d["nodes"][1]["children"] = {2};
  d["nodes"].push_back({{"translation", {0, 0, 4}}});
  std::swap(d["nodes"][1]["extensions"], d["nodes"][2]["extensions"]);
  d["nodes"][1].erase("extensions");
  const Scene s = load(d);
  EXPECT_EQ(s.light.kind, LightKind::spot);
  expect_near(s.light.position_m, {1, 2 + 2 * 4, 3});  // the child's +Z is the world's +Y
  expect_near(travels(s.light), {0, -1, 0});
  expect_near(s.light.target_m, {1, 0.5, 3});  // level with the square's middle
  EXPECT_NEAR(s.light.cone_deg, glm::degrees(1.0), view_rounding);
  EXPECT_FALSE(s.map);
}

TEST_F(GltfView, SpotsAreNinetyDegreesWideWhenTheyDoNotSay) {
  const Scene s = load(with_lights({{{"type", "spot"}, {"spot", json::object()}}}, {{"translation", {0.5, 0.5, 3}}}));
  EXPECT_EQ(s.light.cone_deg, 90);
  expect_near(travels(s.light), {0, 0, -1});
  // A light that is turned away from the scene still has a direction.
  const json away = {{"translation", {0.5, 0.5, -3}}};
  expect_near(load(with_lights({{{"type", "spot"}, {"spot", json::object()}}}, away)).light.target_m, {0.5, 0.5, -4});
}

TEST_F(GltfView, PointLightStandsAtItsNode) {
  const Scene s = load(with_lights({{{"type", "point"}, {"range", 1}}}, {{"translation", {0.5, 4.5, 0}}}));
  EXPECT_EQ(s.light.kind, LightKind::point);
  EXPECT_EQ(s.light.position_m, glm::dvec3(0.5, 4.5, 0));
  EXPECT_EQ(s.light.radius_m, 0);
  // From the exact middle of the scene there is no direction to the middle, but the light still has a target.
  const Scene inside = load(with_lights({{{"type", "point"}}}, {{"translation", {0.5, 0.5, 0}}}));
  EXPECT_EQ(inside.light.position_m, glm::dvec3(0.5, 0.5, 0));
}

TEST_F(GltfView, FittedWhereTheFileHasNone) {
  const Scene s = load(square());
  expect_near(s.camera.eye_m, fit_camera(s).eye_m);
  expect_near(s.light.position_m, fit_light(s).position_m);
}

Scene cloud(const glm::vec3& middle, float size) {
  Scene s;
  for (uint32_t i = 0; i < 64; ++i) {
    const auto turn = static_cast<float>(i);
    s.positions.push_back(middle + size * glm::vec3(std::sin(turn), 0.3f * std::cos(3 * turn), std::sin(2 * turn + 1)));
  }
  s.triangles = {{0, 1, 2}};
  return s;
}

TEST(Fit, TheBoundingSphereHoldsEveryPosition) {
  const Scene s = cloud({100, -5, 3}, 4);
  const Sphere sphere = bounding_sphere(s);
  double furthest = 0;
  for (const glm::vec3& p : s.positions) furthest = std::max(furthest, glm::distance(sphere.centre_m, glm::dvec3(p)));
  EXPECT_EQ(furthest, sphere.radius_m);
  EXPECT_LT(sphere.radius_m, 4 * std::sqrt(3.0));
}

TEST(Fit, TheCameraSeesTheWholeSphere) {
  for (const auto& [middle, size] :
       {std::pair{glm::vec3(0), 1.0f}, {glm::vec3(100, -5, 3), 1e-3f}, {glm::vec3(-7e4, 1, 0), 1e4f}}) {
    const Scene s = cloud(middle, size);
    const Sphere sphere = bounding_sphere(s);
    const Camera c = fit_camera(s);
    const glm::dvec3 forward = glm::normalize(c.target_m - c.eye_m);
    EXPECT_LT(forward.y, -0.1) << "the camera looks from above";
    EXPECT_GT(forward.y, -0.7) << "but not steeply";
    const double distance = glm::distance(c.eye_m, sphere.centre_m);
    EXPECT_GT(glm::radians(c.fov_y_deg / 2), std::asin(sphere.radius_m / distance));
    EXPECT_FALSE(c.near_m || c.far_m) << "near and far are fitted later, to the final place of the camera";
    // Every position inside the clip volume of a square picture.
    const glm::dmat4 clip =
        glm::perspective(glm::radians(c.fov_y_deg), 1.0, distance - sphere.radius_m, distance + sphere.radius_m) *
        glm::lookAt(c.eye_m, c.target_m, c.up);
    for (const glm::vec3& p : s.positions) {
      const glm::dvec4 q = clip * glm::dvec4(glm::dvec3(p), 1);
      EXPECT_TRUE(std::abs(q.x) < q.w && std::abs(q.y) < q.w && std::abs(q.z) < q.w);
    }
  }
}

TEST(Fit, TheLightIsAboveAndOutside) {
  const Scene s = cloud({100, -5, 3}, 4);
  const Sphere sphere = bounding_sphere(s);
  const Light light = fit_light(s);
  EXPECT_EQ(light.target_m, sphere.centre_m);
  EXPECT_GT(glm::distance(light.position_m, sphere.centre_m), 1.5 * sphere.radius_m);
  EXPECT_GT(light.position_m.y, sphere.centre_m.y + sphere.radius_m);
}

TEST(Fit, ASceneOfOnePointIsStillSeenFromOutside) {
  Scene s;
  s.positions = {{3, 4, 5}};
  const Camera c = fit_camera(s);
  EXPECT_GT(glm::distance(c.eye_m, c.target_m), 0);
  EXPECT_GT(glm::distance(fit_light(s).position_m, fit_light(s).target_m), 0);
}

}  // namespace
}  // namespace noonmark::test
