// Triangles that are present many times in the same place (a file with a mesh exported again and again). They cost as
// much as one of them, and they change nothing.
#include <gtest/gtest.h>

#include "raytrace/adjacency.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// Each triangle `copies` times. Each copy has separate vertices and begins at another corner.
Scene copied(const Scene& scene, uint32_t copies) {
  Scene out = scene;
  for (uint32_t k = 1; k < copies; ++k) {
    const auto first = static_cast<uint32_t>(out.positions.size());
    out.positions.insert(out.positions.end(), scene.positions.begin(), scene.positions.end());
    for (const glm::uvec3& t : scene.triangles) {
      const auto corner = [&](uint32_t i) { return first + t[static_cast<int>((i + k) % 3)]; };
      out.triangles.push_back({corner(0), corner(1), corner(2)});
    }
  }
  return out;
}

TEST(Copies, AreKnownByTheFirst) {
  Scene square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_FALSE(Adjacency(square).any_copies());
  EXPECT_TRUE(Adjacency(square).without_copies().empty());

  Scene many = copied(square, 3);
  many.triangles.push_back({2, 1, 0});  // the other side of the sheet is no copy, because culling differs
  const Adjacency adjacency(many);
  for (uint32_t t = 0; t < 6; ++t) EXPECT_EQ(adjacency.first(t), t % 2) << t;
  EXPECT_EQ(adjacency.without_copies(), (std::vector<uint32_t>{0, 1, 6}));
  EXPECT_TRUE(adjacency.across(4, 0).empty());
}

struct Measured {
  ReceiverTruth truth;
  LookupTruth lookup;
  Image<float> distance;
  uint64_t rays;
};

Measured measure(const Scene& scene, const ReceiverImage& receivers, const LightFrame& frame, CulledFaces cull) {
  const Tracer tracer(scene);
  StageTime hard, soft;
  MapSettings map;
  map.cull = cull;
  Measured m{tracer.receiver_truth(receivers, frame, sun(2, 0.1), &hard, &soft), {}, {}, 0};
  m.lookup = tracer.lookup_truth(receivers, m.truth, probe_of(receivers, frame, box(3)), frame, map);
  m.distance = tracer.occluder_distance(receivers, frame, m.truth.facing);
  m.rays = hard.rays + soft.rays + m.lookup.texel_stage.rays + m.lookup.tap_stage.rays;
  return m;
}

// 200,000 triangles in a few places. When each ray met all copies, and each tap near an edge visited the edges of all
// copies, this test did not end in time.
TEST(Copies, CostNoMoreRaysAndChangeNothing) {
  for (const char* name : {"cube-room", "plate"}) {
    const Scene scene = builtin(name);
    const auto count = static_cast<uint32_t>(scene.triangles.size());
    const Scene many = copied(scene, 200'000 / count);
    const LightFrame frame = frame_of(scene);
    const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), false, 4000, 3);
    ReceiverImage on_copies = receivers;  // the rasteriser may have seen any of them
    for (size_t i = 0; i < on_copies.primitive.size(); ++i)
      on_copies.primitive[i] += count * static_cast<uint32_t>(i % (many.triangles.size() / count));
    for (const CulledFaces cull : {CulledFaces::none, CulledFaces::front}) {
      const Measured one = measure(scene, receivers, frame, cull), all = measure(many, on_copies, frame, cull);
      EXPECT_EQ(all.truth.lit.pixels, one.truth.lit.pixels);
      EXPECT_EQ(all.truth.ambiguous.pixels, one.truth.ambiguous.pixels);
      EXPECT_EQ(all.truth.soft.pixels, one.truth.soft.pixels);
      EXPECT_EQ(all.lookup.taps.taps, one.lookup.taps.taps);
      EXPECT_EQ(all.lookup.exact_map.depth, one.lookup.exact_map.depth);
      EXPECT_EQ(all.lookup.edge_distance_texels.pixels, one.lookup.edge_distance_texels.pixels);
      EXPECT_EQ(all.distance.pixels, one.distance.pixels);
      EXPECT_EQ(all.rays, one.rays);
      EXPECT_GT(one.rays, 1'000u);  // where cells do not answer; texel centres of a flat map need none
    }
    EXPECT_EQ(Tracer(many).open_edges(), Tracer(scene).open_edges());
  }
}

}  // namespace
}  // namespace noonmark::raytrace
