// R1 and V of masked scenes against brute force that samples the mask by itself: the whole cards are met in double, and
// the texture says whether the point is there. Nothing of this knows how cards are cut.
#include <gtest/gtest.h>

#include "raytrace/own_surface.h"
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

// A mask that is sampled linearly: a soft frond, or noise of black and white, whose border is as long and as bent as one
// can be.
AlphaMask linear_mask(bool noise) {
  AlphaMask mask = frond_mask();
  mask.filter = MaskFilter::linear;
  std::mt19937 random(5);
  const std::vector<uint8_t> sharp = mask.alpha;
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i) {
      int sum = 0;
      for (const auto& [di, dj] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}})
        sum += sharp[static_cast<size_t>(std::min(j + dj, mask.height - 1) * mask.width +
                                         std::min(i + di, mask.width - 1))];
      mask.alpha[static_cast<size_t>(j * mask.width + i)] =
          static_cast<uint8_t>(noise ? random() % 2 * 255 : static_cast<unsigned>(sum / 4));
    }
  return mask;
}

// The cards of the scene foliage with this mask, over its floor.
Scene masked_cards(const AlphaMask& mask) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  const MaskCutter cutter(mask);
  MaskCutter::Pieces pieces;
  for (const auto& card : frond_cards())
    for (size_t half = 0; half < 2; ++half) {
      cutter.cut(card[half], frond_coordinates[half], pieces);
      const auto base = static_cast<uint32_t>(scene.positions.size());
      scene.positions.insert(scene.positions.end(), pieces.positions.begin(), pieces.positions.end());
      for (const glm::uvec3& t : pieces.triangles) scene.triangles.push_back(base + t);
      scene.mask_error_m = std::max(scene.mask_error_m, pieces.error_m);
    }
  scene.light = {.position_m = {-2.5, 5, 1.5}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 7, .near_m = 1, .far_m = 9};
  return scene;
}

// Whether the texture of a card is opaque between the point and the light.
bool occluded_by_texture(glm::dvec3 p, glm::dvec3 to_light, const AlphaMask& mask) {
  for (const auto& card : frond_cards())
    for (size_t half = 0; half < 2; ++half)
      if (const Met met = meet(p, to_light, card[half], frond_coordinates[half]);
          met.hit && met.t > 1e-5 && mask.opaque_at(met.uv))
        return true;
  return false;
}

// No receiver is left out because it lies near a border: what the texture and the polygon say otherwise is ambiguous.
TEST(MaskedTruth, OfALinearMaskIsWrongNowhereAndInDoubtHardlyAnywhere) {
  for (const bool noise : {false, true}) {
    const AlphaMask mask = linear_mask(noise);
    const Scene scene = masked_cards(mask);
    EXPECT_GT(scene.mask_error_m, 0);
    const LightFrame frame = frame_of(scene);
    const Tracer tracer(scene);
    const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 40000, 7);
    const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
    int asked = 0, dark = 0, ambiguous = 0, differ = 0;
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      if (!truth.facing[i]) continue;
      ++asked;
      const bool occluded = occluded_by_texture(receivers.position[i], frame.direction_to_light(), mask);
      dark += occluded, ambiguous += truth.ambiguous[i];
      differ += !truth.ambiguous[i] && (truth.lit[i] == 0) != occluded;
    }
    EXPECT_EQ(differ, 0) << (noise ? "noise" : "frond");
    EXPECT_GT(dark, asked / 50);
    RecordProperty(noise ? "ambiguous_noise" : "ambiguous_frond", ambiguous);
    EXPECT_LT(ambiguous, asked / 1000) << (noise ? "noise" : "frond");
  }
}

// V at the exact places of taps around receivers on the floor, which goes on below all of them.
TEST(MaskedTruth, OfATapUnderALinearMaskIsWrongNowhereAndInDoubtHardlyAnywhere) {
  for (const bool noise : {false, true}) {
    const AlphaMask mask = linear_mask(noise);
    const Scene scene = masked_cards(mask);
    const LightFrame frame = frame_of(scene);
    const glm::dvec3 to_light = frame.direction_to_light();
    const Tracer tracer(scene);
    Scene floor = scene;
    floor.triangles.resize(2);
    const ReceiverImage receivers = random_receivers(floor, to_light, true, 5000, 3);
    const LookupProbe probe = probe_of(receivers, frame, box(3));
    const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
    const LookupTruth lookup = tracer.lookup_truth(receivers, truth, probe, frame, {});
    int asked = 0, dark = 0, unsure = 0, differ = 0;
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      if (truth.ambiguous[i]) continue;
      for (int tap = 0; tap < probe.taps(); ++tap) {
        const glm::dvec3 place = frame.tap_place(frame.to_light(receivers.position[i]), probe.offset(i, tap));
        const glm::dvec3 on_ray = frame.to_world({place.x, place.y, 0}), x = on_ray - on_ray.y / to_light.y * to_light;
        if (std::max(std::abs(x.x), std::abs(x.z)) > 3.99) continue;  // beside the floor
        const uint8_t bits = lookup.taps.bits(i, tap);
        const bool occluded = occluded_by_texture(x, to_light, mask);
        ++asked, dark += occluded, unsure += (bits & tap_exact_unsure) != 0;
        differ += !(bits & tap_exact_unsure) && ((bits & tap_exact_lit) == 0) != occluded;
      }
    }
    EXPECT_EQ(differ, 0) << (noise ? "noise" : "frond");
    EXPECT_GT(asked, 35000);
    EXPECT_GT(dark, asked / 50);
    RecordProperty(noise ? "unsure_noise" : "unsure_frond", unsure);
    EXPECT_LT(unsure, asked / 1000) << (noise ? "noise" : "frond");
  }
}

// V at places so near to the polygon's border that the texture may say otherwise, and a little further away. Random taps
// hardly ever lie there.
TEST(MaskedTruth, IsFirmBesideABorderOnlyWhereTheTextureAgrees) {
  for (const bool noise : {false, true}) {
    SCOPED_TRACE(noise ? "noise" : "frond");
    const AlphaMask mask = linear_mask(noise);
    const Scene scene = masked_cards(mask);
    const LightFrame frame = frame_of(scene);
    const glm::dvec3 to_light = frame.direction_to_light();
    const EmbreeDevice device;
    const EmbreeScene embree(device, scene);
    const Adjacency adjacency(scene);
    const LightView view(scene, frame);
    const Silhouettes silhouettes(adjacency, view, Silhouettes::reach_of(view));
    const OwnSurface surface(embree, adjacency, view, silhouettes);
    const auto on_floor = [&](glm::dvec3 q) { return q - q.y / to_light.y * to_light; };
    const auto covered_by_floor = [](glm::dvec3 q) { return std::max(std::abs(q.x), std::abs(q.z)) < 3.9; };
    int firm = 0, near_unsure = 0, polygon_differs = 0, differ = 0;
    const auto ask = [&](glm::dvec3 q, bool near) {
      const glm::dvec3 floor = on_floor(q), p = floor + glm::dvec3(0.07, 0, 0.03);
      if (!covered_by_floor(floor) || !covered_by_floor(p)) return;
      const bool occluded = occluded_by_texture(floor, to_light, mask);
      const glm::dvec3 x = view.place_of(frame.to_light(floor)), at = frame.to_light(p);
      uint32_t hit = no_primitive;
      view.first_hits(embree, 1, &x, &hit);
      const uint32_t own = surface.covers(0, view.place_of(at)) ? 0 : 1;
      const OwnSurface::Verdict v =
          surface.lit_at(surface.point(at, own, !occluded_by_texture(p, to_light, mask)), x, hit);
      firm += v.sure, near_unsure += near && !v.sure;
      polygon_differs += v.lit == occluded;
      differ += v.sure && v.lit == occluded;
    };
    const size_t step = 1 + scene.triangles.size() / 5000;
    for (uint32_t t = 2; t < scene.triangles.size(); t += static_cast<uint32_t>(step))
      for (int e = 0; e < 3; ++e) {
        if (!adjacency.across(t, e).empty()) continue;
        const auto corner = [&](int i) { return glm::dvec3(scene.positions[scene.triangles[t][i % 3]]); };
        const glm::dvec3 a = corner(e), b = corner(e + 1), middle = (a + b) / 2.0;
        const glm::dvec3 aside = glm::normalize(glm::cross(glm::cross(b - a, corner(e + 2) - a), b - a));
        for (const double share : {-3.0, -0.5, -0.1, 0.1, 0.5, 3.0})
          ask(middle + share * scene.mask_error_m * aside, std::abs(share) < 1);
      }
    EXPECT_EQ(differ, 0);
    EXPECT_GT(polygon_differs, 100) << "the places do not tell the polygon from the texture";
    EXPECT_GT(near_unsure, 1000);
    EXPECT_GT(firm, 100);
  }
}

}  // namespace
}  // namespace noonmark::raytrace
