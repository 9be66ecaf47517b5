// V(P, x) at the taps of lookups. The same surface has the same causes, however it is meshed, and there is aliasing
// only where there is a shadow edge.
#include <gtest/gtest.h>

#include "scenes/gltf/gltf.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

struct Looked {
  LightFrame frame;
  ReceiverImage receivers;
  LookupProbe probe;
  ReceiverTruth truth;
  LookupTruth lookup;
  bool exact_lit(size_t i, int tap = 0) const { return bits(i, tap) & tap_exact_lit; }
  bool texel_lit(size_t i, int tap = 0) const { return bits(i, tap) & tap_texel_lit; }
  uint8_t bits(size_t i, int tap = 0) const {
    const size_t taps = static_cast<size_t>(lookup.taps.taps_per_receiver);
    return lookup.taps.taps[i * taps + static_cast<size_t>(tap)];
  }
  glm::ivec2 texel(size_t i) const { return probe.texel(i, probe.taps() / 2); }  // of the middle tap
  double edge_distance_m(size_t i) const { return lookup.edge_distance_texels[i] * frame.texel_m(glm::dvec3(0)); }
  bool sure(size_t i) const { return truth.facing[i] && !truth.ambiguous[i]; }
};

Looked look_up(const Scene& scene, const LightFrame& frame, const ReceiverImage& receivers, int kernel) {
  const Tracer tracer(scene);
  Looked looked{
      frame, receivers, probe_of(receivers, frame, box(kernel)), tracer.receiver_truth(receivers, frame, {}), {}};
  looked.lookup = tracer.lookup_truth(receivers, looked.truth, looked.probe, frame, {});
  return looked;
}

Looked look_up(const Scene& scene, int resolution, int kernel, int count, bool facing_light = false) {
  const LightFrame frame = frame_of(scene, resolution);
  return look_up(scene, frame, random_receivers(scene, frame.direction_to_light(), facing_light, count, 7), kernel);
}

// Law 8: without an occluder every tap is lit at both its places; otherwise the program reports aliasing where there is
// none.
void expect_all_lit(const Scene& scene) {
  for (int resolution : {5, 64, 1000}) {
    for (int kernel : {1, 3}) {
      const Looked looked = look_up(scene, resolution, kernel, 5000);
      int sure = 0, wrong = 0;
      for (size_t i = 0; i < 5000; ++i) {
        if (!looked.sure(i)) continue;
        ++sure;
        for (int tap = 0; tap < kernel * kernel; ++tap) wrong += !looked.exact_lit(i, tap) || !looked.texel_lit(i, tap);
        wrong += looked.edge_distance_m(i) != 0;
      }
      EXPECT_GT(sure, 4900);
      EXPECT_EQ(wrong, 0) << scene.name << ", resolution " << resolution << ", kernel " << kernel;
    }
  }
}

TEST(OwnSurface, PlanesShadeNothing) {
  for (double theta : {0.0, 45.0, 80.0, 89.9})
    expect_all_lit(make_scene({.name = "plane", .theta_deg = theta, .phi_deg = 25}));
}

TEST(OwnSurface, ConvexSolidsShadeNothingThatFaces) {
  expect_all_lit(builtin("sphere"));
  Scene box;
  add_box(box, "box", {0.5, 0.8, 0.3}, glm::rotate(glm::dmat4(1), 1.1, glm::normalize(glm::dvec3(1, 2, 3))));
  box.light = {.position_m = {-2, 4, -1}, .target_m = {0, 0, 0}};
  expect_all_lit(box);
}

TEST(OwnSurface, BowlFromAboveShadesNothing) { expect_all_lit(builtin("bowl")); }

// Two slopes meet in a valley at x = 0. Along it, no vertex of one slope but the ends is a vertex of the other.
TEST(OwnSurface, ValleyOfUnweldedTJunctionsShadesNothing) {
  Scene valley;
  for (int i = 0; i < 3; ++i) add_quad(valley, "left", {-2, 1, -3.0 + 2 * i}, {0, 0, 2}, {2, -1, 0});
  for (int i = 0; i < 4; ++i) add_quad(valley, "right", {0, 0, -3 + 1.5 * i}, {0, 0, 1.5}, {2, 1.5, 0});
  light_from_above(valley);
  expect_all_lit(valley);
}

Scene duplicated(Scene scene) {
  const size_t count = scene.triangles.size();
  for (size_t t = 0; t < count; ++t) scene.triangles.push_back(scene.triangles[count - 1 - t]);
  return scene;
}

// The cube [-0.5, 0.5] x [0, 1] x [-0.5, 0.5] on a floor of +-3.
struct CubeOnFloor {
  Scene as_two_meshes, as_one_mesh, floor_split, doubled, reversed;
  CubeOnFloor() {
    const auto cube = [](Scene& s) { add_box(s, "cube", glm::dvec3(-0.5, 0, -0.5), glm::dvec3(0.5, 1, 0.5)); };
    add_quad(as_two_meshes, "floor", {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
    cube(as_two_meshes);

    const double at[4] = {-3, -0.5, 0.5, 3};  // the floor in nine, so that its vertices meet the cube's
    const auto floor_in_nine = [&](Scene& s, bool under_cube) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (under_cube || i != 1 || j != 1)
            add_quad(s, "floor", {at[i], 0, at[j]}, {0, 0, at[j + 1] - at[j]}, {at[i + 1] - at[i], 0, 0});
    };
    floor_in_nine(floor_split, true);
    cube(floor_split);

    floor_in_nine(as_one_mesh, false);  // one skin: no floor below the cube, no underside
    cube(as_one_mesh);
    std::erase_if(as_one_mesh.triangles, [&](glm::uvec3 t) {
      const auto below = [&](uint32_t v) {
        const glm::vec3 p = as_one_mesh.positions[v];
        return p.y == 0 && std::abs(p.x) == 0.5f && std::abs(p.z) == 0.5f;
      };
      return below(t.x) && below(t.y) && below(t.z);
    });
    doubled = duplicated(as_two_meshes);
    reversed = as_two_meshes;
    std::reverse(reversed.triangles.begin(), reversed.triangles.end());
    for (Scene* scene : {&as_two_meshes, &as_one_mesh, &floor_split, &doubled, &reversed})
      scene->light = {.position_m = {-2, 3, -1}, .target_m = {0, 0, 0}};
  }
};

// The triangle that contains p and has this normal. Its plane is parallel to two axes, so that p lies exactly in it.
uint32_t primitive_at(const Scene& scene, glm::dvec3 p, glm::dvec3 normal) {
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = scene.positions[scene.triangles[t].x], b = scene.positions[scene.triangles[t].y],
                     c = scene.positions[scene.triangles[t].z], n = glm::cross(b - a, c - a);
    if (glm::dot(glm::normalize(n), normal) < 0.99 || std::abs(glm::dot(n, p - a)) > 1e-9 * glm::length(n)) continue;
    if (glm::dot(n, glm::cross(b - a, p - a)) >= 0 && glm::dot(n, glm::cross(c - b, p - b)) >= 0 &&
        glm::dot(n, glm::cross(a - c, p - c)) >= 0)
      return t;
  }
  return no_primitive;
}

// Law 11.
TEST(OwnSurface, OneMeshOrTwoSplitOrDoubledHaveTheSameCauses) {
  const CubeOnFloor cubes;
  const LightFrame axes = frame_of(cubes.as_two_meshes);
  const std::vector<Placed> all = points_on(cubes.as_two_meshes, axes.direction_to_light(), false, 30000, 8);
  const LightBins brute(cubes.as_two_meshes, axes);
  std::vector<Placed> lit;
  std::vector<glm::dvec3> normals;
  const ReceiverImage image = receivers_at(cubes.as_two_meshes, all, axes.direction_to_light(), false);
  for (size_t i = 0; i < all.size(); ++i) {
    const glm::dvec3 p = image.position[i];
    if (brute.occluded(p, all[i].primitive)) continue;
    lit.push_back({p, all[i].primitive});
    normals.push_back(image.normal[i]);
  }
  ASSERT_GT(lit.size(), 20000u);
  for (int resolution : {16, 100}) {
    for (int kernel : {1, 3}) {
      Settings settings;
      settings.map.resolution = resolution;
      settings.map.extent_m = 9;
      const auto looked_at = [&](const Scene& scene) {
        std::vector<Placed> points = lit;
        for (size_t i = 0; i < points.size(); ++i) points[i].primitive = primitive_at(scene, points[i].p, normals[i]);
        const LightFrame frame = make_light_frame(scene, settings);
        return look_up(scene, frame, receivers_at(scene, points, frame.direction_to_light(), false), kernel);
      };
      const Looked two = looked_at(cubes.as_two_meshes);
      int different_places = 0;
      for (size_t i = 0; i < lit.size(); ++i) different_places += two.sure(i) && !two.texel_lit(i);
      EXPECT_GT(different_places, 10) << "no tap of this grid crosses a shadow edge: nothing is tested";
      for (const auto& [name, scene] :
           {std::pair("one mesh", &cubes.as_one_mesh), std::pair("floor split", &cubes.floor_split),
            std::pair("faces doubled", &cubes.doubled), std::pair("order reversed", &cubes.reversed)}) {
        const Looked other = looked_at(*scene);
        int different = 0;
        for (size_t i = 0; i < lit.size(); ++i) {
          if (!two.sure(i) || !other.sure(i)) continue;
          for (int tap = 0; tap < kernel * kernel; ++tap) different += two.bits(i, tap) != other.bits(i, tap);
        }
        EXPECT_EQ(different, 0) << name << ", resolution " << resolution << ", kernel " << kernel;
      }
    }
  }
}

// The floor in front of a wall, so near to its foot that texel centres lie on the wall.
TEST(OwnSurface, TheLitFootOfAWallIsLit) {
  Scene scene;
  add_quad(scene, "floor", {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  add_box(scene, "wall", glm::dvec3(0, 0, -2), glm::dvec3(0.3, 2, 2));
  scene.light = {.position_m = {-2, 3, -0.7}, .target_m = {0, 0, 0}};
  const LightFrame frame = frame_of(scene, 40);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> in(0, 1);
  std::vector<Placed> points;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 p(static_cast<float>(-0.5 * frame.texel_m(glm::dvec3(0)) * in(random)), 0,
                       static_cast<float>(2.4 * in(random)-1.2));
    points.push_back({p, primitive_at(scene, p, {0, 1, 0})});
  }
  const Looked looked = look_up(scene, frame, receivers_at(scene, points, frame.direction_to_light(), false), 1);
  int on_wall = 0;
  const LightBins brute(scene, frame);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(looked.exact_lit(i) && looked.texel_lit(i)) << points[i].p.x << ' ' << points[i].p.z;
    on_wall += brute.first_hit(frame.texel_centre(looked.texel(i))).triangle >= 2;
  }
  EXPECT_GT(on_wall, 500);
}

// Whether there is a shadow edge on the straight way. Either the depth that the light first meets jumps between two of
// the places, or the first hit comes before P's own plane, or goes behind it again.
bool edge_between(const LightBins& brute, uint32_t own, glm::dvec2 from, glm::dvec2 to) {
  constexpr int steps = 512;
  const double tolerance = 1e-9 * brute.size_m();
  LightBins::Hit last;
  double last_gap = 0;
  for (int i = 0; i <= steps; ++i) {
    const glm::dvec2 x = from + (to - from) * (static_cast<double>(i) / steps);
    const LightBins::Hit hit = brute.first_hit(x);
    const double gap = hit.z - brute.plane(own, x);
    if (i > 0) {
      if ((hit.triangle == no_primitive) != (last.triangle == no_primitive)) return true;
      if (hit.triangle != no_primitive && hit.triangle != last.triangle) {
        const glm::dvec2 before = from + (to - from) * (static_cast<double>(i - 1) / steps);
        const double a = brute.plane(last.triangle, before) - brute.plane(hit.triangle, before);
        const double b = brute.plane(last.triangle, x) - brute.plane(hit.triangle, x);
        if ((a > tolerance && b > tolerance) || (a < -tolerance && b < -tolerance)) return true;
      }
      if ((gap < -tolerance) != (last_gap < -tolerance)) return true;
    }
    last = hit;
    last_gap = gap;
  }
  return false;
}

// Law 4. Lit receivers have no exception. dark_exceptions: the share of differing taps that may have no edge, at dark
// receivers. This happens where solids intersect or concave meshes are not welded: there P's sheet ends inside a solid,
// and its continuation is a guess (docs/reference/limits.md).
void expect_edges_where_taps_differ(const Scene& scene, int resolution, int count, double dark_exceptions = 0) {
  const Looked looked = look_up(scene, resolution, 1, count);
  const LightBins brute(scene, looked.frame);
  const double reach = looked.frame.texel_m(glm::dvec3(0)) / std::sqrt(2.0) * (1 + 0x1p-23);  // the distance is a float
  int differ = 0, without_edge = 0, dark_without_edge = 0;
  for (size_t i = 0; i < looked.receivers.primitive.size(); ++i) {
    if (!looked.truth.facing[i]) continue;
    const bool differs = looked.exact_lit(i) != looked.texel_lit(i);
    EXPECT_EQ(looked.exact_lit(i), looked.truth.lit[i] != 0);
    EXPECT_EQ(looked.edge_distance_m(i) > 0, differs);
    EXPECT_LE(looked.edge_distance_m(i), reach);
    if (!differs || !looked.sure(i)) continue;
    ++differ;
    const glm::dvec2 from(looked.frame.to_light(looked.receivers.position[i])),
        to = looked.frame.texel_centre(looked.texel(i));
    ASSERT_LE(glm::length(to - from), reach);
    if (edge_between(brute, looked.receivers.primitive[i], from, to)) continue;
    if (!looked.exact_lit(i) && dark_exceptions > 0) {
      ++dark_without_edge;
    } else if (++without_edge <= 3) {
      const glm::vec3 p = looked.receivers.position[i];
      ADD_FAILURE() << scene.name << ": no shadow edge near receiver " << i << ", triangle "
                    << looked.receivers.primitive[i] << ", " << p.x << ' ' << p.y << ' ' << p.z
                    << (looked.exact_lit(i) ? " (lit)" : " (dark)");
    }
  }
  EXPECT_GT(differ, 20) << scene.name;
  EXPECT_EQ(without_edge, 0) << scene.name;
  EXPECT_LE(dark_without_edge, dark_exceptions * differ) << scene.name;
  testing::Test::RecordProperty(scene.name + ".dark_without_edge", dark_without_edge);
  testing::Test::RecordProperty(scene.name + ".differ", differ);
}

TEST(OwnSurface, AliasingNeedsAShadowEdgeWithinHalfADiagonal) {
  for (const char* name : {"wall", "plate", "pillars"}) {
    expect_edges_where_taps_differ(builtin(name), 64, 20000);
    expect_edges_where_taps_differ(builtin(name), 500, 40000);
  }
  expect_edges_where_taps_differ(builtin("cube-room"), 64, 200000);   // most of them far out on its floor
  expect_edges_where_taps_differ(builtin("fence"), 64, 20000, 0.02);  // its rails run through its wires and posts
  expect_edges_where_taps_differ(builtin("fence"), 500, 40000, 0.02);
}

TEST(OwnSurface, AliasingNeedsAShadowEdgeOnModelsToo) {
  for (const char* name : {"FlightHelmet", "Lantern"}) {
    const std::string path = shared_model(name);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    Scene scene = load_gltf(path);
    scene.name = name;
    expect_edges_where_taps_differ(scene, 256, 20000, 0.02);
  }
}

// A floor below a half-plane's edge: the distance from P to the edge is known.
TEST(Lookup, EdgeDistanceInClosedForm) {
  Scene scene;
  add_quad(scene, "floor", {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  add_quad(scene, "roof", {-3, 1, -3}, {0, 0, 6}, {3.0371, 0, 0});  // its edge at x = 0.0371
  light_from_above(scene);
  scene.map = MapVolume{.extent_m = 8, .near_m = 2, .far_m = 12};
  const Looked looked = look_up(scene, 32, 1, 30000);
  int differ = 0;
  for (size_t i = 0; i < looked.receivers.primitive.size(); ++i) {
    if (!looked.sure(i) || looked.exact_lit(i) == looked.texel_lit(i)) continue;
    ++differ;
    const glm::dvec2 p(looked.frame.to_light(looked.receivers.position[i])),
        c = looked.frame.texel_centre(looked.texel(i));
    const double way = glm::length(c - p), to_edge = way * (0.0371 - p.x) / (c.x - p.x);
    EXPECT_NEAR(looked.edge_distance_m(i), to_edge, way * 0x1p-8 + 1e-6);  // found to 2^-8 of the way
  }
  EXPECT_GT(differ, 100);
}

// If a ray goes exactly through an edge, rounding decides whether it hits the surface that ends there. The map stores
// the result of that ray, and V may be sure only if it agrees: a sure tap that is dark has the roof in its texel, a
// sure tap that is lit has the floor.
TEST(Lookup, ATexelsCentreOnAnOutlineIsSureOnlyAsTheMapHasIt) {
  Scene scene;
  add_quad(scene, "floor", {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  add_quad(scene, "roof", {-3, 1, -3}, {0, 0, 6}, {3.125, 0, 0});  // its edge at x = 0.125, a texel's centre
  light_from_above(scene);
  scene.map = MapVolume{.extent_m = 8, .near_m = 2, .far_m = 12};
  const Looked looked = look_up(scene, 32, 1, 30000);
  const double floor = looked.frame.tile(0).window_depth(10);
  int dark = 0, lit = 0;
  for (size_t i = 0; i < looked.receivers.primitive.size(); ++i) {
    const glm::ivec2 texel = looked.texel(i);
    const bool on_floor = looked.receivers.position[i].y == 0;
    if (!on_floor || looked.frame.texel_centre(texel).x != 0.125) continue;
    ++(looked.exact_lit(i) ? lit : dark);
    if (looked.bits(i) & tap_unsure) continue;
    const bool floor_in_map = std::abs(looked.lookup.exact_map.at(texel) - floor) < 1e-6;
    EXPECT_EQ(looked.texel_lit(i), floor_in_map) << looked.receivers.position[i].x << ' ' << looked.exact_lit(i);
  }
  EXPECT_GT(dark, 50);
  EXPECT_GT(lit, 50);
}

TEST(Lookup, TheMiddleTapOfAKernelIsTheUnfilteredTap) {
  for (const char* name : {"wall", "fence"}) {
    const Looked one = look_up(builtin(name), 100, 1, 5000), nine = look_up(builtin(name), 100, 3, 5000),
                 more = look_up(builtin(name), 100, 5, 5000);
    EXPECT_EQ(nine.lookup.taps.taps_per_receiver, 9);
    for (size_t i = 0; i < 5000; ++i) {
      ASSERT_EQ(one.bits(i), nine.bits(i, 4));
      for (int tap = 0; tap < 9; ++tap) ASSERT_EQ(nine.bits(i, tap), more.bits(i, (tap / 3 + 1) * 5 + tap % 3 + 1));
    }
  }
}

// Taps run row by row, lowest v first.
TEST(Lookup, TapsAreInTheShadersOrder) {
  Scene scene;
  add_quad(scene, "floor", {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  add_quad(scene, "roof", {-3, 1, -3}, {0, 0, 6}, {3, 0, 0});
  add_quad(scene, "roof", {-3, 1, -3}, {0, 0, 3}, {6, 0, 0});  // dark: x < 0 or z < 0, so u < 0 or v > 0
  light_from_above(scene);
  scene.map = MapVolume{.extent_m = 8, .near_m = 2, .far_m = 12};
  const LightFrame frame = frame_of(scene, 8);
  const glm::dvec3 p(0.5, 0, 0.5);  // the centre of texel (4, 3)
  const Looked looked =
      look_up(scene, frame, receivers_at(scene, {{p, primitive_at(scene, p, {0, 1, 0})}}, {0, 1, 0}, true), 3);
  ASSERT_EQ(looked.texel(0), glm::ivec2(4, 3));
  for (int tap = 0; tap < 9; ++tap) {
    const bool lit = tap % 3 >= 1 && tap / 3 <= 1;
    EXPECT_EQ(looked.exact_lit(0, tap), lit) << tap;
    EXPECT_EQ(looked.texel_lit(0, tap), lit) << tap;
  }
}

}  // namespace
}  // namespace noonmark::raytrace
