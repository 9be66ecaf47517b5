// The own-surface rule of R3 where surfaces meet: the same points in other meshes, and a box on a floor.
#include <gtest/gtest.h>

#include "tests/raytrace/curved_support.h"

namespace noonmark::curved {
namespace {

// Compares, tap by tap, the truths of two scenes that are the same set of points. Ambiguous receivers are left out;
// there must be few.
void expect_same_taps(const Judged& a, const Judged& b) {
  uint64_t different = 0, ambiguous = 0, differ = 0;
  for (size_t i = 0; i < a.truth.facing.size(); ++i) {
    ASSERT_EQ(a.truth.facing[i], b.truth.facing[i]);
    if (!a.truth.facing[i]) continue;
    if (a.truth.ambiguous[i] || b.truth.ambiguous[i]) {
      ++ambiguous;
      continue;
    }
    for (int t = 0; t < a.kernel * a.kernel; ++t) {
      const size_t tap = i * static_cast<size_t>(a.kernel * a.kernel) + static_cast<size_t>(t);
      different += a.lookup.taps.taps[tap] != b.lookup.taps.taps[tap];
      differ += a.tap(i, t).exact_lit != a.tap(i, t).texel_lit;
    }
  }
  EXPECT_EQ(different, 0u);
  EXPECT_LT(ambiguous, 10u);
  EXPECT_GT(differ, 5u) << "there must be something to compare";
}

// Every face is present twice, the second time turned over. This adds no occluder.
TEST(DoubledFaces, ChangeNoTap) {
  Scene single;
  add_floor(single, 4);
  add_sphere(single, 24, 12, 1, 0.9);
  add_box(single, "box", {-2.5, 0, -1}, {-1.5, 0.7, 1});
  single.light = {.position_m = {-3, 4, 1}, .target_m = {0, 0, 0}};
  Scene twice = single;
  for (const glm::uvec3 t : single.triangles) twice.triangles.push_back({t.x, t.z, t.y});
  const raytrace::Tracer tracer(single), tracer_twice(twice);
  on_many_grids(single, 700, 5000,
                [&](const Judged& j) { expect_same_taps(j, judge(tracer_twice, j.receivers, j.frame, j.kernel)); });
}

// A box on a floor, in two forms: on a whole floor, and on a floor that is cut along the box's foot, so that the two
// share corners and edges. Every tap has the same truth in both (law 11).
TEST(BoxOnFloor, HasTheSameTapsAsOneMeshOrTwo) {
  const double cuts[4] = {-3, -0.5, 0.5, 3};
  Scene whole, cut;
  add_floor(whole, 3);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      add_quad(cut, "floor", {cuts[i], 0, cuts[k]}, {0, 0, cuts[k + 1] - cuts[k]}, {cuts[i + 1] - cuts[i], 0, 0});
  const uint32_t floor_whole = static_cast<uint32_t>(whole.triangles.size()),
                 floor_cut = static_cast<uint32_t>(cut.triangles.size());
  for (Scene* scene : {&whole, &cut}) {
    add_box(*scene, "box", {-0.5, 0, -0.5}, {0.5, 1, 0.5});
    scene->light = {.position_m = {-3, 4, 1.3}, .target_m = {0, 0, 0}};
  }
  const raytrace::Tracer tracer(whole), tracer_cut(cut);
  on_many_grids(whole, 800, 5000, [&](const Judged& j) {
    ReceiverImage moved = j.receivers;
    for (uint32_t& primitive : moved.primitive.pixels) {
      const glm::vec3 p = j.receivers.position[static_cast<size_t>(&primitive - moved.primitive.pixels.data())];
      if (primitive >= floor_whole) {
        primitive += floor_cut - floor_whole;
        continue;
      }
      for (uint32_t t = 0; t < floor_cut; ++t) {  // the piece of the cut floor that holds it
        double sum = 0, area[3];
        for (int e = 0; e < 3; ++e) {
          const glm::dvec3 a = glm::dvec3(cut.positions[cut.triangles[t][e]]) - glm::dvec3(p),
                           b = glm::dvec3(cut.positions[cut.triangles[t][(e + 1) % 3]]) - glm::dvec3(p);
          sum += area[e] = glm::cross(a, b).y;
        }
        if (sum * area[0] >= 0 && sum * area[1] >= 0 && sum * area[2] >= 0) primitive = t;
      }
    }
    expect_same_taps(j, judge(tracer_cut, moved, j.frame, j.kernel));
  });
}

// At the lit foot of a box, some texels of the map lie partly on the floor and partly on the wall. The light sees the
// wall rise from the floor without a jump in depth, so errors there are acne, however deep. Behind the box, where its
// shadow falls, there is aliasing.
TEST(BoxOnFloor, ShowsAcneAtItsLitFootAndAliasingAtItsShadow) {
  Scene scene;
  add_floor(scene, 3);
  add_box(scene, "box", {-0.5, 0, -0.5}, {0.5, 1, 0.5});
  scene.light = {.position_m = {-3, 4, 1}, .target_m = {0, 0, 0}};
  uint64_t foot_acne = 0, shadow_differ = 0;
  on_many_grids(scene, 900, 8000, [&](const Judged& j) {
    if (j.frame.resolution < 64) return;  // texels as wide as the box reach its upper edge
    const double reach = j.reach() / std::abs(j.frame.forward.y);
    // In front of the middle of the lit side, so near that taps meet it, away from its ends.
    const auto at_foot = [&](size_t i) {
      const glm::vec3 p = j.receivers.position[i];
      return j.receivers.primitive[i] < 2 && p.x < -0.5 && p.x > -0.5 - reach && std::abs(p.z) < 0.5 - 2 * reach;
    };
    const Tally foot = tally(j, at_foot);
    EXPECT_EQ(foot.differ, 0u);
    EXPECT_EQ(foot.dark, 0u);
    foot_acne += j.causes(0, at_foot)[at(Cause::acne)];
    shadow_differ += tally(j).differ;
    expect_aliasing_at_true_edges(j, TrueEdges(scene, j.frame));
  });
  EXPECT_GT(foot_acne, 50u);
  EXPECT_GT(shadow_differ, 300u);
}

}  // namespace
}  // namespace noonmark::curved
