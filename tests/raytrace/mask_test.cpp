// R1 of a masked scene against brute force that samples the mask by itself: the whole cards are met in double, and the
// texture says whether the point is there. Nothing of this knows how cards are cut.
#include <gtest/gtest.h>

#include "scenes/foliage.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// Where the ray from p along d meets the triangle, as texture coordinates. hit: it meets it; d may also lead backwards,
// then t is negative.
struct Met {
  bool hit = false;
  glm::dvec2 uv{0};
  double t = 0;
};
Met meet(glm::dvec3 p, glm::dvec3 d, const std::array<glm::vec3, 3>& corners, const std::array<glm::dvec2, 3>& uv) {
  const glm::dvec3 a(corners[0]), ab = glm::dvec3(corners[1]) - a, ac = glm::dvec3(corners[2]) - a,
                                  n = glm::cross(ab, ac);
  const double t = glm::dot(a - p, n) / glm::dot(d, n);
  const glm::dvec3 at = p + t * d - a;
  const double b = glm::dot(glm::cross(at, ac), n) / glm::dot(n, n),
               c = glm::dot(glm::cross(ab, at), n) / glm::dot(n, n);
  if (b < 0 || c < 0 || b + c > 1) return {};
  return {true, uv[0] + b * (uv[1] - uv[0]) + c * (uv[2] - uv[0]), t};
}

// How near the place comes to a side of a texel, in texels.
double to_a_side(glm::dvec2 uv, const AlphaMask& mask) {
  const glm::dvec2 at = uv * glm::dvec2(mask.width, mask.height), off = glm::abs(at - glm::round(at));
  return std::min(off.x, off.y);
}

TEST(MaskedTruth, EqualsTheTextureSampledAlongEachRay) {
  SceneSettings settings;
  settings.name = "foliage";
  const Scene scene = make_scene(settings);
  const LightFrame frame = frame_of(scene);
  const AlphaMask mask = frond_mask();
  const auto cards = frond_cards();
  const Tracer tracer(scene);
  const glm::dvec3 to_light = frame.direction_to_light(glm::dvec3(0));
  int asked = 0, dark = 0, through_holes = 0, near = 0, ambiguous = 0;
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 20000, 7);
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (!truth.facing[i]) continue;
    if (truth.ambiguous[i]) {
      ++ambiguous;
      continue;
    }
    bool occluded = false, hole = false, close = false;
    for (const auto& card : cards) {
      for (size_t half = 0; half < 2; ++half) {
        const Met met = meet(receivers.position[i], to_light, card[half], frond_coordinates[half]);
        // The receiver's own card is met at distance 0, give or take its rounding to float.
        if (!met.hit || met.t < 1e-5) continue;
        close |= to_a_side(met.uv, mask) < 1e-4;  // 2 micrometres, 8 roundings of the cards' float positions
        (mask.opaque_at(met.uv) ? occluded : hole) = true;
      }
    }
    if (close) {
      ++near;
      continue;
    }
    ++asked, dark += occluded, through_holes += hole && !occluded;
    ASSERT_EQ(truth.lit[i] == 0, occluded) << "receiver " << i << " on triangle " << receivers.primitive[i];
  }
  EXPECT_GT(asked, 10000);
  EXPECT_GT(dark, 500);
  EXPECT_GT(through_holes, 500);
  EXPECT_LT(near + ambiguous, asked / 50);
}

}  // namespace
}  // namespace noonmark::raytrace
