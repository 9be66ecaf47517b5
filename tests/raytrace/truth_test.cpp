// R1, the hard truth, against brute force in double, at random receivers on every surface.
#include <gtest/gtest.h>

#include "base/error.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "scenes/gltf/gltf.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

struct Count {
  int facing = 0, lit = 0, ambiguous = 0, wrong = 0;
};

// within_m: a disagreement does not count if the receiver's brute-force verdict changes within this distance in the
// light's plane.
Count compare_with_brute_force(const Scene& scene, bool facing_light, int receivers_wanted, double within_m = 0) {
  const LightFrame frame = frame_of(scene);
  const LightBins brute(scene, frame);
  const ReceiverImage receivers =
      random_receivers(scene, frame.direction_to_light(), facing_light, receivers_wanted, 1);
  const Tracer tracer(scene);
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
  Count count;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (!truth.facing[i]) continue;
    ++count.facing;
    count.lit += truth.lit[i];
    count.ambiguous += truth.ambiguous[i];
    if (truth.ambiguous[i]) continue;
    const bool lit = !brute.occluded(receivers.position[i], receivers.primitive[i]);
    if (lit == (truth.lit[i] != 0)) continue;
    // By brute force the receiver may be dark only because of a face of the same plane, whose vertices rounding has
    // moved. The tracer has it lit, which is right.
    bool undecided =
        !lit && !brute.occluded(receivers.position[i], receivers.primitive[i], 0x1p-22 * largest_coordinate(scene));
    for (int k = 0; k < 16 && within_m > 0; ++k) {
      const double turn = glm::radians(45.0 * k), reach = within_m * (k < 8 ? 1 : 0.5);
      const glm::dvec3 beside = std::cos(turn) * frame.right + std::sin(turn) * frame.up;
      undecided |= lit == brute.occluded(glm::dvec3(receivers.position[i]) + reach * beside, receivers.primitive[i]);
    }
    if (!undecided && ++count.wrong <= 5) {
      const glm::vec3 p = receivers.position[i];
      ADD_FAILURE() << scene.name << ": receiver " << i << " on triangle " << receivers.primitive[i] << " at " << p.x
                    << ' ' << p.y << ' ' << p.z << " is " << (lit ? "lit" : "dark") << ", not "
                    << (truth.lit[i] ? "lit" : "dark");
    }
  }
  testing::Test::RecordProperty(scene.name + ".facing", count.facing);
  testing::Test::RecordProperty(scene.name + ".lit", count.lit);
  testing::Test::RecordProperty(scene.name + ".ambiguous", count.ambiguous);
  return count;
}

// Fewer than one receiver in a thousand may be ambiguous.
void expect_sure(const Count& count, int facing_wanted) {
  EXPECT_GE(count.facing, facing_wanted);
  EXPECT_EQ(count.wrong, 0);
  EXPECT_LT(count.ambiguous, count.facing / 1000.0);
}

class HardTruth : public testing::TestWithParam<const char*> {};

TEST_P(HardTruth, AgreesWithBruteForce) {
  Scene scene = builtin(GetParam());
  expect_sure(compare_with_brute_force(scene, false, 20000), 19990);
  scene.name += ".both_sides";  // also what a viewer inside a solid sees
  expect_sure(compare_with_brute_force(scene, true, 20000), 19990);
}

// At 1 km floats are 2^-14 m apart. The rounded scene is another one, and the truth is that of the rounded positions.
// Smooth surfaces have many dents of that size there; the five places of a receiver's verdict cannot find all of them.
TEST_P(HardTruth, AgreesWithBruteForceFarFromTheOrigin) {
  Scene scene = moved(builtin(GetParam()), {1000, -300, 700});
  scene.name += ".at_1_km";
  const double float_step_m = 0x1p-14;
  const Count count = compare_with_brute_force(scene, false, 20000, 2 * float_step_m);
  EXPECT_GE(count.facing, 19900);
  EXPECT_EQ(count.wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Builtin, HardTruth,
                         testing::Values("cube-room", "plane", "wall", "plate", "pillars", "sphere", "bowl", "fence"),
                         [](const auto& given) {
                           std::string name = given.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

class ModelTruth : public testing::TestWithParam<const char*> {};

TEST_P(ModelTruth, AgreesWithBruteForce) {
  const std::string path = shared_model(GetParam());
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  Scene scene = load_gltf(path);
  scene.name = GetParam();
  expect_sure(compare_with_brute_force(scene, false, 20000), 19990);
  scene.name += ".both_sides";
  expect_sure(compare_with_brute_force(scene, true, 20000), 19990);
}

INSTANTIATE_TEST_SUITE_P(Shared, ModelTruth, testing::Values("FlightHelmet", "Lantern"),
                         [](const auto& given) { return given.param; });

// Law 8: nothing shades the side of a lone convex solid that faces the light, however grazing the light is and wherever
// the solid stands.
TEST(HardTruthLaws, ConvexSolidsAreLitWhereTheyFace) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in(-1, 1);
  std::vector<Scene> solids = {builtin("sphere")};
  for (int i = 0; i < 30; ++i) {
    Scene box;
    glm::dmat4 placed =
        glm::translate(glm::dmat4(1), glm::dvec3(in(random), in(random), in(random)) * (i % 3 == 0 ? 1.0 : 5.0));
    placed = glm::rotate(placed, 3 * in(random), glm::normalize(glm::dvec3(in(random), in(random), in(random))));
    add_box(box, "box", {0.05 + std::abs(in(random)), 0.05 + std::abs(in(random)), 0.05 + std::abs(in(random))},
            placed);
    box.light = {.position_m = {in(random), 2, in(random)}, .target_m = {0, 0, 0}};
    solids.push_back(box);
  }
  for (const Scene& solid : solids) {
    const LightFrame frame = frame_of(solid);
    const Tracer tracer(solid);
    const ReceiverImage receivers = random_receivers(solid, frame.direction_to_light(), false, 5000, 2);
    const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
    for (size_t i = 0; i < receivers.primitive.size(); ++i) ASSERT_TRUE(!truth.facing[i] || truth.lit[i]) << i;
  }
}

// The bowl under its light straight above is concave, and all of it is lit.
TEST(HardTruthLaws, BowlIsLitEverywhere) {
  const Scene bowl = builtin("bowl");
  const LightFrame frame = frame_of(bowl);
  const ReceiverImage receivers = random_receivers(bowl, frame.direction_to_light(), false, 20000, 3);
  const ReceiverTruth truth = Tracer(bowl).receiver_truth(receivers, frame, {});
  for (size_t i = 0; i < receivers.primitive.size(); ++i) ASSERT_TRUE(!truth.facing[i] || truth.lit[i]) << i;
}

// Receivers exactly on vertices and edges of solids, where a ray most easily misses its surface or hits a wrong one.
// (Rounding to float leaves dents of a float's size in the sphere; receivers that these shade are ambiguous.)
TEST(HardTruthLaws, VerticesAndEdgesOfConvexSolidsAreLit) {
  const Scene sphere = builtin("sphere");
  const LightFrame frame = frame_of(sphere);
  std::vector<Placed> points;
  for (uint32_t t = 0; t < sphere.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 a = sphere.positions[sphere.triangles[t][i]],
                       b = sphere.positions[sphere.triangles[t][(i + 1) % 3]];
      points.push_back({a, t});
      points.push_back({(a + b) / 2.0, t});
    }
  }
  const ReceiverImage receivers = receivers_at(sphere, points, frame.direction_to_light(), false);
  const ReceiverTruth truth = Tracer(sphere).receiver_truth(receivers, frame, {});
  int facing = 0, dark = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    facing += truth.facing[i];
    dark += truth.facing[i] && !truth.lit[i] && !truth.ambiguous[i];
  }
  EXPECT_GT(facing, 40000);
  EXPECT_EQ(dark, 0);
}

// If the same faces are present twice, as other triangles, they must not shade themselves. Exporters write two-sided
// surfaces in this way.
TEST(HardTruthLaws, DuplicatedFacesDoNotShadeThemselves) {
  Scene scene = builtin("sphere");
  const size_t count = scene.triangles.size();
  for (uint32_t t = 0; t < count; ++t) {
    const glm::uvec3 v = scene.triangles[t];  // its corners rotated, or its other side
    scene.triangles.push_back(t % 2 ? glm::uvec3(v.y, v.z, v.x) : glm::uvec3(v.x, v.z, v.y));
  }
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(builtin("sphere"), frame.direction_to_light(), false, 20000, 4);
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, {});
  int facing = 0, dark = 0;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    facing += truth.facing[i];
    dark += truth.facing[i] && !truth.lit[i] && !truth.ambiguous[i];
  }
  EXPECT_GT(facing, 10000);
  EXPECT_EQ(dark, 0);
}

TEST(HardTruthLaws, BackgroundAndAttachedReceiversAreNotFacing) {
  const Scene sphere = builtin("sphere");
  const LightFrame frame = frame_of(sphere);
  ReceiverImage receivers = random_receivers(sphere, -frame.direction_to_light(), false, 100, 5);  // the far side
  receivers.primitive[7] = no_primitive;
  const ReceiverTruth truth = Tracer(sphere).receiver_truth(receivers, frame, sun(0.5));
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(truth.facing[i], 0);
    EXPECT_EQ(truth.lit[i], 0);
    EXPECT_EQ(truth.ambiguous[i], 0);
    EXPECT_EQ(truth.soft[i], 0);
  }
}

// A receiver exactly at the shadow's edge is ambiguous. One that is further away than the float error is not.
TEST(HardTruthLaws, OnlyWhatGrazesASilhouetteIsAmbiguous) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  add_quad(scene, "roof", {-4, 1, -4}, {0, 0, 8}, {4, 0, 0});  // x from -4 to 0
  light_from_above(scene);
  const LightFrame frame = frame_of(scene);
  std::vector<Placed> points;
  for (double x : {0.0, 1e-8, -1e-8, 1e-4, -1e-4, 1.0, -1.0}) points.push_back({{x, 0, 0.3}, 0});
  for (Placed& point : points) point.primitive = point.p.x > 0.3 ? 1 : 0;
  const LightBins brute(scene, frame);
  for (Placed& point : points) {  // which of the floor's two triangles
    uint32_t found = no_primitive;
    brute.each_at(glm::dvec2(frame.to_light(point.p)), [&](uint32_t t, double) { found = t < 2 ? t : found; });
    point.primitive = found;
  }
  const ReceiverImage receivers = receivers_at(scene, points, frame.direction_to_light(), false);
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, {});
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(truth.ambiguous[i], 1) << points[i].p.x;
  for (size_t i = 3; i < points.size(); ++i) {
    EXPECT_EQ(truth.ambiguous[i], 0) << points[i].p.x;
    EXPECT_EQ(truth.lit[i], points[i].p.x > 0) << points[i].p.x;
  }
}

// A sheet without holes, and rays at its vertices and at the middles of its edges. Without the flag ROBUST, some
// percent of the rays pass through Embree's scene.
TEST(HardTruthLaws, RaysDoNotLeakThroughVerticesAndEdges) {
  const int n = 150;
  Scene scene;
  add_surface(scene, "sheet", n, n, false, [](double s, double t) {
    return glm::dvec3(6 * s - 3, 0.1 * std::sin(20 * s) * std::cos(15 * t), 3 - 6 * t);
  });
  scene.light = {.position_m = {-2, 4, -1}, .target_m = {0, 0, 0}};
  const LightFrame frame = frame_of(scene);
  const LightView view(scene, frame);
  const EmbreeDevice device;
  const EmbreeScene embree(device, scene);
  int rays = 0, at_vertices = 0, at_edges = 0;
  for (int j = 1; j < n - 1; ++j) {
    for (int i = 1; i < n - 1; ++i) {
      const size_t v = static_cast<size_t>(j * (n + 1) + i);
      const glm::dvec2 a(frame.to_light(scene.positions[v]));
      for (size_t other : {v, v + 1, v + n + 1, v + n + 2}) {
        const glm::dvec2 b(frame.to_light(scene.positions[other]));
        ++rays;
        (other == v ? at_vertices : at_edges) +=
            embree.first_hit(view.ray(glm::dvec3((a + b) / 2.0, 1))) == no_primitive;
      }
    }
  }
  RecordProperty("rays", rays);
  RecordProperty("leaks_at_vertices", at_vertices);
  RecordProperty("leaks_at_edges", at_edges);
  EXPECT_EQ(at_edges, 0);
  EXPECT_LE(at_vertices, rays / 4 / 100);  // seen: 127 of 21,904; without ROBUST 4,191, and 4,962 at edges
}

TEST(HardTruthLaws, EmptyAndOneTriangleScenesAndNoReceivers) {
  Scene one;
  one.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  one.triangles = {{0, 1, 2}};
  light_from_above(one);
  const LightFrame frame = frame_of(one);
  const Tracer tracer(one);
  const ReceiverImage receivers = random_receivers(one, frame.direction_to_light(), false, 100, 1);
  StageTime hard, soft;
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {}, &hard, &soft);
  for (size_t i = 0; i < 100; ++i) EXPECT_TRUE(truth.facing[i] && truth.lit[i] && truth.soft[i] == 1);
  EXPECT_LE(hard.rays, 500u);  // five for each receiver that the cells do not answer
  EXPECT_EQ(soft.rays, 0u);

  const ReceiverImage background = receivers_at(one, {}, {0, 1, 0}, true);
  EXPECT_EQ(tracer.receiver_truth(background, frame, {}).lit.size(), 0u);

  Scene empty;
  light_from_above(empty);
  empty.map = MapVolume{};
  const Tracer nothing(empty);
  ReceiverImage sky = receivers_at(one, {{{0.1, 0, 0.1}, 0}}, {0, 1, 0}, true);
  sky.primitive[0] = no_primitive;
  const LightFrame empty_frame = frame_of(empty);
  const ReceiverTruth none = nothing.receiver_truth(sky, empty_frame, {});
  EXPECT_EQ(none.facing[0], 0);
  const LookupTruth lookup = nothing.lookup_truth(sky, none, probe_of(sky, empty_frame, box(3)), empty_frame, {});
  for (float depth : lookup.exact_map.depth) EXPECT_EQ(depth, 1);
}

}  // namespace
}  // namespace noonmark::raytrace
