// What the cells of the light's plane answer, held against what the program's own rays answer, value for value.
#pragma once
#include <gtest/gtest.h>

#include "tests/raytrace/fixture.h"

namespace noonmark::test {

// Rays that were cast, by what they were cast for.
struct RayCounts {
  uint64_t hard = 0, soft = 0, texels = 0, taps = 0;
};

// Receivers all over the surfaces; and beside the edges and the corners of triangles, at distances from nothing to some
// hundred float errors, because that is where the certain areas end.
inline ReceiverImage receivers_of(const Scene& scene, glm::dvec3 to_light, int count, uint32_t seed) {
  std::vector<Placed> points = points_on(scene, to_light, true, count, seed);
  std::mt19937 random(seed);
  const double size = glm::length(glm::dvec3(scene.positions[0])) + 4;
  std::uniform_real_distribution<double> uniform(0, 1);
  const size_t areas = points.size();
  for (size_t i = 0; i < areas; i += 2) {
    const uint32_t primitive = points[i].primitive;
    const glm::uvec3 t = scene.triangles[primitive];
    const int e = static_cast<int>(random() % 3);
    const glm::dvec3 a = scene.positions[t[e]], b = scene.positions[t[(e + 1) % 3]],
                     c = scene.positions[t[(e + 2) % 3]];
    const double along = random() % 4 == 0 ? std::round(uniform(random)) : uniform(random);
    const glm::dvec3 on_edge = a + along * (b - a), inwards = c - on_edge;
    const double aside = size * std::pow(2.0, -25 + 12 * uniform(random)) * static_cast<double>(random() % 4 > 0);
    points.push_back({on_edge + std::min(1.0, aside / glm::length(inwards)) * inwards, primitive});
  }
  return receivers_at(scene, points, to_light, true);
}

// What cells answered, beside what rays did.
struct CellsAndRays {
  int receivers = 0;                                 // whose truth differs
  bool taps = false, edges = false, depths = false;  // whether one differs
  RayCounts by_cells, by_rays;
  bool same() const { return receivers == 0 && !taps && !edges && !depths; }
};

inline CellsAndRays compare_cells(const Scene& scene, int count, uint32_t seed, double sun_deg,
                                  const FilterSettings& filter) {
  using raytrace::Tracer;
  const LightFrame frame = frame_of(scene, 128);
  const glm::dvec3 to_light =
      frame.light().rays().have_one_direction() ? frame.direction_to_light() : glm::dvec3(0, 1, 0);
  const ReceiverImage receivers = receivers_of(scene, to_light, count, seed);
  const auto measure = [&](bool use_cells, RayCounts& rays) {
    const Tracer tracer(scene, use_cells ? TruthMethod::automatic : TruthMethod::rays);
    StageTime hard, soft;
    const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, sun(sun_deg, 0.1), &hard, &soft);
    const raytrace::LookupTruth lookup =
        tracer.lookup_truth(receivers, truth, probe_of(receivers, frame, filter), frame, {});
    rays = {hard.rays, soft.rays, lookup.texel_stage.rays, lookup.tap_stage.rays};
    return std::pair(truth, lookup);
  };
  CellsAndRays found;
  const auto [truth, lookup] = measure(true, found.by_cells);
  const auto [expected, expected_lookup] = measure(false, found.by_rays);
  for (size_t i = 0; i < truth.lit.size(); ++i)
    found.receivers += truth.facing[i] != expected.facing[i] || truth.lit[i] != expected.lit[i] ||
                       truth.ambiguous[i] != expected.ambiguous[i] || truth.soft[i] != expected.soft[i];
  found.taps = lookup.taps.taps != expected_lookup.taps.taps;
  found.edges = lookup.edge_distance_texels.pixels != expected_lookup.edge_distance_texels.pixels;
  found.depths = lookup.exact_map.depth != expected_lookup.exact_map.depth;
  return found;
}

// Returns the rays that were cast with cells.
inline RayCounts expect_same(const Scene& scene, int count = 4000, uint32_t seed = 1, const std::string& what = "",
                             double sun_deg = 1, const FilterSettings& filter = box(3)) {
  const CellsAndRays found = compare_cells(scene, count, seed, sun_deg, filter);
  EXPECT_EQ(found.receivers, 0) << what << scene.name;
  EXPECT_FALSE(found.taps) << what << scene.name;
  EXPECT_FALSE(found.edges) << what << scene.name;
  EXPECT_FALSE(found.depths) << what << scene.name;
  EXPECT_LE(found.by_cells.hard, found.by_rays.hard);
  EXPECT_LE(found.by_cells.soft, found.by_rays.soft);
  EXPECT_LE(found.by_cells.taps, found.by_rays.taps);
  return found.by_cells;
}

}  // namespace noonmark::test
