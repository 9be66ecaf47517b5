// The same surface in other triangles has the same area, volume and points, and joined triangles stay joined.
#include "scenes/remesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "scenes/library.h"
#include "scenes/scene_size.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

using Key = std::tuple<float, float, float>;
Key key(glm::vec3 p) { return {p.x, p.y, p.z}; }

glm::vec3 corner(const Scene& scene, size_t triangle, int i) { return scene.positions[scene.triangles[triangle][i]]; }

std::set<Key> points(const Scene& scene) {
  std::set<Key> all;
  for (size_t t = 0; t < scene.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) all.insert(key(corner(scene, t, i)));
  return all;
}

// Twice the vector area of the part (0 for a closed surface), and six times the volume under it.
std::pair<glm::dvec3, double> measure(const Scene& scene, const Part& part) {
  glm::dvec3 area(0);
  double volume = 0;
  for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
    const glm::dvec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2);
    area += glm::cross(b - a, c - a);
    volume += glm::dot(a, glm::cross(b, c));
  }
  return {area, volume};
}

// How often each directed edge is used. An edge is identified by the positions of its ends.
std::map<std::pair<Key, Key>, int> edges(const Scene& scene) {
  std::map<std::pair<Key, Key>, int> runs;
  for (size_t t = 0; t < scene.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) ++runs[{key(corner(scene, t, i)), key(corner(scene, t, (i + 1) % 3))}];
  return runs;
}

int open_edges(const Scene& scene) {
  const auto runs = edges(scene);
  return static_cast<int>(std::count_if(runs.begin(), runs.end(), [&](const auto& run) {
    return !runs.contains({run.first.second, run.first.first});
  }));
}

class Remesh : public testing::TestWithParam<std::string> {
 protected:
  Scene made(MeshForm form) const { return make_scene({.name = GetParam(), .mesh = form}); }
  const Scene built = made(MeshForm::as_built);
};

// Coordinates of up to 80 m are rounded by 2^-24 of that. Areas of up to 160 x 160 m2 change with them.
constexpr double remesh_rounding = 1e-6;
void expect_same_measure(const Scene& a, const Part& in_a, const Scene& b, const Part& in_b) {
  const auto [area_a, volume_a] = measure(a, in_a);
  const auto [area_b, volume_b] = measure(b, in_b);
  EXPECT_LT(glm::length(area_a - area_b), remesh_rounding * (1 + glm::length(area_a))) << in_a.name;
  EXPECT_NEAR(volume_a, volume_b, remesh_rounding * (1 + std::abs(volume_a))) << in_a.name;
}

TEST_P(Remesh, OneMeshHasOnePartAndEachPointOnce) {
  const Scene one = made(MeshForm::one_mesh);
  ASSERT_EQ(one.parts.size(), 1u);
  EXPECT_EQ(one.parts[0].triangle_count, built.triangles.size());
  ASSERT_EQ(one.triangles.size(), built.triangles.size());
  for (size_t t = 0; t < built.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) ASSERT_EQ(corner(one, t, i), corner(built, t, i));
  EXPECT_EQ(points(one).size(), one.positions.size());
}

TEST_P(Remesh, SplitCutsEachTriangleInFourAndOpensNoSeam) {
  const Scene split = made(MeshForm::split);
  ASSERT_EQ(split.triangles.size(), 4 * built.triangles.size());
  ASSERT_EQ(split.parts.size(), built.parts.size());
  for (size_t p = 0; p < built.parts.size(); ++p) {
    EXPECT_EQ(split.parts[p].first_triangle, 4 * built.parts[p].first_triangle);
    EXPECT_EQ(split.parts[p].triangle_count, 4 * built.parts[p].triangle_count);
    expect_same_measure(built, built.parts[p], split, split.parts[p]);
  }
  EXPECT_EQ(open_edges(split), 2 * open_edges(built));  // an open edge becomes two; no other edge comes open
  const std::set<Key> all = points(split);
  for (const Key& point : points(built)) ASSERT_TRUE(all.contains(point));
}

TEST_P(Remesh, ReversedIsTheSameTrianglesFromTheEnd) {
  const Scene reversed = made(MeshForm::reversed);
  ASSERT_EQ(reversed.triangles.size(), built.triangles.size());
  const size_t last = built.triangles.size() - 1;
  for (size_t t = 0; t <= last; ++t)
    for (int i = 0; i < 3; ++i) ASSERT_EQ(corner(reversed, last - t, i), corner(built, t, (i + 1) % 3));
  EXPECT_TRUE(std::equal(built.positions.rbegin(), built.positions.rend(), reversed.positions.begin()));
  ASSERT_EQ(reversed.parts.size(), built.parts.size());
  for (size_t p = 0; p < built.parts.size(); ++p) {
    const Part& mirrored = reversed.parts[built.parts.size() - 1 - p];
    EXPECT_EQ(mirrored.name, built.parts[p].name);
    expect_same_measure(built, built.parts[p], reversed, mirrored);
  }
}

TEST_P(Remesh, DoubledHasEveryTriangleOnceMoreWithItsOwnVertices) {
  const Scene doubled = made(MeshForm::doubled);
  const size_t n = built.triangles.size();
  ASSERT_EQ(doubled.triangles.size(), 2 * n);
  ASSERT_EQ(doubled.parts.size(), 2 * built.parts.size());
  std::set<uint32_t> first, second;
  for (size_t t = 0; t < n; ++t)
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(corner(doubled, t, i), corner(built, t, i));
      ASSERT_EQ(corner(doubled, n + t, i), corner(built, t, i));
      first.insert(doubled.triangles[t][i]);
      second.insert(doubled.triangles[n + t][i]);
    }
  EXPECT_LT(*first.rbegin(), *second.begin());
  EXPECT_EQ(doubled.parts.back().first_triangle + doubled.parts.back().triangle_count, 2 * n);
}

TEST_P(Remesh, KeepsCameraLightAndMap) {
  for (MeshForm form : {MeshForm::one_mesh, MeshForm::split, MeshForm::reversed, MeshForm::doubled}) {
    const Scene other = made(form);
    EXPECT_EQ(other.name, built.name);
    EXPECT_EQ(other.camera.eye_m, built.camera.eye_m);
    EXPECT_EQ(other.light.position_m, built.light.position_m);
    EXPECT_EQ(other.map->extent_m, built.map->extent_m);
  }
}

// Floats are 64 m apart at 1e9 m: of a room nothing is left there, and that is said in place of what a camera sees of it.
TEST(RemeshMoved, WhatFloatsLeaveOfTheSceneIsSaid) {
  const auto moved = [](double x) { return make_scene({.name = "cube-room", .move_m = glm::dvec3(x, x, x)}); };
  EXPECT_TRUE(moved(0).notes.empty());
  EXPECT_TRUE(moved(1e5).notes.empty());
  const std::vector<std::string> notes = moved(1e7).notes;  // 1 m apart
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("scene.move_m"), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("have no area"), std::string::npos) << notes[0];
  expect_refused(ErrorKind::usage, {"scene.move_m", "64 m apart"},
                 [&] { make_scene({.name = "cube-room", .move_m = glm::dvec3(9e8, 0, 0)}); });
}

TEST(RemeshSides, EachTriangleKeepsItsOwn) {
  Scene two;
  two.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  two.triangles = {{0, 1, 2}, {2, 1, 3}};
  two.single_sided = {true, false};
  two.parts = {{"both", 0, 2}};
  using Sides = std::vector<bool>;
  EXPECT_EQ(remeshed(two, MeshForm::one_mesh).single_sided, (Sides{true, false}));
  EXPECT_EQ(remeshed(two, MeshForm::split).single_sided, (Sides{true, true, true, true, false, false, false, false}));
  EXPECT_EQ(remeshed(two, MeshForm::reversed).single_sided, (Sides{false, true}));
  EXPECT_EQ(remeshed(two, MeshForm::doubled).single_sided, (Sides{true, false, true, false}));
  two.single_sided = {};
  for (MeshForm form : {MeshForm::one_mesh, MeshForm::split, MeshForm::reversed, MeshForm::doubled})
    EXPECT_TRUE(remeshed(two, form).single_sided.empty());
}

TEST(RemeshNormals, VerticesKeepTheirOwn) {
  Scene one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  one.vertex_normals = {{1, 0, 0}, {0, 1, 0}};  // of the first two
  one.parts = {{"one", 0, 1}};
  using Normals = std::vector<glm::vec3>;
  const Normals all = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(remeshed(one, MeshForm::reversed).vertex_normals, Normals(all.rbegin(), all.rend()));
  EXPECT_EQ(remeshed(one, MeshForm::doubled).vertex_normals, (Normals{all[0], all[1], all[2], all[0], all[1], all[2]}));
  for (MeshForm form : {MeshForm::one_mesh, MeshForm::tiles, MeshForm::t_junctions})
    EXPECT_TRUE(remeshed(one, form).vertex_normals.empty());
  const Scene turned = remeshed(one, MeshForm::as_built, {180, {3, 0, 0}});
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));  // half a turn: n becomes 2 (n.a) a - n
  EXPECT_LT(glm::distance(glm::dvec3(turned.vertex_normals[0]), 2 * axis.x * axis - glm::dvec3(1, 0, 0)), 1e-6);
}

// The size that is checked against the memory before anything is made.
TEST_P(Remesh, IsAsLargeAsToldBefore) {
  for (MeshForm form : {MeshForm::as_built, MeshForm::one_mesh, MeshForm::split, MeshForm::reversed, MeshForm::doubled,
                        MeshForm::tiles, MeshForm::t_junctions}) {
    SCOPED_TRACE(static_cast<int>(form));
    const SceneSize predicted = remeshed_size(built, form), found = scene_size(made(form));
    EXPECT_EQ(predicted.triangles, found.triangles);
    EXPECT_EQ(predicted.part_bytes, found.part_bytes);
    if (form == MeshForm::one_mesh || form == MeshForm::split)  // equal vertices are not counted before: an upper bound
      EXPECT_GE(predicted.vertices, found.vertices);
    else
      EXPECT_EQ(predicted.vertices, found.vertices);
  }
  EXPECT_EQ(remeshed_size(built, MeshForm::tiles).triangles, 64 * built.triangles.size());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Remesh, testing::Values("cube-room", "sphere", "bowl", "fence"),
                         [](const auto& named) {
                           std::string name = named.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace noonmark
