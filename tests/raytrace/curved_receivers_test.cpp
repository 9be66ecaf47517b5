// The own-surface rule of R3 on curved and creased receivers: each error must get the cause that a person would name.
// Receivers are random points of the surfaces, the grid is shifted and turned at random, and OpenGL is not used. The
// tests check the taps' truths F (at the tap's exact place) and V (at the texel's centre), and the causes that follow
// from them.
//
// Aliasing needs F != V at every bias, so "no aliasing" is tested on the taps themselves.
#include <gtest/gtest.h>

#include "tests/raytrace/curved_support.h"

namespace noonmark::curved {
namespace {

// The properties of a shape that does not shade itself.
struct Lone {
  // A texel beyond a receiver's own fold may show another part of the shape, higher than the fold, and the depth that
  // the light sees jumps on the way there. So aliasing is allowed for receivers that near to a fold; it is rare.
  bool has_folds = false;
  bool flat = false;  // perpendicular to the light: no acne either
  double most_ambiguous = 0.001;
};

// Nothing in the scene shades anything: all receivers are lit, and at every bias the only error is acne.
void expect_acne_only(const Scene& scene, uint32_t seed, const Lone& lone = {}) {
  uint64_t acne = 0, all_taps = 0;
  on_many_grids(scene, seed, 3000, [&](const Judged& j) {
    const TrueEdges edges(scene, j.frame);
    const auto inner = [&](size_t i) {
      return !edges.outline_within(glm::dvec2(j.frame.to_light(j.receivers.position[i])), j.reach());
    };
    const auto chosen = lone.has_folds ? std::function<bool(size_t)>(inner) : nullptr;
    const Tally sum = tally(j, chosen), everywhere = tally(j);
    EXPECT_LE(everywhere.differ, everywhere.taps / 100);
    uint64_t unlit = 0;
    for (size_t i = 0; i < j.truth.facing.size(); ++i) unlit += j.counted(i) && !j.truth.lit[i];
    EXPECT_EQ(unlit, 0u);
    all_taps += sum.taps;
    EXPECT_EQ(sum.dark, 0u);
    EXPECT_EQ(sum.differ, 0u);
    EXPECT_LE(static_cast<double>(sum.ambiguous), lone.most_ambiguous * static_cast<double>(sum.facing));
    for (double bias : {0.0, 0.02, 0.5}) {
      const Judged::Causes causes = j.causes(bias * j.frame.texel_m(glm::dvec3(0)) * 10, chosen);
      acne += causes[at(Cause::acne)];
      EXPECT_EQ(causes[at(Cause::none)] + causes[at(Cause::acne)], sum.taps) << "bias " << bias;
    }
  });
  EXPECT_GT(all_taps, 5000u);
  EXPECT_TRUE(lone.flat || acne > 1000) << "at bias 0 about half of every slope is dark";
}

// --- Where no point shades another

// A height field hides nothing of itself from a light straight above, however steep or concave it is, because every
// vertical line meets it in one point. Coarse cells have creases where their two triangles meet, as ridges and as
// valleys.
TEST(HeightField, UnderALightFromAboveShowsAcneOnly) {
  const std::function<double(double, double)> heights[] = {
      [](double x, double z) { return 0.8 * (x * x - z * z); },                          // saddle
      [](double x, double z) { return 0.7 * (x * x * x - 3 * x * z * z); },              // monkey saddle
      [](double x, double z) { return 0.5 * (x * x + z * z); },                          // bowl
      [](double x, double z) { return 0.3 * std::sin(5 * x + 1) * std::cos(4 * z); },    // egg crate
      [](double x, double z) { return 0.5 * std::abs(x) + 0.2 * std::abs(z - 0.3); },    // valleys with a crease
      [](double x, double z) { return -1.5 * std::abs(x - 0.2) - 0.4 * std::abs(z); }};  // ridges
  uint32_t seed = 1;
  for (const auto& height : heights) {
    for (int cells : {3, 8, 40}) {
      SCOPED_TRACE(testing::Message() << "height field " << seed << " of " << cells << " cells");
      Scene scene;
      add_height_field(scene, cells, height);
      test::light_from_above(scene);
      expect_acne_only(scene, seed++);
    }
  }
}

// A convex solid hides nothing that faces the light, wherever the light comes from.
TEST(Sphere, AloneShowsAcneOnly) {
  uint32_t seed = 200;
  for (const auto& [columns, rows] : {std::pair(5, 3), std::pair(12, 6), std::pair(128, 64)}) {
    for (const glm::dvec3 light : {glm::dvec3(0, 10, 0), glm::dvec3(-4, 3, 5), glm::dvec3(6, -0.1, 1)}) {
      Scene scene;
      add_sphere(scene, columns, rows, 1, 0);
      scene.light = {.position_m = light, .target_m = {0, 0, 0}};
      expect_acne_only(scene, seed++);
    }
  }
}

// A decal on a wall, which lies in the plane of the wall up to the float rounding of its corners; and a wall that is
// present twice. Neither face occludes the other, although rounding may put either of them nearer by one bit.
TEST(CoplanarFaces, ShowAcneOnly) {
  for (double tilt : {0.0, 0.6, 1.2}) {
    Scene scene;
    add_quad(scene, "wall", {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    add_quad(scene, "decal", {-0.31, 0, -0.17}, {0.1, 0, 0.5}, {0.63, 0, -0.05});
    add_quad(scene, "wall again", {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    for (glm::vec3& p : scene.positions)
      p = glm::vec3(glm::dmat3(glm::rotate(glm::dmat4(1), tilt, glm::normalize(glm::dvec3(0.4, 0.1, 1)))) *
                    glm::dvec3(p));
    test::light_from_above(scene);
    SCOPED_TRACE(testing::Message() << "tilted by " << tilt);
    // The decal covers 0.32 of the 4 square metres of the wall, and as much of the second wall. There the truth depends
    // on the corners' rounding, so these receivers are ambiguous.
    expect_acne_only(scene, 300, {.flat = tilt == 0, .most_ambiguous = 2 * 0.32 / 8 + 0.01});
  }
}

// --- Where some points shade others

// Lit from the side, a torus shades its own far half: the shadow of the near side of the tube falls on the inner slope
// beyond the hole.
TEST(Torus, ObliquelyLitAliasesAtItsShadowsEdgesOnly) {
  uint32_t seed = 400;
  std::vector<std::vector<double>> shares;
  for (const auto& [columns, rows] : {std::pair(12, 8), std::pair(36, 18), std::pair(128, 64)}) {
    SCOPED_TRACE(testing::Message() << columns << " x " << rows);
    Scene scene;
    add_torus(scene, columns, rows, 1, 0.4);
    scene.light = {.position_m = {-5, 3, 1}, .target_m = {0, 0, 0}};
    uint64_t differ = 0, dark = 0, taps = 0;
    Judged::Causes small{}, large{};
    on_many_grids(scene, seed++, 4000, [&](const Judged& j) {
      expect_aliasing_at_true_edges(j, TrueEdges(scene, j.frame));
      const Tally sum = tally(j);
      differ += sum.differ, dark += sum.dark, taps += sum.taps;
      const Judged::Causes without = j.causes(0), with = j.causes(2);
      for (int c = 0; c < compared_cause_count; ++c) small[c] += without[c], large[c] += with[c];
      EXPECT_EQ(without[at(Cause::peter_panning)], 0u) << "without a bias only the grid can light a dark tap";
    });
    EXPECT_GT(dark, taps / 100) << "the torus must shade itself";
    EXPECT_GT(differ, 200u);
    EXPECT_GT(small[at(Cause::acne)], taps / 5);
    EXPECT_GT(large[at(Cause::peter_panning)], 100u) << "the near tube is 1.2 m away or more, and the bias is 2 m";
    shares.push_back({});
    for (Cause cause : {Cause::aliasing_dark, Cause::aliasing_light, Cause::acne})
      shares.back().push_back(static_cast<double>(small[at(cause)]) / static_cast<double>(taps));
    shares.back().push_back(static_cast<double>(large[at(Cause::peter_panning)]) / static_cast<double>(taps));
  }
  // Coarse and fine meshes have the same causes. A coarse torus is thinner and its edges are elsewhere, but no cause
  // takes the place of another. The tube of 12 x 8 is a tenth thinner; the factor of 2 allows for this and for the
  // sampling.
  for (const auto& coarse : shares)
    for (size_t c = 0; c < coarse.size(); ++c) {
      EXPECT_GT(coarse[c], 0.5 * shares.back()[c]) << c;
      EXPECT_LT(coarse[c], 2 * shares.back()[c]) << c;
    }
}

// A sphere with a radius of 1 m on a floor: touching it in one point, sunk a little, floating, and sunk so deep that
// the light sees the crease where the sphere leaves the floor.
class SphereOnFloor : public testing::TestWithParam<double> {};

TEST_P(SphereOnFloor, AcneOnTheSphereAndAliasingAtItsShadowsEdge) {
  const double centre_y = GetParam();
  for (const auto& [columns, rows] : {std::pair(8, 5), std::pair(24, 12), std::pair(128, 64)}) {
    SCOPED_TRACE(testing::Message() << columns << " x " << rows);
    Scene scene;
    add_floor(scene, 4);
    add_sphere(scene, columns, rows, 1, centre_y);
    scene.light = {.position_m = {-3, 4, 1}, .target_m = {0, 0, 0}};
    Scene sphere_alone;
    add_sphere(sphere_alone, columns, rows, 1, centre_y);
    const double facet = 1 - std::cos(pi / columns) * std::cos(pi / (2 * rows));  // what the facets cut off
    uint64_t floor_differ = 0, panning = 0, crease = 0, sphere_taps = 0;
    on_many_grids(scene, 600, 5000, [&](const Judged& j) {
      const LightFrame& frame = j.frame;
      const TrueEdges edges(scene, frame);
      // No camera can see what lies below the floor, nor the part of the floor inside the sphere.
      const auto on_floor = [&](size_t i) {
        const glm::dvec3 p = j.receivers.position[i];
        return j.receivers.primitive[i] < 2 && (centre_y >= 1 || glm::length(p - glm::dvec3(0, centre_y, 0)) > 1);
      };
      const auto on_sphere = [&](size_t i) { return j.receivers.primitive[i] >= 2 && j.receivers.position[i].y > 0; };
      const auto inner = [&](size_t i) {  // further from the terminator than its taps reach
        return on_sphere(i) && !edges.outline_within(glm::dvec2(frame.to_light(j.receivers.position[i])), j.reach());
      };
      const Tally sphere = tally(j, inner);
      sphere_taps += sphere.taps;
      EXPECT_EQ(sphere.differ, 0u) << "convex: what faces the light is lit";
      EXPECT_EQ(sphere.dark, 0u);
      for (double bias : {0.0, 0.05, 4.0}) {
        const Judged::Causes causes = j.causes(bias, inner);
        EXPECT_EQ(causes[at(Cause::none)] + causes[at(Cause::acne)], sphere.taps) << "bias " << bias;
        panning += j.causes(bias, on_floor)[at(Cause::peter_panning)];
      }
      EXPECT_LT(tally(j).ambiguous, 5u);

      const LightBins bins(sphere_alone, frame);
      expect_aliasing_at_true_edges(j, edges, on_floor);
      expect_aliasing_at_true_edges(j, edges, on_sphere);
      uint64_t wrong_dark = 0, off_crease = 0, panning_in_light = 0, outside_the_circle = 0;
      const glm::dvec2 centre = glm::dvec2(frame.to_light({0, centre_y, 0}));
      const double crease_radius = std::sqrt(std::max(0.0, 1 - centre_y * centre_y));
      for (size_t i = 0; i < j.truth.facing.size(); ++i) {
        if (!on_floor(i) || !j.counted(i)) continue;
        const auto shaded = [&](glm::dvec2 x) {  // is the sphere before the floor there?
          const double floor_z =
              frame.to_light(frame.to_world({x.x, x.y, 0})).z - frame.to_world({x.x, x.y, 0}).y / frame.forward.y;
          return bins.first_hit(x).z < floor_z;
        };
        for (int t = 0; t < j.kernel * j.kernel; ++t) {
          const Tap tap = j.tap(i, t);
          const glm::dvec2 place = j.place(i, t);
          const glm::dvec2 texel = j.texel_centre(i, t);
          floor_differ += tap.exact_lit != tap.texel_lit;
          // The floor is a plane, so its depth at the texel's centre is known. Where the light sees the crease, the
          // sphere rises from the floor without a jump: V is lit there, and a dark verdict is acne.
          if (tap.texel_lit == shaded(texel)) {
            ++crease;
            wrong_dark += !tap.texel_lit;
            // On the floor the crease is a circle, too.
            const double from_crease =
                std::abs(std::hypot(j.receivers.position[i].x, j.receivers.position[i].z) - crease_radius);
            off_crease += from_crease > j.reach() / std::abs(frame.forward.y) + 2 * facet;
          }
          // The closed form: the sphere's shadow in the light's plane is a circle.
          const double off = std::abs(glm::length(place - centre) - 1);
          outside_the_circle += centre_y >= 1 && tap.exact_lit != tap.texel_lit &&
                                off > facet + j.frame.texel_m(glm::dvec3(0)) * std::sqrt(0.5);
          const float deep = static_cast<float>(0.3 / (frame.far_m - frame.near_m));
          const bool lit = !(j.probe.reference[i] - deep > tap.depth);
          panning_in_light += j.kernel == 1 && j.truth.lit[i] && tap_cause(tap, lit) == Cause::peter_panning;
        }
      }
      EXPECT_EQ(wrong_dark, 0u) << "V is dark only where the sphere stands before the floor";
      EXPECT_EQ(off_crease, 0u);
      EXPECT_EQ(panning_in_light, 0u) << "Peter Panning can light only a dark receiver";
      EXPECT_EQ(outside_the_circle, 0u);
    });
    EXPECT_GT(floor_differ, 300u);
    EXPECT_GT(sphere_taps, 2000u);
    EXPECT_GT(panning, 300u);
    if (centre_y >= 1) {
      EXPECT_EQ(crease, 0u) << "the light sees no crease, so V is exactly the sphere's shadow";
    } else if (centre_y < 0.5) {
      EXPECT_GT(crease, 20u);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Places, SphereOnFloor, testing::Values(1.0, 0.97, 1.03, 1.5, 0.3), [](const auto& place) {
  const double y = place.param;
  return y == 1      ? "Touching"
         : y == 0.97 ? "SunkALittle"
         : y == 1.03 ? "FloatingALittle"
         : y == 1.5  ? "Floating"
                     : "Dome";
});

// A sphere inside a slightly larger one. All of it that faces the light is dark, and so is every place on it that a
// texel reaches. If it were continued along its tangent plane instead of along itself, it would break through the
// shell, because the shell is nearer than the sphere bends away within a coarse texel. A bias that reaches through the
// shell causes Peter Panning.
TEST(Shell, KeepsWhatIsWithinDarkAtEveryTap) {
  for (const auto& [columns, rows] : {std::pair(24, 12), std::pair(128, 64)}) {
    Scene scene;
    add_sphere(scene, columns, rows, 1, 0);
    const size_t within = scene.triangles.size();
    add_sphere(scene, columns, rows, 1.01, 0);
    scene.light = {.position_m = {-3, 4, 1}, .target_m = {0, 0, 0}};
    uint64_t taps = 0, panning = 0;
    on_many_grids(scene, 950, 5000, [&](const Judged& j) {
      const TrueEdges edges(scene, j.frame);
      const auto inner = [&](size_t i) {
        return j.receivers.primitive[i] < within &&
               !edges.outline_within(glm::dvec2(j.frame.to_light(j.receivers.position[i])), j.reach());
      };
      const Tally sum = tally(j, inner);
      taps += sum.taps;
      EXPECT_EQ(sum.dark, sum.taps);
      EXPECT_EQ(sum.differ, 0u);
      const Judged::Causes causes = j.causes(1, inner);
      EXPECT_EQ(causes[at(Cause::none)] + causes[at(Cause::peter_panning)], sum.taps);
      panning += causes[at(Cause::peter_panning)];
    });
    EXPECT_GT(taps, 5000u);
    EXPECT_GT(panning, taps / 2);
  }
}

}  // namespace
}  // namespace noonmark::curved
