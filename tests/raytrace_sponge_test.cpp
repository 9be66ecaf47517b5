// Solids that touch along edges: random cubes of a grid, whose edges two, four, six or eight faces share. The walk over
// P's own sheet must go on over the surface on P's side of the edge.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "raytrace/own_surface.h"
#include "raytrace_fixture.h"

namespace noonmark {
namespace {

constexpr int side = 7;
constexpr double cell_m = 0.25;  // exact in float

struct Sponge {
  std::array<bool, side * side * side> filled{};

  bool at(glm::ivec3 c) const {
    if (glm::any(glm::lessThan(c, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(c, glm::ivec3(side)))) return false;
    return filled[static_cast<size_t>((c.x * side + c.y) * side + c.z)];
  }
  // A face whose cell is filled and whose neighbour above is not.
  bool open_top(glm::ivec3 c) const { return at(c) && !at(c + glm::ivec3(0, 1, 0)); }
};

Sponge random_sponge(uint32_t seed) {
  std::mt19937 random(seed);
  Sponge sponge;
  for (bool& f : sponge.filled) f = random() % 2 == 0;
  return sponge;
}

// inner: also the faces between two filled cells, once for each.
Scene scene_of(const Sponge& sponge, bool inner) {
  Scene scene;
  scene.name = "sponge";
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) {
        const glm::ivec3 cell(x, y, z);
        if (!sponge.at(cell)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (int sign : {-1, 1}) {
            glm::ivec3 out(0);
            out[axis] = sign;
            if (!inner && sponge.at(cell + out)) continue;
            glm::dvec3 u(0), v(0), corner = cell_m * glm::dvec3(cell);
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = cell_m;
            if (sign > 0) corner[axis] += cell_m;
            if (sign < 0) std::swap(u, v);
            add_quad(scene, "face", corner, u, v);
          }
      }
  scene.light = {.position_m = {4.1, 7.3, 2.9}, .target_m = {0.8, 0.7, 0.9}};
  return scene;
}

// A way over open tops of one height stays on P's sheet, so that a dark P's V there is what the first hit says: the
// sheet, or something before it.
TEST(Sponge, CoplanarTopsAreOneSheetWhateverTouchesAtTheirEdges) {
  int on_sheet = 0, hidden = 0, over_shared = 0;
  for (uint32_t seed = 0; seed < 12; ++seed) {
    const Sponge sponge = random_sponge(seed);
    for (bool inner : {false, true}) {
      const Scene scene = scene_of(sponge, inner);
      const LightFrame frame = test::frame_of(scene);
      const EmbreeDevice device;
      const EmbreeScene embree(device, scene);
      const Adjacency adjacency(scene);
      const LightView view(scene, frame);
      const OwnSurface surface(embree, adjacency, view);
      const test::LightBins brute(scene, frame);
      std::mt19937 random(seed + 100);
      std::uniform_real_distribution<double> in(0.02, 0.98), way(-2, 2);
      for (int trial = 0; trial < 4000; ++trial) {
        const glm::ivec3 cell(random() % side, random() % side, random() % side);
        if (!sponge.open_top(cell)) continue;
        const glm::dvec3 p = cell_m * (glm::dvec3(cell) + glm::dvec3(in(random), 1, in(random)));
        const glm::dvec3 q = p + cell_m * glm::dvec3(way(random), 0, way(random));
        bool open = true;
        int cells = 0;
        glm::ivec3 last = cell;
        for (int step = 0; step <= 400 && open; ++step) {
          const glm::dvec3 at = (p + step / 400.0 * (q - p)) / cell_m;
          const glm::ivec3 under(static_cast<int>(std::floor(at.x)), cell.y, static_cast<int>(std::floor(at.z)));
          open = sponge.open_top(under);
          if (under == last) continue;
          ++cells;
          // Past a corner a sample may miss a cell: then another way is asked.
          open &= std::abs(under.x - last.x) + std::abs(under.z - last.z) == 1;
          last = under;
        }
        if (!open || cells == 0) continue;
        uint32_t own = no_primitive;
        const glm::dvec3 p_light = frame.to_light(p);
        brute.each_at(glm::dvec2(p_light), [&](uint32_t t, double z) {
          if (std::abs(z - p_light.z) < 1e-9 && brute.front(t)) own = t;
        });
        if (own == no_primitive || !brute.occluded(p, own)) continue;  // of a lit P the jumps decide
        const glm::dvec3 q_light = frame.to_light(q), x = view.place_of(q_light);
        uint32_t hit = no_primitive;
        view.first_hits(embree, 1, &x, &hit);
        uint64_t rays = 0;
        const OwnSurface::Verdict verdict = surface.lit_at(surface.point(p_light, own, false), x, hit, rays);
        if (!verdict.sure) continue;
        const bool lit = brute.first_hit(glm::dvec2(q_light)).z >= q_light.z - 1e-9;
        ASSERT_EQ(verdict.lit, lit) << "seed " << seed << " inner " << inner << " from " << p.x << ' ' << p.y << ' '
                                    << p.z << " to " << q.x << ' ' << q.z;
        (lit ? on_sheet : hidden) += 1;
        over_shared += cells > 1;
      }
    }
  }
  EXPECT_GT(on_sheet, 150);
  EXPECT_GT(hidden, 150);
  EXPECT_GT(over_shared, 100);
}

}  // namespace
}  // namespace noonmark
