// What a traced scene keeps of its lights, and the lists from which the lattice of all placements is drawn.
#include "raytrace/traced_scene.h"

#include <gtest/gtest.h>

#include <random>

#include "raytrace/lattice_raster.h"
#include "raytrace/lattice_side.h"
#include "scenes/library.h"
#include "technique/placements.h"

namespace noonmark::raytrace {
namespace {

LightFrame frame_at(const Scene& scene, double shift_texels) {
  Settings settings;
  settings.map.resolution = 64;
  settings.map.shift_u_texels = shift_texels;
  return make_light_frame(scene, settings);
}

ReceiverImage receivers_of(int width, int height) {
  return {Image<glm::vec3>(width, height), Image<glm::vec3>(width, height), Image<uint32_t>(width, height, 0u)};
}

class TracedSceneTest : public testing::Test {
 protected:
  Scene scene = make_scene({});
  TracedScene traced{scene};
  LightFrame a = frame_at(scene, 0), b = frame_at(scene, 0.25), c = frame_at(scene, 0.375);
};

// A point at all placements goes from its own light to that of its worst placement and back.
TEST_F(TracedSceneTest, KeepsTheLastTwoLights) {
  const std::weak_ptr<LightSide> first = traced.lit_by(a), second = traced.lit_by(b);
  EXPECT_NE(first.lock(), second.lock());
  EXPECT_EQ(traced.lit_by(a), first.lock());
  const std::weak_ptr<LightSide> third = traced.lit_by(c);
  EXPECT_TRUE(second.expired()) << "it was used the longest ago";
  EXPECT_EQ(traced.lit_by(a), first.lock());
  EXPECT_EQ(traced.lit_by(c), third.lock());
  EXPECT_TRUE(traced.lit_by(b)->view().same_light(b));
  EXPECT_TRUE(first.expired());
}

TEST_F(TracedSceneTest, KeepsTheCellsOfTwoSizesOfPicture) {
  LightSide& light = *traced.lit_by(a);
  const ReceiverImage small = receivers_of(160, 90), middle = receivers_of(320, 180), large = receivers_of(640, 360);
  LightCells* const of_small = light.cells(small);
  LightCells* const of_middle = light.cells(middle);
  EXPECT_EQ(of_small->finest(), LightCells::finest_for(small));
  EXPECT_EQ(of_middle->finest(), LightCells::finest_for(middle));
  EXPECT_NE(of_small->finest(), of_middle->finest());
  EXPECT_EQ(light.cells(small), of_small);
  EXPECT_EQ(light.cells(middle), of_middle);
  EXPECT_EQ(light.cells(large)->finest(), LightCells::finest_for(large));
  EXPECT_EQ(light.cells(middle), of_middle);
}

TEST_F(TracedSceneTest, KeepsTheLastLattice) {
  const Placements placements(4);
  const std::weak_ptr<const LatticeSide> first = traced.lattice_side(placements.lattice(a));
  EXPECT_EQ(traced.lattice_side(placements.lattice(a)), first.lock());
  const auto finer = traced.lattice_side(Placements(8).lattice(a));
  EXPECT_TRUE(first.expired());
  EXPECT_EQ(finer->view.frame(), Placements(8).lattice(a));
}

// Each tile lists, in ascending order, every triangle whose box of lattice points touches it. The reference looks at the
// corners alone and knows neither table nor blocks.
TEST(LatticeCandidates, AreAllTrianglesThatMayCoverATile) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<float> at(-3, 3), side(-0.4f, 0.4f);
  Scene scene;
  for (uint32_t t = 0; t < 9000; ++t) {  // more than two blocks
    const glm::vec3 corner(at(random), at(random), at(random));
    const float scale = t % 500 == 0 ? 20 : 1;  // some cover more tiles than there are
    scene.positions.push_back(corner);
    for (int i = 0; i < 2; ++i)
      scene.positions.push_back(corner + scale * glm::vec3(side(random), side(random), side(random)));
    scene.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  scene.light = {.position_m = {0.3, 9, 0.2}, .target_m = {0, 0, 0.1}};
  const TracedScene traced(scene);
  Settings settings;
  settings.map.resolution = 512;
  const LightView view(scene, make_light_frame(scene, settings));
  const LatticeRaster raster(traced, view);
  const glm::dvec2 origin(view.texel_place({0, 0})), step = glm::dvec2(view.texel_place({1, 1})) - origin;
  for (const bool far_apart : {false, true}) {
    std::vector<glm::ivec2> tiles;
    for (int y = -1; y < 9; ++y)
      for (int x = -1; x < 9; ++x)
        if ((x + y) % 3 != 0) tiles.push_back({x, y});
    if (far_apart) tiles.push_back({900'000, -700'000});
    const std::vector<std::vector<uint32_t>> lists = raster.candidates(tiles);
    ASSERT_EQ(lists.size(), tiles.size());
    size_t listed = 0;
    for (size_t i = 0; i < tiles.size(); ++i) {
      std::vector<uint32_t> expected;
      for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (traced.adjacency.is_copy(t) || view.edge_on(t)) continue;
        glm::dvec2 low(1e300), high(-1e300);
        for (int k = 0; k < 3; ++k) {
          const glm::dvec2 point = (glm::dvec2(view.corner(t, k)) - origin) / step;
          low = glm::min(low, point);
          high = glm::max(high, point);
        }
        low = glm::floor(low) - 1.0, high = glm::ceil(high) + 1.0;  // as LatticeRaster allows for rounding
        const glm::dvec2 first = glm::dvec2(tiles[i]) * 64.0, last = first + 63.0;
        if (high.x >= first.x && low.x <= last.x && high.y >= first.y && low.y <= last.y) expected.push_back(t);
      }
      ASSERT_EQ(lists[i], expected) << "tile " << tiles[i].x << " " << tiles[i].y;
      listed += expected.size();
    }
    EXPECT_GT(listed, 5000u);
  }
  EXPECT_TRUE(raster.candidates({}).empty());
}

}  // namespace
}  // namespace noonmark::raytrace
