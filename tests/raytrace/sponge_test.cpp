// Solids that touch along edges: random cubes of a grid, in which two, four, six or eight faces share an edge. The walk
// over P's own sheet must continue on the surface on P's side of the edge.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "raytrace/own_surface.h"
#include "tests/raytrace/fixture.h"

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
  // Whether the cell is filled and the cell above it is not.
  bool open_top(glm::ivec3 c) const { return at(c) && !at(c + glm::ivec3(0, 1, 0)); }
};

Sponge random_sponge(uint32_t seed) {
  std::mt19937 random(seed);
  Sponge sponge;
  for (bool& f : sponge.filled) f = random() % 2 == 0;
  return sponge;
}

// inner: with the faces between two filled cells too, once for each of the two.
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

struct Setting {
  explicit Setting(const Sponge& sponge, bool inner)
      : scene(scene_of(sponge, inner)),
        frame(test::frame_of(scene)),
        embree(device, scene),
        adjacency(scene),
        view(scene, frame),
        silhouettes(adjacency, view, Silhouettes::reach_of(view)),
        surface(embree, adjacency, view, silhouettes),
        brute(scene, frame) {}

  // The triangle at p that faces the light. None if p is not on the surface, or if it is lit (for a lit P the jumps
  // decide).
  uint32_t dark_at(glm::dvec3 p) const {
    uint32_t own = no_primitive;
    const glm::dvec3 light = frame.to_light(p);
    brute.each_at(glm::dvec2(light), [&](uint32_t t, double z) {
      if (std::abs(z - light.z) < 1e-9 && brute.front(t)) own = t;
    });
    return own != no_primitive && brute.occluded(p, own) ? own : no_primitive;
  }
  OwnSurface::Verdict verdict(glm::dvec3 p, uint32_t own, glm::dvec3 q) const {
    const glm::dvec3 x = view.place_of(frame.to_light(q));
    uint32_t hit = no_primitive;
    view.first_hits(embree, 1, &x, &hit);
    return surface.lit_at(surface.point(frame.to_light(p), own, false), x, hit);
  }
  // Whether nothing lies between the light and q.
  bool seen(glm::dvec3 q) const {
    const glm::dvec3 light = frame.to_light(q);
    return brute.first_hit(glm::dvec2(light)).z >= light.z - 1e-9;
  }

  Scene scene;
  LightFrame frame;
  EmbreeDevice device;
  EmbreeScene embree;
  Adjacency adjacency;
  LightView view;
  Silhouettes silhouettes;
  OwnSurface surface;
  test::LightBins brute;
};

struct Found {
  int lit = 0, hidden = 0;
  // For a dark P, the first hit decides V on P's own sheet: it is the sheet, or something before it.
  void compare(const Setting& s, glm::dvec3 p, glm::dvec3 q) {
    const uint32_t own = s.dark_at(p);
    if (own == no_primitive) return;
    const OwnSurface::Verdict verdict = s.verdict(p, own, q);
    if (!verdict.sure) return;
    const bool sees = s.seen(q);
    EXPECT_EQ(verdict.lit, sees) << "from " << p.x << ' ' << p.y << ' ' << p.z << " to " << q.x << ' ' << q.y << ' '
                                 << q.z;
    (sees ? lit : hidden) += 1;
  }
};

TEST(Sponge, CoplanarTopsAreOneSheetWhateverTouchesAtTheirEdges) {
  Found found;
  for (uint32_t seed = 0; seed < 12; ++seed) {
    const Sponge sponge = random_sponge(seed);
    for (bool inner : {false, true}) {
      const Setting s(sponge, inner);
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
          // Near a corner the samples may miss a cell. Such a way is not used.
          open &= std::abs(under.x - last.x) + std::abs(under.z - last.z) == 1;
          last = under;
        }
        if (open && cells > 0) found.compare(s, p, q);
      }
    }
  }
  EXPECT_GT(found.lit, 150);
  EXPECT_GT(found.hidden, 150);
}

// The walk goes from a wall down to the top face at its foot. If the wall's cube touches the lower cube only along an
// edge, one side of the lower cube lies in the plane of the wall, behind that top face. This side makes the smallest
// angle with the wall, but the walk must not continue there, because the top face hides it from the light.
TEST(Sponge, AWallGoesOnInTheTopAtItsFoot) {
  Found found;
  int on_an_edge = 0;
  for (uint32_t seed = 0; seed < 12; ++seed) {
    const Sponge sponge = random_sponge(seed);
    for (bool inner : {false, true}) {
      const Setting s(sponge, inner);
      std::mt19937 random(seed + 200);
      std::uniform_real_distribution<double> in(0.02, 0.98);
      for (int trial = 0; trial < 8000; ++trial) {
        const glm::ivec3 cell(random() % side, random() % side, random() % side);
        const int axis = random() % 2 ? 0 : 2;
        glm::ivec3 out(0);
        out[axis] = 1;  // the light comes from there
        const glm::ivec3 below(0, -1, 0);
        if (!sponge.at(cell) || sponge.at(cell + out) || !sponge.open_top(cell + out + below)) continue;
        glm::dvec3 p = glm::dvec3(cell) + glm::dvec3(in(random), in(random), in(random));
        p[axis] = cell[axis] + 1;
        const glm::dvec3 q = glm::dvec3(cell + out) + glm::dvec3(in(random), 0, in(random));
        // Where the light sees the way from p to q cross the foot: moved along the ray by `along`, both ends meet
        // there.
        const glm::dvec3 ray = s.frame.forward;
        const double height = p.y - cell.y, away = q[axis] - p[axis];
        const double t = height / ray.y / (height / ray.y + away / ray[axis]), along = -away * t / ray[axis];
        const int other = 2 - axis;
        const double at = p[other] + t * (q[other] - p[other]) + along * ray[other] - cell[other];
        if (!(at > 0.01 && at < 0.99)) continue;
        const Found before = found;
        found.compare(s, cell_m * p, cell_m * q);
        on_an_edge += !sponge.at(cell + below) && found.lit > before.lit;
      }
    }
  }
  EXPECT_GT(found.lit, 150);
  EXPECT_GT(found.hidden, 150);
  EXPECT_GT(on_an_edge, 30);
}

}  // namespace
}  // namespace noonmark
