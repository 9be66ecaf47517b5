// Which triangles share an edge.
#include "raytrace/adjacency.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace noonmark {
namespace {

std::multiset<uint32_t> neighbours(const Adjacency& adjacency, uint32_t triangle, int edge) {
  const auto span = adjacency.across(triangle, edge);
  return {span.begin(), span.end()};
}

TEST(Adjacency, WeldsByExactPositionWhateverTheIndex) {
  const float above = std::nextafter(1.0f, 2.0f);
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0.0f, -0.0f, -0.0f}, {0, -1, 0}, {above, 0, 0}};
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 4, 5}};
  const Adjacency adjacency(scene);
  EXPECT_EQ(neighbours(adjacency, 0, 0), std::multiset<uint32_t>{1});  // -0 is 0; the next float after 1 is not 1
  EXPECT_EQ(neighbours(adjacency, 1, 1), std::multiset<uint32_t>{2});
  EXPECT_EQ(neighbours(adjacency, 2, 0).size(), 0u);
  EXPECT_EQ(adjacency.welded(0)[0], adjacency.welded(1)[1]);
  EXPECT_EQ(adjacency.welded(0)[1], adjacency.welded(1)[0]);
  EXPECT_NE(adjacency.welded(0)[1], adjacency.welded(2)[0]);
}

Scene fan(uint32_t count) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  for (uint32_t i = 0; i < count; ++i) {
    scene.positions.push_back({0, 1, static_cast<float>(i)});
    scene.triangles.push_back({0, 1, 2 + i});
  }
  return scene;
}

TEST(Adjacency, NonManifoldEdgesJoinAllUpToTheFanLimit) {
  for (uint32_t count : {3u, 64u}) {
    const Adjacency adjacency(fan(count));
    for (uint32_t t = 0; t < count; ++t) {
      const auto found = neighbours(adjacency, t, 0);
      EXPECT_EQ(found.size(), count - 1);
      EXPECT_FALSE(found.contains(t));
      EXPECT_EQ(adjacency.across(t, 1).size(), 0u);
    }
  }
  const Adjacency over(fan(65));
  for (uint32_t t = 0; t < 65; ++t) EXPECT_EQ(over.across(t, 0).size(), 0u);
}

// All triangles share one edge. The cost must not grow with the square of their number: 10^11 pairs would not end in a
// test's time.
TEST(Adjacency, AFileThatPutsEveryTriangleAtOneEdgeIsNoTrap) {
  EXPECT_EQ(Adjacency(fan(400000)).across(7, 0).size(), 0u);
}

TEST(Adjacency, AnEmptySceneHasNone) { EXPECT_NO_THROW(Adjacency{Scene()}); }

// Brute force on random triangles with few different positions: the neighbours across an edge are the triangles with
// the same two end positions. Copies of a triangle count once.
RC_GTEST_PROP(Adjacency, AgreesWithBruteForceInAnyOrder, ()) {
  Scene scene;
  const int count = *rc::gen::inRange(0, 30);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k)
      scene.positions.push_back({static_cast<float>(*rc::gen::inRange(-1, 2)),
                                 static_cast<float>(*rc::gen::inRange(0, 2)), *rc::gen::element(0.0f, -0.0f, 0.5f)});
    const uint32_t v = static_cast<uint32_t>(3 * i);
    scene.triangles.push_back({v, v + 1, v + 2});
  }
  scene.triangles = *rc::gen::map(rc::gen::just(scene.triangles), [](std::vector<glm::uvec3> t) {
    std::reverse(t.begin(), t.end());
    return t;
  });
  const Adjacency adjacency(scene);
  const auto at = [&](uint32_t t, int i) { return scene.positions[scene.triangles[t][i % 3]]; };
  const auto first = [&](uint32_t t) {
    for (uint32_t other = 0; other < t; ++other)
      for (int turn = 0; turn < 3; ++turn)
        if (at(other, turn) == at(t, 0) && at(other, turn + 1) == at(t, 1) && at(other, turn + 2) == at(t, 2))
          return other;
    return t;
  };
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    RC_ASSERT(adjacency.first(t) == first(t));
    for (int e = 0; e < 3; ++e) {
      std::multiset<uint32_t> expected;
      for (uint32_t other = 0; other < scene.triangles.size(); ++other) {
        if (other == t || first(t) != t || first(other) != other) continue;
        for (int f = 0; f < 3; ++f) {
          const bool same = (at(other, f) == at(t, e) && at(other, f + 1) == at(t, e + 1)) ||
                            (at(other, f) == at(t, e + 1) && at(other, f + 1) == at(t, e));
          if (same) expected.insert(other);
        }
      }
      RC_ASSERT(neighbours(adjacency, t, e) == expected);
    }
  }
}

}  // namespace
}  // namespace noonmark
