// The metrics for which laws give closed forms, compared with values that were calculated by hand.
#include "compare/ladder/law_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <set>
#include <string>

#include "scenes/camera_frame.h"

namespace noonmark {
namespace {

// A tilted plane through the origin. The light is vertically above it (u along x, v along -z), and the camera sees it
// from the side. Every pixel is a lit receiver.
struct Sight {
  Sight(Camera view, glm::dvec3 plane_normal, int width, int height) : camera(view), normal(plane_normal) {
    ladder = empty_ladder(width, height);
    for (Ladder::RungImage& rung : ladder.rungs) rung.lit = Image<float>(width, height, 1);
    ladder.cause = Image<uint8_t>(width, height, 0);
    ladder.flags = Image<uint8_t>(width, height, flag_facing);
    receivers = {Image<glm::vec3>(width, height), Image<glm::vec3>(width, height, glm::vec3(normal)),
                 Image<uint32_t>(width, height, 0)};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) receivers.position.at(x, y) = glm::vec3(seen(x, y, width, height));
    frame.right = {1, 0, 0};
    frame.up = {0, 0, -1};
    frame.forward = {0, -1, 0};
    frame.extent_m = 8;
    frame.resolution = frame.rows = 64;
    frame.near_m = -3;
    frame.far_m = 7;
  }
  glm::dvec3 seen(double x, double y, int width, int height) const {
    // pixel_ray takes whole pixels. The ray of any other place in the picture is computed from two of them.
    const CameraFrame view = make_camera_frame(camera, width, height);
    const auto blend = [&](auto member) {
      const glm::dvec3 o = view.pixel_ray(0, 0, width, height).*member;
      const glm::dvec3 right = view.pixel_ray(1, 0, width, height).*member - o;
      const glm::dvec3 down = view.pixel_ray(0, 1, width, height).*member - o;
      return o + x * right + y * down;
    };
    const glm::dvec3 origin = blend(&Ray::origin), way = blend(&Ray::direction);
    return origin - glm::dot(origin, normal) / glm::dot(way, normal) * way;
  }
  std::map<std::string, double> metrics(DepthFormat format = DepthFormat::d24, int kernel = 1) const {
    LookupProbe probe;
    probe.pattern = tap_pattern({"box", {{"size", kernel}}});
    probe.tap_reference = &tap_reference(reference);
    return measure_laws({ladder, scene, receivers, camera, frame, format, probe});
  }

  Camera camera;
  glm::dvec3 normal;
  Ladder ladder;
  Scene scene;
  ReceiverImage receivers;
  LightFrame frame;
  std::string_view reference = "own_depth";
};

const Camera perspective = {.eye_m = {3, 4, 5}, .target_m = {0.2, 0, -0.1}, .fov_y_deg = 30};
const Camera orthographic = {
    .projection = Projection::orthographic, .eye_m = {3, 4, 5}, .target_m = {0, 0, 0}, .height_m = 2};
const glm::dvec3 tilted = glm::normalize(glm::dvec3(0.4, 1, -0.3));

// The four corners of the pixel, projected to the plane and seen from above, form a quadrilateral. The shoelace formula
// gives its exact area.
TEST(LightPlaneArea, IsThatOfThePixelsOutline) {
  for (const Camera& camera : {perspective, orthographic}) {
    for (int size : {20, 200}) {
      const Sight s(camera, tilted, 2 * size, size);
      for (const glm::ivec2 at : {glm::ivec2(0, 0), glm::ivec2(size, size / 2), glm::ivec2(2 * size - 1, size - 1)}) {
        glm::dvec3 corners[4];
        int n = 0;
        for (const glm::dvec2 to : {glm::dvec2(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
          corners[n++] = s.seen(at.x + to.x, at.y + to.y, 2 * size, size);
        double twice = 0;
        for (int i = 0; i < 4; ++i)
          twice += corners[i].z * corners[(i + 1) % 4].x - corners[i].x * corners[(i + 1) % 4].z;
        const double expected = std::abs(twice) / 2;
        // The result is of first order in the size of a pixel, so its relative error is (1 / size)^2.
        EXPECT_NEAR(light_plane_areas(camera, s.frame, s.receivers).at(at.x, at.y) / expected, 1, 1.0 / (size * size));
      }
    }
  }
}

TEST(LawMetrics, SumStepsOverTheLightsPlane) {
  Sight s(perspective, tilted, 40, 20);
  s.receivers.primitive.at(0, 0) = no_primitive;
  s.ladder.flags.at(0, 0) = 0;
  const Image<double> areas = light_plane_areas(perspective, s.frame, s.receivers);
  EXPECT_EQ(areas.at(0, 0), 0);
  const auto area = [&](int x, int y) { return areas.at(x, y); };
  double all = 0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) all += area(x, y);
  const auto step = [&](Cause cause, int x, int y) -> float& { return s.ladder[cause].at(x, y); };
  step(Cause::filter, 1, 2) = -0.25f;
  step(Cause::displacement, 15, 16) = -0.375f;
  step(Cause::aliasing_dark, 3, 4) = -0.5f;
  step(Cause::aliasing_light, 5, 6) = 0.125f;
  step(Cause::acne, 7, 8) = -1;
  step(Cause::peter_panning, 9, 10) = 0.75f;
  s.ladder.flags.at(11, 12) = 0;  // faces away
  step(Cause::acne, 11, 12) = -1;
  s.ladder.flags.at(13, 14) |= flag_ambiguous;
  step(Cause::acne, 13, 14) = -1;
  const auto found = s.metrics();
  EXPECT_DOUBLE_EQ(found.at("counted_area_m2"), all - area(11, 12) - area(13, 14));
  EXPECT_DOUBLE_EQ(found.at("filter_area_m2"), 0.25 * area(1, 2));
  EXPECT_DOUBLE_EQ(found.at("displacement_area_m2"), 0.375 * area(15, 16));
  EXPECT_DOUBLE_EQ(found.at("aliasing_area_m2"), 0.5 * area(3, 4) + 0.125 * area(5, 6));
  EXPECT_DOUBLE_EQ(found.at("acne_area_m2"), area(7, 8));
  EXPECT_DOUBLE_EQ(found.at("peter_panning_area_m2"), 0.75 * area(9, 10));
}

TEST(LawMetrics, NameTheMapsLengths) {
  const Sight s(perspective, tilted, 4, 4);
  EXPECT_DOUBLE_EQ(s.metrics().at("texel_m"), 0.125);
  EXPECT_DOUBLE_EQ(s.metrics().at("map_range_m"), 10);
  EXPECT_DOUBLE_EQ(s.metrics(DepthFormat::d16).at("depth_quantum_m"), 10 / 65535.0);
  EXPECT_DOUBLE_EQ(s.metrics(DepthFormat::d24).at("depth_quantum_m"), 10 / 16777215.0);
  // The largest step between neighbouring floats in [0,1] is the last one.
  EXPECT_DOUBLE_EQ(s.metrics(DepthFormat::d32f).at("depth_quantum_m"), 10 * (1.0 - std::nextafter(1.0f, 0.0f)));
}

TEST(LawMetrics, AreThoseOfTheTable) {
  std::set<std::string> named, given;
  for (const LawMetric& metric : law_metrics) named.insert(metric.name);
  for (const auto& [name, value] : Sight(perspective, tilted, 4, 4).metrics()) given.insert(name);
  EXPECT_EQ(named, given);
}

// The plane 0.4 x + y - 0.3 z = 0 falls by 0.4 along u = x and by 0.3 along v = -z.
TEST(LawMetrics, GiveTheBiasThatTheSteepestLitReceiverNeeds) {
  Sight s(perspective, tilted, 4, 4);
  const double q = 10 / 16777215.0;
  const auto law = [&](int kernel) { return s.metrics(DepthFormat::d24, kernel).at("acne_free_bias_law_m"); };
  const double float_normal = 1e-6;  // tolerance for the last place of the normal
  EXPECT_NEAR(law(1), 0.5 * 0.125 * 0.7 + q / 2, float_normal);
  EXPECT_NEAR(law(3), 1.5 * 0.125 * 0.7 + q / 2, float_normal);
  EXPECT_NEAR(law(5), 2.5 * 0.125 * 0.7 + q / 2, float_normal);
  EXPECT_NEAR(10 * s.metrics(DepthFormat::d24, 5).at("acne_free_bias_law_depth"), law(5), float_normal);
  s.reference = "receiver_plane";  // with this reference the reach of the pattern does not matter
  EXPECT_NEAR(law(5), 0.5 * 0.125 * 0.7 + q / 2, float_normal);
  s.reference = "texel_plane";
  EXPECT_NEAR(law(5), q / 2, 1e-15);
  s.reference = "own_depth";
  s.receivers.normal.at(1, 1) = glm::vec3(glm::normalize(glm::dvec3(-1, 1, 2)));
  EXPECT_NEAR(law(1), 0.5 * 0.125 * 3 + q / 2, float_normal);
  s.ladder[Rung::truth].at(1, 1) = 0;  // it is dark, so it needs no bias
  EXPECT_NEAR(law(1), 0.5 * 0.125 * 0.7 + q / 2, float_normal);
}

// Faces that the camera does not see count. Faces that are edge-on to the light or turned away from it do not.
TEST(LawMetrics, GiveTheBiasThatTheSteepestFaceNeeds) {
  Sight s(perspective, tilted, 4, 4);
  const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const uint32_t first = static_cast<uint32_t>(s.scene.positions.size());
    s.scene.positions.insert(s.scene.positions.end(), {a, b, c});
    s.scene.triangles.push_back({first, first + 1, first + 2});
  };
  const double q = 10 / 16777215.0;
  const auto law = [&] { return s.metrics(DepthFormat::d24, 3).at("acne_free_bias_scene_law_m"); };
  EXPECT_NEAR(law(), q / 2, 1e-15);
  add({0, 0, 0}, {0, 0, 1}, {1, -3, 0});  // falls by 3 along u
  EXPECT_NEAR(law(), 1.5 * 0.125 * 3 + q / 2, 1e-12);
  add({0, 0, 0}, {0, 1, 0}, {1, 0, 0});  // edge-on
  add({0, 0, 0}, {1, 9, 0}, {0, 0, 1});  // turned away
  EXPECT_NEAR(law(), 1.5 * 0.125 * 3 + q / 2, 1e-12);
  add({0, 0, 0}, {0, 2, 1}, {1, -3, 0});  // 3 along u and 2 along v
  EXPECT_NEAR(law(), 1.5 * 0.125 * 5 + q / 2, 1e-12);
}

TEST(LawMetrics, SayNaNWhereNothingWasCountedOrIsNoNumber) {
  Sight s(perspective, tilted, 4, 4);
  s.receivers.normal.at(2, 1).x = std::numeric_limits<float>::quiet_NaN();
  s.ladder[Cause::acne].at(3, 3) = 0.5f;
  for (const char* name : {"acne_free_bias_law_m", "counted_area_m2", "acne_area_m2"})
    EXPECT_TRUE(std::isnan(s.metrics().at(name))) << name;
  for (uint8_t& flags : s.ladder.flags.pixels) flags = 0;
  for (const auto& [name, value] : s.metrics())
    EXPECT_EQ(std::isnan(value), name.ends_with("_m2") || name.starts_with("acne_free_bias_law_")) << name;
}

}  // namespace
}  // namespace noonmark
