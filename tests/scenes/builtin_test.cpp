// The built-in scenes are what their comments say, and the shapes they are made of are sound.
#include "scenes/builtin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <map>
#include <set>
#include <tuple>

#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/library.h"
#include "scenes/shapes.h"
#include "tests/support/builtin_scenes.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

using namespace test;

double signed_volume(const Scene& scene, const Part& part) {
  double sum = 0;
  for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
    sum += glm::dot(corner(scene, t, 0), glm::cross(corner(scene, t, 1), corner(scene, t, 2))) / 6;
  return sum;
}

// In a closed part every edge is used once in each direction.
bool closed(const Scene& scene, const Part& part) {
  using Key = std::tuple<float, float, float>;
  const auto key = [](glm::vec3 p) { return Key(p.x, p.y, p.z); };
  std::map<std::pair<Key, Key>, int> runs;
  for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
    for (int e = 0; e < 3; ++e)
      ++runs[{key(scene.positions[scene.triangles[t][e]]), key(scene.positions[scene.triangles[t][(e + 1) % 3]])}];
  return std::all_of(runs.begin(), runs.end(), [&](const auto& run) {
    const auto back = runs.find({run.first.second, run.first.first});
    return run.second == 1 && back != runs.end() && back->second == 1;
  });
}

TEST(BuiltinScenes, ReadTheSettingsThatTheirRowsName) {
  const std::pair<std::string_view, double SceneSettings::*> settings[] = {
      {"scene.theta_deg", &SceneSettings::theta_deg},
      {"scene.phi_deg", &SceneSettings::phi_deg},
      {"scene.thickness_m", &SceneSettings::thickness_m},
      {"scene.height_m", &SceneSettings::height_m},
      {"scene.gap_m", &SceneSettings::gap_m},
      {"scene.step_m", &SceneSettings::step_m},
      {"scene.offset_m", &SceneSettings::offset_m}};
  for (const BuiltinScene& scene : builtin_scenes())
    for (const auto& [name, member] : settings) {
      SceneSettings other{.name = std::string(scene.name), .plates = 3};  // an offset needs two upper plates
      const Scene before = scene.make(other);
      other.*member += 0.125;
      const bool named = std::find(scene.reads.begin(), scene.reads.end(), name) != scene.reads.end();
      EXPECT_EQ(scene.make(other).positions != before.positions, named) << scene.name << " and " << name;
    }
  for (const BuiltinScene& scene : builtin_scenes()) {
    const bool named = std::find(scene.reads.begin(), scene.reads.end(), "scene.plates") != scene.reads.end();
    EXPECT_EQ(scene.make({.plates = 5}).parts.size() != scene.make({.plates = 4}).parts.size(), named) << scene.name;
  }
}

TEST(BuiltinScenes, AreFiniteAndInRange) {
  for (const Scene& scene : all_scenes()) {
    EXPECT_FALSE(scene.triangles.empty()) << scene.name;
    for (const glm::vec3& p : scene.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << scene.name;
    uint32_t next = 0;  // parts follow one another and leave no triangle out
    for (const Part& part : scene.parts) {
      EXPECT_EQ(part.first_triangle, next) << scene.name << ' ' << part.name;
      EXPECT_GT(part.triangle_count, 0u);
      EXPECT_FALSE(part.name.empty());
      next += part.triangle_count;
    }
    EXPECT_EQ(next, scene.triangles.size()) << scene.name;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
      for (int i = 0; i < 3; ++i) ASSERT_LT(scene.triangles[t][i], scene.positions.size()) << scene.name;
      const double area2 =
          glm::length(glm::cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0)));
      ASSERT_GT(area2, 1e-8) << scene.name << ": a sliver, triangle " << t;
    }
  }
}

TEST(BuiltinScenes, SolidsAreClosedAndTurnedOutward) {
  const std::set<std::string> open = {"floor",  "plane", "bowl",       "wall piece", "pane",
                                      "reveal", "frond", "front wall", "ground",     "rising face"};
  std::set<std::string> met;
  for (const Scene& scene : all_scenes()) {
    for (const Part& part : scene.parts) {
      EXPECT_EQ(closed(scene, part), !open.contains(part.name)) << scene.name << ' ' << part.name;
      if (open.contains(part.name)) {
        met.insert(part.name);
        continue;
      }
      // A room is seen from inside.
      const double outward = part.name == "room" ? -1 : 1;
      EXPECT_GT(outward * signed_volume(scene, part), 0) << scene.name << ' ' << part.name;
    }
  }
  EXPECT_EQ(met, open) << "a name that no part has";
}

// Some triangles of every scene are in the picture. All parts but one are in it, except in `pillars`. The middle of the
// picture shows a surface between near and far.
TEST(BuiltinScenes, TheCameraSeesThem) {
  for (const Scene& scene : all_scenes()) {
    const Camera camera = effective_camera(scene, {});
    const CameraFrame frame = make_camera_frame(camera, 1280, 720);
    size_t seen = 0, parts_seen = 0;
    for (const Part& part : scene.parts) {
      size_t of_part = 0;
      for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
        const glm::dvec3 middle = (corner(scene, t, 0) + corner(scene, t, 1) + corner(scene, t, 2)) / 3.0;
        const glm::dvec4 clip = frame.clip_from_world() * glm::dvec4(middle, 1);
        of_part += clip.w > 0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w && std::abs(clip.z) < clip.w;
      }
      seen += of_part;
      parts_seen += of_part > 0;
    }
    EXPECT_GT(seen, 0u) << scene.name;
    if (scene.name != "pillars") {
      EXPECT_GE(parts_seen + 1, scene.parts.size()) << scene.name << ": parts out of the picture";
    }

    // The middle of the picture: a ray that meets some triangle between near and far.
    const Ray ray = frame.pixel_ray(640, 360, 1280, 720);
    bool met = false;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const glm::dvec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2), d = ray.direction;
      const double s0 = glm::dot(d, glm::cross(a - ray.origin, b - ray.origin)),
                   s1 = glm::dot(d, glm::cross(b - ray.origin, c - ray.origin)),
                   s2 = glm::dot(d, glm::cross(c - ray.origin, a - ray.origin));
      if (!((s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0))) continue;
      const glm::dvec3 n = glm::cross(b - a, c - a);
      const double along = glm::dot(n, a - ray.origin) / glm::dot(n, d);
      met |= along > camera.near_m && along < camera.far_m;
    }
    EXPECT_TRUE(met) << scene.name;
  }
}

TEST(BuiltinScenes, CubeRoomIsTheTutorialsScene) {
  const std::vector<Scene> scenes = all_scenes();
  const Scene& room = named(scenes, "cube-room");
  ASSERT_EQ(room.parts.size(), 4u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(corner(room, 0, i).y, -0.5);
  glm::dvec3 reach(0), middle[4] = {};
  for (uint32_t t = 0; t < 2; ++t)
    for (int i = 0; i < 3; ++i) reach = glm::max(reach, glm::abs(corner(room, t, i)));
  EXPECT_EQ(reach.x, 25);
  EXPECT_EQ(reach.z, 25);
  const double volumes[] = {0, 1, 1, 0.125};
  const glm::dvec3 places[] = {{}, {0, 1.5, 0}, {2, 0, 1}, {-1, 0, 2}};
  for (size_t i = 1; i < 4; ++i) {
    const Part& part = room.parts[i];
    EXPECT_NEAR(signed_volume(room, part), volumes[i], 1e-6);
    std::set<uint32_t> corners;
    for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
      for (int k = 0; k < 3; ++k) corners.insert(room.triangles[t][k]);
    EXPECT_EQ(corners.size(), 8u);
    for (uint32_t c : corners) middle[i] += glm::dvec3(room.positions[c]) / 8.0;
    EXPECT_LT(glm::length(middle[i] - places[i]), 1e-6);
  }
  // The last is turned by 60 degrees about (1, 0, 1): the edge along x becomes this (Rodrigues).
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 0, 1)), x(1, 0, 0);
  const glm::dvec3 turned = 0.5 * x + std::sqrt(0.75) * glm::cross(axis, x) + 0.5 * glm::dot(axis, x) * axis;
  const uint32_t first = room.triangles[room.parts[3].first_triangle].x;
  EXPECT_LT(glm::length(glm::dvec3(room.positions[first + 1]) - glm::dvec3(room.positions[first]) - 0.5 * turned),
            1e-6);
}

TEST(BuiltinScenes, ThePointRoomIsTheTutorialsRoom) {
  const Scene scene = make_scene({.name = "point-room"});
  ASSERT_EQ(scene.parts.size(), 6u);
  EXPECT_LT(glm::length(scene.light.position_m), 0.02);
  EXPECT_NEAR(signed_volume(scene, scene.parts[0]), -1000, 1e-9);
  const double sides[] = {1, 1.5, 1, 1, 1.5};
  for (size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(signed_volume(scene, scene.parts[i + 1]), std::pow(sides[i], 3), 1e-5) << i;
  EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(scene.camera.eye_m), glm::dvec3(5)))) << "the camera is inside";
}

// Scenes for several maps along one view. From 2 m on each doubling of the distance holds something that casts a
// shadow, so that every map of a split has shadows.
TEST(BuiltinScenes, TheWalksReachFromTheEyeToEightyMetres) {
  struct Walk {
    const char* name;
    double nearest_m;
    size_t triangles;
    glm::dvec3 low, high;  // of the scene's box; those of the hills within 0.1 m
  };
  for (const auto& [name, nearest_m, triangles, low, high] :
       {Walk{"street", 0.3, 2 + 77 * 12, {-12, 0, -78}, {12, 6.5, 2}},
        Walk{"hills-walk", 2.9, 36 * 84 * 2 + 24 * 12, {-18, -0.8, -80}, {18, 4.4, 4}}}) {
    const Scene scene = make_scene({.name = name});
    EXPECT_EQ(scene.triangles.size(), triangles) << name;
    glm::vec3 least(1e9f), most(-1e9f);
    for (const glm::vec3& p : scene.positions) least = glm::min(least, p), most = glm::max(most, p);
    for (const int axis : {0, 1, 2}) {
      const double off_m = axis == 1 && name != std::string("street") ? 0.1 : 0;
      EXPECT_NEAR(least[axis], low[axis], off_m) << name << ' ' << axis;
      EXPECT_NEAR(most[axis], high[axis], off_m) << name << ' ' << axis;
    }
    const Camera camera = effective_camera(scene, {});
    EXPECT_LT(*camera.near_m, nearest_m) << name;
    EXPECT_GT(*camera.far_m, 75) << name;
    EXPECT_LT(*camera.far_m, 100) << name;
    const CameraFrame frame = make_camera_frame(camera, 1280, 720);
    std::set<int> octaves;  // of the distances of casters that are in the picture
    for (const Part& part : scene.parts) {
      if (part.name == "floor" || part.name == "ground") continue;
      for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
        const glm::dvec3 p = frame.in_axes((corner(scene, t, 0) + corner(scene, t, 1) + corner(scene, t, 2)) / 3.0);
        if (p.z > 0 && std::abs(p.x) < frame.half_width * p.z) octaves.insert(static_cast<int>(std::log2(p.z)));
      }
    }
    for (const int octave : {1, 2, 3, 4, 5}) EXPECT_TRUE(octaves.contains(octave)) << name << ": 2^" << octave << " m";
    // The walkers stand on the ground: the eye is 1.6 m above what is below it.
    double below = -1e9;
    for (uint32_t t = 0; t < scene.parts[0].triangle_count; ++t) {
      const glm::dvec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2),
                       n = glm::cross(b - a, c - a);
      const auto left_of = [&](glm::dvec3 from, glm::dvec3 to) {
        return glm::cross(to - from, camera.eye_m - from).y >= 0;
      };
      if (left_of(a, b) && left_of(b, c) && left_of(c, a))
        below = a.y - (n.x * (camera.eye_m.x - a.x) + n.z * (camera.eye_m.z - a.z)) / n.y;
    }
    EXPECT_NEAR(camera.eye_m.y - below, 1.6, 0.03) << name << ": of a mesh of 1 m";
  }
}

// The corners of the box of a part.
std::pair<glm::dvec3, glm::dvec3> box_of(const Scene& scene, const Part& part) {
  glm::dvec3 low(1e9), high(-1e9);
  for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
    for (int i = 0; i < 3; ++i) low = glm::min(low, corner(scene, t, i)), high = glm::max(high, corner(scene, t, i));
  return {low, high};
}

// How many parts above the floor the light from above meets at (x, z).
int parts_above(const Scene& scene, double x, double z) {
  return static_cast<int>(std::count_if(scene.parts.begin() + 1, scene.parts.end(), [&](const Part& part) {
    const auto [low, high] = box_of(scene, part);
    return x > low.x && x < high.x && z > low.z && z < high.z;
  }));
}

TEST(BuiltinScenes, LayersEndOneAfterTheOtherAboveTheLowest) {
  const Scene scene = make_scene({.name = "layers", .plates = 4, .gap_m = 0.25, .step_m = 0.125, .offset_m = 0.0625});
  ASSERT_EQ(scene.parts.size(), 5u);
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(box_of(scene, scene.parts[static_cast<size_t>(i) + 1]).second.y, 0.25 + 0.125 * i) << "its lit face";
  EXPECT_EQ(parts_above(scene, -0.01, 0), 1) << "the lowest plate covers the edges of the others";
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(parts_above(scene, 0.0625 * i - 0.001, 0), 1 + i) << i;
    EXPECT_EQ(parts_above(scene, 0.0625 * i + 0.001, 0), 2 + i) << i;
  }
  // Thin plates keep clear of each other and of the floor.
  const Scene close = make_scene({.name = "layers", .plates = 2, .gap_m = 0.004, .step_m = 0.002});
  EXPECT_GT(box_of(close, close.parts[1]).first.y, 0.001);
  EXPECT_GT(box_of(close, close.parts[2]).first.y, 0.0045);
}

// No light reaches the floor between two treads.
TEST(BuiltinScenes, TheTreadsOfTheStairReachUnderOneAnother) {
  const Scene scene = make_scene({.name = "stairs"});
  ASSERT_EQ(scene.parts.size(), 13u);
  for (size_t i = 2; i < scene.parts.size(); ++i) {
    const auto [low, high] = box_of(scene, scene.parts[i]);
    EXPECT_FLOAT_EQ(static_cast<float>(high.y), static_cast<float>(0.1875 * static_cast<double>(i))) << i;
    EXPECT_EQ(parts_above(scene, low.x + 0.01, 0), 2) << "the tread and the one below it, " << i;
    EXPECT_EQ(parts_above(scene, low.x + 0.2, 0), 1) << i;
  }
}

// Seen from a light straight above (u to the right along x, v along -z), the edge that faces +x at phi = 0 faces the
// azimuth phi.
TEST(BuiltinScenes, PhiTurnsThePlate) {
  const Scene still = make_scene({.name = "plate", .thickness_m = 0.02});
  for (double phi : {0.0, 20.0, 45.0, -130.0}) {
    const Scene turned = make_scene({.name = "plate", .phi_deg = phi, .thickness_m = 0.02});
    ASSERT_EQ(turned.positions.size(), still.positions.size());
    const double c = std::cos(glm::radians(phi)), s = std::sin(glm::radians(phi));
    const Part& plate = still.parts[1];
    for (uint32_t t = 0; t < still.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const glm::dvec3 p = corner(still, t, i);
        const bool moves = t >= plate.first_triangle;
        const glm::dvec3 expected = moves ? glm::dvec3(c * p.x + s * p.z, p.y, -s * p.x + c * p.z) : p;
        EXPECT_LT(glm::length(corner(turned, t, i) - expected), 1e-6) << phi;  // some roundings of floats near 1
      }
  }
}

TEST(Shapes, QuadFrontIsTowardsTheCrossProduct) {
  Scene scene;
  add_quad(scene, "quad", {1, 2, 3}, {2, 0, 0}, {0, 0, -3});
  ASSERT_EQ(scene.triangles.size(), 2u);
  for (uint32_t t = 0; t < 2; ++t)
    EXPECT_EQ(glm::cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0)),
              glm::dvec3(0, 6, 0));
  EXPECT_EQ(scene.positions.size(), 4u);
}

TEST(Shapes, BoxFromCornersIsThatBox) {
  Scene scene;
  add_box(scene, "box", {-1, 2, 3}, {2, 2.5, 7});
  EXPECT_TRUE(closed(scene, scene.parts[0]));
  EXPECT_NEAR(signed_volume(scene, scene.parts[0]), 3 * 0.5 * 4, 1e-6);
  for (const glm::vec3& p : scene.positions) {
    EXPECT_TRUE(p.x == -1 || p.x == 2);
    EXPECT_TRUE(p.y == 2 || p.y == 2.5f);
    EXPECT_TRUE(p.z == 3 || p.z == 7);
  }
}

// A name of a file that lies beside is offered.
TEST(BuiltinScenes, AMissingOneNamesTheFileOfThatName) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(testing::TempDir());
  std::filesystem::create_directories("Lamp");
  const auto message = [] {
    std::string said;
    kind_thrown([] { make_scene({.name = "Lamp"}); }, &said);
    return said;
  };
  EXPECT_EQ(message().find("did you mean 'Lamp"), std::string::npos) << message();
  std::ofstream("Lamp/Lamp.glb") << "x";
  EXPECT_NE(message().find("did you mean 'Lamp/Lamp.glb'?"), std::string::npos) << message();
  std::ofstream("Lamp.toml") << "x";
  EXPECT_NE(message().find("did you mean 'Lamp.toml'?"), std::string::npos) << message();
  std::filesystem::remove_all("Lamp");
  std::filesystem::remove("Lamp.toml");
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace noonmark
