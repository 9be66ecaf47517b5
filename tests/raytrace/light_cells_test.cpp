// What the cells of the light's plane answer is what the program's own rays answer, value for value, in scenes made to
// mislead them.
#include "raytrace/light_cells.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numbers>
#include <tuple>

#include "scenes/builtin.h"
#include "technique/filters.h"
#include "tests/raytrace/cells_support.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

constexpr double pi = std::numbers::pi;

Scene under_a_light(glm::dvec3 from, const std::function<void(Scene&)>& add) {
  Scene scene;
  add(scene);
  scene.light = {.position_m = from, .target_m = {0, 0, 0}};
  return scene;
}

const glm::dvec3 above(0, 10, 0), oblique(3, 9, 2), low(7, 3, 1);

void add_floor(Scene& scene, double half_m = 2, double y = 0) {
  add_quad(scene, "floor", {-half_m, y, -half_m}, {0, 0, 2 * half_m}, {2 * half_m, 0, 0});
}

TEST(LightCells, AnswerAsTheRaysDoInEveryScene) {
  for (const BuiltinScene& given : builtin_scenes()) expect_same(builtin(std::string(given.name)), 800);
}

// Most receivers need no ray. Without this, cells that answer nothing would pass all other tests.
TEST(LightCells, AnswerMostReceivers) {
  const Scene scene = builtin("cube-room");
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 20000, 1);
  const Tracer tracer(scene);
  StageTime first, again;
  tracer.receiver_truth(receivers, frame, {}, &first);
  tracer.receiver_truth(receivers, frame, {}, &again);
  EXPECT_LT(first.rays, 5 * 20000 / 200);
  StageTime soft;
  tracer.receiver_truth(receivers, frame, sun(0.53, 0.05), nullptr, &soft);
  EXPECT_LT(soft.rays, 3 * 20000u);
  EXPECT_EQ(first.rays, again.rays);
}

// Surfaces that lie on one another, or so near that no cell may tell them apart.
TEST(LightCells, SurfacesThatNearlyTouch) {
  for (const double gap_m : {0.0, 1e-7, 1e-5, 1e-4, 4e-4, 5e-4, 1e-3, 1.9e-3, 2e-3, 2.1e-3, 1e-2})
    for (const glm::dvec3 from : {above, oblique, low})
      expect_same(under_a_light(from,
                                [&](Scene& s) {
                                  add_floor(s);
                                  add_floor(s, 1.3, gap_m);
                                  add_quad(s, "tilted", {-1, gap_m, -1}, {0, 0.4, 0.7}, {0.9, 0, 0});
                                }),
                  1000, 2, std::to_string(gap_m));
}

TEST(LightCells, DoubledAndReversedTriangles) {
  for (const glm::dvec3 from : {above, oblique}) {
    Scene scene = under_a_light(from, [](Scene& s) {
      add_floor(s);
      add_box(s, "cube", glm::dvec3(-0.5, 0, -0.5), glm::dvec3(0.5, 1, 0.5));
    });
    const size_t count = scene.triangles.size();
    for (size_t t = 0; t < count; ++t) {
      const glm::uvec3 v = scene.triangles[t];
      scene.triangles.push_back(t % 2 ? glm::uvec3(v.y, v.z, v.x) : glm::uvec3(v.z, v.y, v.x));
    }
    expect_same(scene);
  }
}

// Tiles whose vertices are not shared, with corners on their neighbours' edges that are off by some float steps. Rays
// pass through the cracks.
TEST(LightCells, CracksOfTJunctions) {
  for (const double off : {0.0, 1e-7, 1e-6, 1e-5, 1e-3})
    expect_same(under_a_light(oblique,
                              [&](Scene& s) {
                                add_floor(s);
                                for (int i = 0; i < 3; ++i)
                                  add_quad(s, "left", {-1, 1, -1 + 2.0 / 3 * i}, {0, 0, 2.0 / 3}, {1 - off, 0, 0});
                                for (int i = 0; i < 7; ++i)
                                  add_quad(s, "right", {0, 1, -1 + 2.0 / 7 * i}, {0, 0, 2.0 / 7}, {1, 0, 0});
                              }),
                4000, 3, std::to_string(off));
}

// A sheet that ends at an edge but goes on over a seam, because the next one's border meets it but for rounding. Beyond it lies
// something before the second sheet and deeper than the plane of the first: there the taps are dark.
TEST(LightCells, SeamsAtTheEndsOfSheets) {
  for (const float off : {0.0f, 1.0f, 2.0f}) {  // units of the last place
    float border = 1;
    for (float i = 0; i < off; ++i) border = std::nextafter(border, 2.0f);
    expect_same(under_a_light(above,
                              [&](Scene& s) {
                                add_quad(s, "first", {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
                                add_quad(s, "second", {border, 0, -1}, {0, 0, 2}, {2, -1, 0});
                                add_quad(s, "between", {1.06, -0.02, -0.7}, {0, 0, 1.4}, {0.3, 0, 0});
                              }),
                4000, 16, std::to_string(off), 1, box(9));
  }
}

TEST(LightCells, SliversAndSoup) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double width : {1e-6, 1e-4, 1e-2, 1.0})
    for (const double tall : {0.01, 1.0})
      expect_same(under_a_light(oblique,
                                [&](Scene& s) {
                                  add_floor(s, 2, -1.1);
                                  for (int i = 0; i < 60; ++i) {
                                    const glm::dvec3 a(uniform(random), tall * uniform(random), uniform(random)),
                                        u(uniform(random), tall * uniform(random), uniform(random)),
                                        v(uniform(random), tall * uniform(random), uniform(random));
                                    add_quad(s, "", a, u, width * v);
                                  }
                                }),
                  1500, 6, std::to_string(width));
}

// A surface that winds twice around a point and so lies above itself, without a silhouette near the point. Two of its
// layers are joined within one cell.
TEST(LightCells, WindingSurfaces) {
  for (const double pitch_m : {0.0, 1e-3, 0.05, 0.5})
    for (const double hole_m : {0.0, 1e-4, 0.02})
      for (const glm::dvec3 from : {above, oblique})
        expect_same(under_a_light(from,
                                  [&](Scene& s) {
                                    add_floor(s, 2, -1);
                                    // Up over the first turn and down over the second, so that the turns close.
                                    const auto height = [&](double turn) {
                                      return pitch_m * (turn < 1 ? turn : 2 - turn) * (hole_m > 0 ? turn : 1);
                                    };
                                    add_surface(s, "winding", 24, 8, hole_m == 0, [&](double a, double t) {
                                      const double turn = 2 * a, r = hole_m + t;
                                      return glm::dvec3(r * std::sin(2 * pi * turn), t * height(turn),
                                                        r * std::cos(2 * pi * turn));
                                    });
                                  }),
                    2000, 7, std::to_string(pitch_m) + " " + std::to_string(hole_m));
}

// Three sheets at one edge, so that the surface goes on in two of them.
TEST(LightCells, BranchingSheets) {
  for (const double rise : {0.0, 1e-4, 0.01, 0.3})
    expect_same(under_a_light(oblique,
                              [&](Scene& s) {
                                add_floor(s, 2, -0.5);
                                add_quad(s, "trunk", {-1, 0, -1}, {0, 0, 2}, {1, 0, 0});
                                add_quad(s, "branch", {0, 0, -1}, {0, 0, 2}, {1, 0, 0});
                                add_quad(s, "branch", {0, 0, -1}, {0, 0, 2}, {1, rise, 0});
                              }),
                4000, 8, std::to_string(rise));
}

// Silhouettes exactly on the borders of cells, of all sizes of cells: the scene's extent is divided by powers of two.
TEST(LightCells, SilhouettesOnTheBordersOfCells) {
  expect_same(under_a_light(above,
                            [](Scene& s) {
                              add_floor(s);
                              for (int i = 0; i < 10; ++i) {
                                const double side = 4.0 / (1 << i), y = 0.5 + 0.02 * i;
                                add_quad(s, "plate", {-2 + side, y, -2 + side / 2}, {0, 0, side / 2}, {side / 2, 0, 0});
                              }
                            }),
              12000, 9);
}

// Walls that the light sees exactly from the side, standing on a floor that goes on under them and hanging over it.
TEST(LightCells, WallsSeenFromTheSide) {
  expect_same(under_a_light(above,
                            [](Scene& s) {
                              add_floor(s, 2, -0.5);
                              add_quad(s, "floor", {-1, 0, -1}, {0, 0, 2}, {1, 0, 0});
                              add_quad(s, "floor", {0, 0, -1}, {0, 0, 2}, {1, 0, 0});
                              add_quad(s, "standing", {0, 0, -1}, {0, 0, 2}, {0, 0.5, 0});
                              add_quad(s, "hanging", {0.5, 0.2, -1}, {0, 0, 2}, {0, 0.5, 0});
                            }),
              12000, 10);
}

// Fine meshes, whose cells hold sheets of many triangles; ridges and valleys as steep as the light is oblique.
TEST(LightCells, FineMeshes) {
  for (const double steep : {0.02, 0.3, 2.0})
    for (const glm::dvec3 from : {above, oblique, low})
      expect_same(under_a_light(from,
                                [&](Scene& s) {
                                  add_surface(s, "waves", 60, 60, false, [&](double a, double t) {
                                    const double x = 4 * a - 2, z = 2 - 4 * t;
                                    return glm::dvec3(x, steep * std::sin(4 * x) * std::cos(5 * z), z);
                                  });
                                  add_surface(s, "sphere", 40, 20, true, [](double a, double t) {
                                    const double phi = 2 * pi * a, up = pi * (t - 0.5);
                                    return glm::dvec3(0, 1.5, 0) + 0.7 * glm::dvec3(std::cos(up) * std::cos(phi),
                                                                                    std::sin(up),
                                                                                    -std::cos(up) * std::sin(phi));
                                  });
                                }),
                  1500, 11, std::to_string(steep));
}

// Planes that the light grazes, with others behind them: the rounding of P along the ray is longer than the way between
// the two.
TEST(LightCells, GrazingReceivers) {
  for (const double cosine : {0.2, 0.07, 0.06, 1e-2, 1e-3, 1e-4, 1e-5})
    for (const double behind_m : {1e-3, 3e-3, 2e-2})
      expect_same(under_a_light(above,
                                [&](Scene& s) {
                                  add_floor(s, 2, -3);
                                  const glm::dvec3 u(0, 0, 1.5), v(cosine, -1, 0);
                                  add_quad(s, "grazed", {0.1, 0.5, -1}, u, v);
                                  add_quad(s, "behind", {0.1, 0.5 - behind_m, -1}, u, v);
                                }),
                  1000, 15, std::to_string(cosine) + " " + std::to_string(behind_m));
}

// Suns of all sizes: penumbrae end within the cells, or reach over many of them.
TEST(LightCells, Suns) {
  const Scene steps = under_a_light(oblique, [](Scene& s) {
    add_floor(s);
    for (int i = 0; i < 12; ++i)
      add_quad(s, "step", {-1.8 + 0.3 * i, 0.05 + 0.12 * i, -1}, {0, 0, 2 - 0.1 * i}, {0.2, 0.02 * i, 0});
  });
  const Scene waves = under_a_light(low, [](Scene& s) {
    add_surface(s, "waves", 40, 40, false, [&](double a, double t) {
      return glm::dvec3(4 * a - 2, 0.3 * std::sin(9 * a) * std::cos(7 * t), 2 - 4 * t);
    });
  });
  // One surface that hides nothing of itself from the middle of the light: walls, steeper than the sun is narrow.
  const Scene gorge = under_a_light(above, [](Scene& s) {
    add_surface(s, "gorge", 5, 1, false, [&](double a, double t) {
      const int column = static_cast<int>(std::lround(5 * a));
      const double x[6] = {-3, -0.55, -0.5, 0.5, 0.55, 3};
      return glm::dvec3(x[column], column == 2 || column == 3 ? 0 : 2, 3 - 6 * t);
    });
  });
  // Part of the sun lies below the receivers' horizon.
  const Scene inclined = make_scene({.name = "plane", .theta_deg = 85});
  for (const double sun_deg : {0.05, 0.53, 3.0, 12.0, 40.0}) {
    for (const Scene* scene : {&steps, &waves, &gorge, &inclined})
      expect_same(*scene, 1500, 16, std::to_string(sun_deg), sun_deg);
    expect_same(builtin("cube-room"), 1500, 16, std::to_string(sun_deg), sun_deg);
    expect_same(builtin("fence"), 1500, 16, std::to_string(sun_deg), sun_deg);
  }
}

TEST(LightCells, EveryFilter) {
  for (const Filter& given : filters()) {
    if (given.map == FilterMap::cube) continue;
    FilterSettings filter = box(5);
    filter.kind = given.name;
    expect_same(builtin("cube-room"), 2000, 17, filter.kind, 1, filter);
  }
}

TEST(LightCells, FarFromTheOrigin) {
  const Scene scene = builtin("cube-room");
  for (const double far : {1e3, 1e5})
    expect_same(moved(scene, {far, -far / 3, far / 2}), 4000, 12, std::to_string(far));
}

// Rectangles of the light's plane, from much smaller than the finest square to several of them.
class Rectangles {
 public:
  explicit Rectangles(const Scene& scene)
      : scene_(scene), adjacency_(scene), view_(scene, frame_of(scene, 128)), cells_(adjacency_, view_, near_m, 256) {}

  std::optional<uint32_t> front(glm::dvec2 low, glm::dvec2 high) {
    return LightCells::Reader(cells_).front_in(low, high);
  }
  // Of a place that no edge is near: the nearest triangle that covers it, by its corners alone.
  std::optional<uint32_t> first_at(glm::dvec2 place) const {
    std::optional<uint32_t> first;
    for (uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      const glm::dvec3 at(place, 1);
      const auto side = [&](int e) {
        return view_.orientation(at, view_.corner(t, e), view_.corner(t, (e + 1) % 3)) * view_.orientation(t);
      };
      if (view_.edge_on(t) || side(0) < 0 || side(1) < 0 || side(2) < 0) continue;
      if (!first || view_.plane_depth(t, at) < view_.plane_depth(*first, at)) first = t;
    }
    return first;
  }
  const LightView& view() const { return view_; }
  static constexpr double near_m = 1e-4;

 private:
  const Scene& scene_;
  Adjacency adjacency_;
  LightView view_;
  LightCells cells_;
};

// Whatever triangle is said to be the front of a rectangle is the first at each place of it.
TEST(LightCells, FrontsAreFirstAllOverTheirRectangles) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int known = 0, wrong = 0;
  for (int round = 0; round < 20; ++round) {
    const Scene scene = under_a_light(oblique, [&](Scene& s) {
      add_floor(s, 2, -1.1);
      for (int i = 0; i < 30; ++i) {
        const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
        const glm::dvec3 a = vector(), u = vector(), v = vector();
        add_quad(s, "", a, u, (i % 3 ? 1 : 0.01) * v);
      }
    });
    Rectangles all(scene);
    for (int k = 0; k < 2000; ++k) {
      const glm::dvec2 middle(uniform(random), uniform(random));
      const glm::dvec2 half = glm::exp2(glm::dvec2(-9 + 3 * uniform(random), -9 + 3 * uniform(random)));
      const std::optional<uint32_t> front = all.front(middle - half, middle + half);
      if (!front) continue;
      ++known;
      for (int i = 0; i < 8; ++i)
        wrong += all.first_at(middle + half * glm::dvec2(uniform(random), uniform(random))) != front;
      for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(1, 1)})
        wrong += all.first_at(middle + half * corner) != front;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(known, 20 * 2000 / 4);  // cells that know no front must not pass
}

// A small rectangle has a front also where the finest square around it has none, because an edge crosses the square.
TEST(LightCells, KnowFrontsBesideEdges) {
  const Scene scene = under_a_light(above, [](Scene& s) {
    add_floor(s);
    add_quad(s, "", {-0.37, 0.5, -0.41}, {0.1, 0, 1}, {1, 0, -0.2});
  });
  Rectangles all(scene);
  const uint32_t caster = 2;  // the first triangle after the floor's two
  int beside = 0;
  for (int i = 1; i < 200; ++i) {
    const glm::dvec2 a(all.view().corner(caster, 0)), way = glm::dvec2(all.view().corner(caster, 1)) - a;
    const glm::dvec2 across = glm::normalize(glm::dvec2(-way.y, way.x));
    for (const double side : {-1.0, 1.0}) {
      const glm::dvec2 middle = a + way * (i / 200.0) + side * 0.003 * across;  // the finest squares are 0.016 m wide
      const std::optional<uint32_t> front = all.front(middle - 0.001, middle + 0.001);
      beside += front && front == all.first_at(middle);
    }
  }
  // All but those that an edge of the floor's or the caster's triangles crosses.
  EXPECT_GT(beside, 2 * 199 * 9 / 10);
}

TEST(LightCells, FlightHelmet) {
  if (!std::filesystem::exists(shared_model("FlightHelmet"))) GTEST_SKIP() << "no FlightHelmet";
  expect_same(builtin(shared_model("FlightHelmet")), 4000, 13);
}

TEST(LightCells, AreTheSameFromManyThreads) {
  const Scene scene = builtin("cube-room");
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 60000, 14);
  const auto judge = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    StageTime hard;
    const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, {}, &hard);
    return std::tuple(truth.lit.pixels, truth.ambiguous.pixels, hard.rays);
  };
  EXPECT_EQ(judge(1), judge(8));
}

TEST(LightCells, OfAnEmptySceneAnswerNothing) {
  const Scene scene;
  EXPECT_NO_THROW(Tracer(scene).receiver_truth({}, LightFrame{}, {}));
}

}  // namespace
}  // namespace noonmark::raytrace
