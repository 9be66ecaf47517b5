// The silhouettes listed around a few places give the answers of all silhouettes.
#include "raytrace/silhouettes.h"

#include <gtest/gtest.h>

#include <random>

#include "raytrace/traced_scene.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

class Nearby : public testing::TestWithParam<LightKind> {
 protected:
  // Small triangles around the origin, none of which shares an edge with another: every edge is a silhouette.
  static Scene scraps(std::mt19937& random) {
    std::uniform_real_distribution<float> at(-2, 2), side(-0.3f, 0.3f);
    Scene scene;
    for (uint32_t t = 0; t < 300; ++t) {
      const glm::vec3 corner(at(random), at(random), at(random));
      scene.positions.push_back(corner);
      for (int i = 0; i < 2; ++i)
        scene.positions.push_back(corner + glm::vec3(side(random), side(random), side(random)));
      scene.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    scene.light = {.kind = GetParam(), .position_m = {0.3, 9, 0.2}, .target_m = {0, 0, 0.1}};
    return scene;
  }
};

TEST_P(Nearby, AnswersLikeAllSilhouettes) {
  std::mt19937 random(20261122);
  const Scene scene = scraps(random);
  const LightFrame frame = make_light_frame(scene, {});
  const Adjacency adjacency(scene);
  const LightView view(scene, frame);
  const double reach = 1e-3;
  const Silhouettes all(adjacency, view, reach);
  Silhouettes::Nearby listed;
  std::uniform_real_distribution<double> unit(-1, 1);
  uint64_t near = 0, crossed = 0, none = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    // A place close to a corner of a triangle: inside the reach of its edges, or just outside.
    const glm::dvec3 corner = view.corner(static_cast<uint32_t>(random() % scene.triangles.size()), 0);
    const glm::dvec3 way(unit(random), unit(random), 0);
    const glm::dvec3 x = view.place_of(corner + 1.5 * reach * way);
    const double size = view.place_of(corner + glm::dvec3(0.05, 0, 0)).x - view.place_of(corner).x;
    // The rectangle begins at x and goes away from the corner, so that the edges that are near x may lie beside it.
    glm::dvec3 y = x;
    y.x += (way.x > 0 ? 1 : -1) * std::abs(size);
    y.y += (way.y > 0 ? 1 : -1) * std::abs(size);
    y = view.normal_place(y);
    const glm::dvec3 places[2] = {x, y};
    all.list_nearby(places, listed);
    for (const glm::dvec3 place : {x, y, view.normal_place((x + y) / 2.0)}) {
      ASSERT_EQ(listed.near(place), all.near(place)) << trial;
      ASSERT_EQ(listed.near(place, reach / 3), all.near(place, reach / 3)) << trial;
      near += all.near(place);
    }
    ASSERT_EQ(listed.crossings(x, y), all.crossings(x, y)) << trial;
    crossed += !all.crossings(x, y).empty();
    none += listed.none();
    if (listed.none()) {
      ASSERT_TRUE(all.crossings(x, y).empty() && !all.near(x) && !all.near(y)) << trial;
    }
  }
  EXPECT_GT(near, 500u);
  EXPECT_GT(crossed, 500u);
  // Under the other lights the rectangle is widened by twice the reach, which holds the corner's own edges.
  if (GetParam() == LightKind::directional) {
    EXPECT_GT(none, 20u);
  }
}
// Many ways from one place at once: what is said of them for sure is what they are asked one by one.
TEST_P(Nearby, AnswersManyWaysAtOnce) {
  if (GetParam() != LightKind::directional) GTEST_SKIP() << "of parallel rays only";
  std::mt19937 random(20261127);
  const Scene scene = scraps(random);
  const Adjacency adjacency(scene);
  const LightView view(scene, make_light_frame(scene, {}));
  const double reach = 1e-3, unit = 0.01;
  const Silhouettes all(adjacency, view, reach);
  Silhouettes::Nearby listed;
  Silhouettes::Ways ways;
  std::uniform_real_distribution<double> part(-1, 1);
  constexpr int on_an_edge = 50;
  uint64_t clear = 0, open = 0, away = 0, beside = 0, asked = 0;
  for (int trial = 0; trial < 400; ++trial) {
    // Around a corner of a triangle, so that the ways cross edges, pass beside their ends, and end beside them. The first
    // trials begin on an edge itself.
    const auto t = static_cast<uint32_t>(random() % scene.triangles.size());
    const glm::dvec3 corner = view.corner(t, 0), along = view.corner(t, 1) - corner;
    glm::dvec2 from = glm::dvec2(corner) + glm::dvec2(along) * std::abs(part(random));
    if (trial >= on_an_edge) from += 4 * unit * glm::dvec2(part(random), part(random));
    ways.clear();
    ways.from = from, ways.unit_m = unit, ways.most_m = glm::length(from);
    std::vector<glm::dvec3> ends;
    const auto add = [&](glm::dvec2 end) {
      ways.push((end - from) / unit);
      ends.emplace_back(end, 1);
    };
    for (int y = -4; y <= 4; ++y)
      for (int x = -4; x <= 4; ++x) add(from + unit * glm::dvec2(x, y));
    for (int i = 0; i < 20; ++i) add(glm::dvec2(corner) + 2 * reach * glm::dvec2(part(random), part(random)));
    glm::dvec2 low = from, high = from;
    for (const glm::dvec3 end : ends) low = glm::min(low, glm::dvec2(end)), high = glm::max(high, glm::dvec2(end));
    all.list_in({0, low, high}, listed);
    listed.answer(ways);
    for (size_t i = 0; i < ends.size(); ++i) {
      const bool near = all.near(ends[i]), crosses = !all.crossings(glm::dvec3(from, 1), ends[i]).empty();
      ASSERT_TRUE(ways.open[i] || (!near && !crosses)) << trial << ", way " << i;
      ASSERT_TRUE(ways.beside[i] || !near) << trial << ", way " << i;
      if (trial < on_an_edge) continue;  // nothing is known of a way that begins on an edge
      ++asked;
      clear += !near && !crosses, open += ways.open[i] != 0;
      away += !near, beside += ways.beside[i] != 0;
    }
  }
  // answer() finds nearly all ways that are clear, and nearly all ends that no edge is near.
  EXPECT_GT(clear, asked / 4);
  EXPECT_LT(open - (asked - clear), clear / 50);
  EXPECT_GT(asked - away, asked / 50);
  EXPECT_LT(beside - (asked - away), away / 50);
}

INSTANTIATE_TEST_SUITE_P(Lights, Nearby, testing::Values(LightKind::directional, LightKind::spot, LightKind::point));

}  // namespace
}  // namespace noonmark
